//! `study: simulate`: from the written to the valid form.

use schuler_frames::Gravity;
use schuler_imu::Unit;

use super::{
    check_motion::SPEED,
    de::At,
    document::{Document, Spot},
    quantity::Range,
    valid_motion::{Aid, Aiding, Simulate},
    written, written_motion as w,
};
use crate::Diagnostic;

impl Document {
    /// `study: simulate`.
    pub(super) fn simulate(&self, w: &written::Scenario) -> Result<Simulate, Diagnostic> {
        let start = self.required_start(w, "simulate")?;
        let imu = self.imu(self.required(&w.imu, "imu", "simulate", "imu: { rate: 100 Hz }")?)?;
        let written = self.required(&w.motion, "motion", "simulate", "motion: static")?;
        let gravity = match self.required(&w.gravity, "gravity", "simulate", "gravity: normal")?.value {
            written::Gravity::Normal => Gravity::Normal,
            written::Gravity::Somigliana => Gravity::Somigliana,
        };
        let duration =
            w.duration.as_ref().map(|d| self.quantity(d, Unit::SECOND, Range::Positive)).transpose()?;
        let motion = self.motion(written, Some(&start), duration)?;
        let dt = 1.0 / imu.rate;
        let asked = w.duration.as_ref().map(|_| self.samples(w, "simulate", imu.rate)).transpose()?;
        let trajectory = motion
            .trajectory(&start, gravity, asked.unwrap_or(1), dt)
            .map_err(|fault| self.impossible(written, &fault))?;
        if motion.file().is_some() && asked.is_none() {
            return Err(self
                .diagnostic(Spot::Node(written.node), "a recorded motion needs the key `duration`")
                .expected("the part of it that is simulated, from its first row on")
                .example("duration: 600 s"));
        }
        let own = trajectory.as_ref().and_then(|trajectory| trajectory.duration());
        if trajectory.is_none() && motion.file().is_none() {
            return Err(self
                .diagnostic(Spot::Node(written.node), "zero truth is no motion")
                .expected("a motion on the Earth")
                .example("motion: static"));
        }
        // The last whole sample; what rounding takes from it is given back.
        let whole = own.map(|end| (end * imu.rate * (1.0 + 1e-12)).floor() as u64);
        let samples = match (asked, whole) {
            (Some(asked), Some(whole)) if asked > whole => {
                let end = own.unwrap_or_default();
                let node = w.duration.as_ref().map_or(written.node, |d| d.node);
                return Err(self
                    .diagnostic(Spot::Node(node), "the motion ends before the duration")
                    .expected(format!("{end:.3} s or less, or no `duration`"))
                    .found(format!("{} s", asked as f64 * dt)));
            }
            (Some(asked), _) => asked,
            (None, Some(whole)) if whole > 0 => whole,
            (None, _) => self.samples(w, "simulate", imu.rate)?,
        };
        let aiding = match &w.aiding {
            None => Aiding::default(),
            Some(aiding) => self.aiding(&aiding.value, imu.rate)?,
        };
        Ok(Simulate { motion, start, gravity, samples, imu, aiding })
    }

    pub(super) fn aiding(&self, w: &w::Aiding, rate: f64) -> Result<Aiding, Diagnostic> {
        let aid = |aid: &Option<At<w::Aid>>, unit, arm| {
            aid.as_ref().map(|aid| self.aid(aid, unit, arm, rate)).transpose()
        };
        Ok(Aiding {
            position: aid(&w.position, Unit::METRE, true)?,
            velocity: aid(&w.velocity, SPEED, true)?,
            height: aid(&w.height, Unit::METRE, true)?,
            heading: aid(&w.heading, Unit::RADIAN, false)?,
        })
    }

    fn aid(&self, aid: &At<w::Aid>, unit: Unit, arm: bool, rate: f64) -> Result<Aid, Diagnostic> {
        let w = &aid.value;
        let per = rate / self.quantity(&w.rate, Unit::HERTZ, Range::Positive)?;
        let stride = per.round();
        if stride < 1.0 || (per - stride).abs() > 1e-6 * per {
            return Err(self
                .diagnostic(Spot::Node(w.rate.node), "the interval is not a whole number of IMU samples")
                .expected(format!("a whole part of {rate} Hz"))
                .found(format!("{per} samples"))
                .example("rate: 1 Hz"));
        }
        let lever_arm = match &w.lever_arm {
            None => [0.0; 3],
            Some(lever_arm) if !arm => {
                return Err(self
                    .diagnostic(Spot::Node(lever_arm.node), "a heading has no lever arm")
                    .help("take it out"));
            }
            Some(lever_arm) => self.quantities(lever_arm, Unit::METRE)?,
        };
        let mut outages = Vec::new();
        for outage in w.outages.iter().flat_map(|list| &list.value) {
            let [begin, end] = self.quantities(outage, Unit::SECOND)?;
            if begin >= end {
                return Err(self
                    .diagnostic(Spot::Node(outage.node), "an outage that ends before it begins")
                    .expected("begin and end")
                    .example("[100 s, 160 s]"));
            }
            outages.push([begin, end]);
        }
        let sigma = self.each_axis(&w.sigma, unit, Range::NonNegative)?;
        let seconds = |q: &Option<written::Quantity>, range| {
            q.as_ref().map_or(Ok(0.0), |q| self.quantity(q, Unit::SECOND, range))
        };
        let phase = seconds(&w.phase, Range::NonNegative)?;
        if phase * rate >= stride {
            let node = w.phase.as_ref().map_or(aid.node, |q| q.node);
            return Err(self
                .diagnostic(Spot::Node(node), "a phase of an interval or more")
                .expected(format!("less than {} s", stride / rate))
                .found(format!("{phase} s")));
        }
        let offset = seconds(&w.offset, Range::Any)?;
        Ok(Aid { stride: stride as u64, sigma, lever_arm, outages, phase, offset })
    }
}
