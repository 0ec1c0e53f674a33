//! What comes before a budget, and what runs beside it: alignment and filter.

use schuler_imu::{Spec, Unit};

use super::super::{
    check_motion::SPEED,
    de::At,
    document::{Document, NodeId, Spot},
    quantity::Range,
    schema::Sources,
    sources,
    valid::{Frame, Imu, Initial, Mechanization, Start, Vertical},
    valid_motion::{Aid, Aiding},
    written::{OneOrThree, Quantity, Scenario},
};
use super::{valid::BudgetFilter, written};
use crate::Diagnostic;

impl Document {
    /// Samples of an alignment.
    pub(super) fn budget_alignment(
        &self,
        alignment: &At<written::Alignment>,
        start: &Start,
        sigmas: &[Initial],
        rate: f64,
    ) -> Result<u64, Diagnostic> {
        if start.velocity != [0.0; 3] {
            return Err(self
                .diagnostic(Spot::Node(alignment.node), "an alignment at rest, but a velocity at the start")
                .expected("`start` without `velocity`"));
        }
        if let Some(initial) = sigmas.iter().find(|i| i.phi != [0.0; 3]) {
            return Err(self
                .diagnostic(Spot::Node(alignment.node), "tilt and heading come from the alignment")
                .expected("`initial_sigmas` of velocity and position only")
                .found(initial.name));
        }
        self.whole_samples(&alignment.value.window, rate)
    }

    /// The filter of a budget, with its measurements.
    pub(super) fn budget_filter(
        &self,
        w: &Scenario,
        imu: &Imu,
        sigmas: &[Initial],
        how: &Mechanization,
    ) -> Result<Option<BudgetFilter>, Diagnostic> {
        let filter = w.budget.as_ref().and_then(|b| b.value.filter.as_ref());
        let (filter, aiding) = match (filter, &w.aiding) {
            (None, None) => return Ok(None),
            (Some(filter), Some(aiding)) => (filter, aiding),
            (None, Some(aiding)) => {
                return Err(self
                    .diagnostic(Spot::Node(aiding.node), "measurements that no filter takes")
                    .expected("`budget: { filter: {} }` beside them, or none")
                    .example("budget: { filter: {} }"));
            }
            (Some(filter), None) => {
                return Err(self
                    .diagnostic(Spot::Node(filter.node), "a filter that measures nothing")
                    .expected("`aiding` with position, velocity, height or heading")
                    .example("aiding: { position: { rate: 1 Hz, sigma: 3 m } }"));
            }
        };
        let fits = how.frame == Frame::T
            && how.coning.samples() == 1
            && matches!(how.vertical, Vertical::Free | Vertical::Held);
        if !fits {
            let node = w.mechanization.as_ref().map_or(filter.node, |m| m.node);
            let example = "mechanization: { frame: t, vertical: free, gravity: normal }";
            return Err(self
                .diagnostic(
                    Spot::Node(node),
                    "a filter goes with a navigator in frame `t` that takes each sample as an update, its vertical channel free or held",
                )
                .expected(example)
                .example(example));
        }
        let truth = self.aiding(&aiding.value, imu.rate)?;
        if how.vertical == Vertical::Held && truth.height.is_some() {
            let node = aiding.value.height.as_ref().map_or(aiding.node, |h| h.node);
            return Err(self
                .diagnostic(Spot::Node(node), "a height where the vertical channel is held")
                .expected("`vertical: free`, or no height"));
        }
        let none = [&truth.position, &truth.velocity, &truth.height, &truth.heading];
        if none.iter().all(|aid| aid.is_none()) {
            return Err(self
                .diagnostic(Spot::Node(aiding.node), "a filter that measures nothing")
                .expected("position, velocity, height or heading")
                .example("aiding: { position: { rate: 1 Hz, sigma: 3 m } }"));
        }
        if none.into_iter().flatten().any(|aid| (aid.phase, aid.offset) != (0.0, 0.0)) {
            return Err(self
                .diagnostic(
                    Spot::Node(aiding.node),
                    "measurements that the filter of a budget takes at another time than the IMU's",
                )
                .expected("`aiding` without `phase` and `offset`"));
        }
        let f = &filter.value;
        let believed = self.believed(&truth, f.noise.as_ref(), aiding.node)?;
        Ok(Some(BudgetFilter {
            spec: self.known(f, imu)?,
            sigma: self.believed_start(f, sigmas)?,
            aiding: truth,
            believed,
        }))
    }

    /// The sources that the filter knows of: for each instrument its own list, or that of the truth.
    fn known(&self, f: &written::BudgetFilter, imu: &Imu) -> Result<Spec, Diagnostic> {
        use schuler_imu::Instrument::{Accel, Gyro};
        let mut spec = imu.spec.keep(|c| match c.instrument() {
            Gyro => f.gyro.is_none(),
            Accel => f.accel.is_none(),
        });
        let none = Sources::default();
        let [gyro, accel] = [&f.gyro, &f.accel].map(|list| list.as_ref().map_or(&none, |own| &own.value));
        sources::add(self, &mut spec, gyro, accel)?;
        Ok(spec)
    }

    /// Standard deviations of the start as the filter takes them; those of the truth where it says none.
    fn believed_start(&self, f: &written::BudgetFilter, sigmas: &[Initial]) -> Result<[f64; 9], Diagnostic> {
        let mut sigma = [0.0f64; 9];
        for i in sigmas {
            for (all, one) in sigma.iter_mut().zip([i.position, i.velocity, i.phi].as_flattened()) {
                *all += one;
            }
        }
        for (first, given, unit) in [(0, &f.position, Unit::METRE), (3, &f.velocity, SPEED)] {
            if let Some(given) = given {
                let given = self.each_axis(given, unit, Range::NonNegative)?;
                sigma[first..first + 3].copy_from_slice(&given);
            }
        }
        for (axes, given) in [(6..8, &f.tilt), (8..9, &f.heading)] {
            if let Some(given) = given {
                sigma[axes].fill(self.quantity(given, Unit::RADIAN, Range::NonNegative)?);
            }
        }
        Ok(sigma)
    }

    /// The measurements with the standard deviations that the filter takes them to have.
    fn believed(
        &self,
        truth: &Aiding,
        noise: Option<&At<written::Noise>>,
        aiding: NodeId,
    ) -> Result<Aiding, Diagnostic> {
        let noise = noise.map(|n| &n.value);
        let three = |own: Option<&At<OneOrThree>>, unit| {
            own.map(|q| self.each_axis(q, unit, Range::Positive)).transpose()
        };
        let one = |own: Option<&Quantity>, unit| {
            own.map(|q| Ok([self.quantity(q, unit, Range::Positive)?; 3])).transpose()
        };
        let with = |aid: &Option<Aid>, sigma: Option<[f64; 3]>, name: &str| {
            let Some(aid) = aid else { return Ok(None) };
            let sigma = sigma.unwrap_or(aid.sigma);
            if sigma.iter().any(|s| *s <= 0.0) {
                return Err(self
                    .diagnostic(
                        Spot::Node(aiding),
                        format!("the filter needs a positive standard deviation of the {name}"),
                    )
                    .expected("a measurement with noise, or `budget.filter.noise`")
                    .example(format!("budget: {{ filter: {{ noise: {{ {name}: … }} }} }}")));
            }
            Ok(Some(Aid { sigma, ..aid.clone() }))
        };
        Ok(Aiding {
            position: with(
                &truth.position,
                three(noise.and_then(|n| n.position.as_ref()), Unit::METRE)?,
                "position",
            )?,
            velocity: with(
                &truth.velocity,
                three(noise.and_then(|n| n.velocity.as_ref()), SPEED)?,
                "velocity",
            )?,
            height: with(&truth.height, one(noise.and_then(|n| n.height.as_ref()), Unit::METRE)?, "height")?,
            heading: with(
                &truth.heading,
                one(noise.and_then(|n| n.heading.as_ref()), Unit::RADIAN)?,
                "heading",
            )?,
        })
    }
}
