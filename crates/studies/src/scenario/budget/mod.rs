//! `study: budget`: from the written to the valid form.

mod filter;
#[cfg(test)]
mod tests;
pub(super) mod valid;
pub(super) mod written;

use schuler_imu::Unit;

use super::{
    de::At,
    document::{Document, Spot},
    quantity::Range,
    valid::{Imu, Mechanization, Vertical},
    written::Scenario,
};
use crate::{Diagnostic, trajectory::Trajectory};
use valid::{Budget, Required, Requirement};

/// Runs of one budget; beyond it a typing error.
const MAX_RUNS: u64 = 1_000_000;

impl Document {
    pub(super) fn budget(&self, w: &Scenario) -> Result<Budget, Diagnostic> {
        let start = self.required_start(w, "budget")?;
        let written = self.required(&w.imu, "imu", "budget", "imu: { rate: 100 Hz }")?;
        let imu = self.imu(written)?;
        if let Some(readout) = &written.value.readout {
            return Err(self
                .diagnostic(Spot::Node(readout.node), "a budget has no readout")
                .expected("an instrument that adds its errors and nothing else: rounding has no share of a variance")
                .help("take it out, or choose `study: imu`"));
        }
        let samples = self.samples(w, "budget", imu.rate)?;
        let duration = samples as f64 / imu.rate;
        let mechanization = self.mechanization(w, "budget")?;
        self.second_order_at_most(w, &mechanization)?;
        let motion = self.required(&w.motion, "motion", "budget", "motion: static")?;
        let valid_motion = self.flown(motion, &start, duration, "budget")?;
        let trajectory = valid_motion
            .trajectory(&start, mechanization.gravity, samples, 1.0 / imu.rate)
            .map_err(|fault| self.impossible(motion, &fault))?;
        let end = trajectory.as_ref().and_then(|trajectory| trajectory.duration()).unwrap_or(f64::INFINITY);
        if duration > end * (1.0 + 1e-9) {
            let node = w.duration.as_ref().map_or(motion.node, |d| d.node);
            return Err(self
                .diagnostic(Spot::Node(node), "the motion ends before the duration")
                .expected(format!("{end:.3} s or less"))
                .found(format!("{duration} s")));
        }
        self.keeps_height(w, &mechanization, trajectory.as_deref(), duration)?;
        let block = w.budget.as_ref().map(|b| &b.value);
        let initial_sigmas = block.and_then(|b| b.initial_sigmas.as_ref());
        let sigmas = self.initial_errors(initial_sigmas)?;
        let negative =
            |i: &super::valid::Initial| [i.position, i.velocity, i.phi].iter().flatten().any(|x| *x < 0.0);
        if let (Some(at), Some(initial)) = (initial_sigmas, sigmas.iter().find(|i| negative(i))) {
            return Err(self
                .diagnostic(Spot::Node(at.node), "a standard deviation must not be negative")
                .found(initial.name));
        }
        let alignment = match block.and_then(|b| b.alignment.as_ref()) {
            Some(alignment) => self.budget_alignment(alignment, &start, &sigmas, imu.rate)?,
            None => 0,
        };
        let filter = self.budget_filter(w, &imu, &sigmas, &mechanization)?;
        let runs = self.runs(block.and_then(|b| b.runs.as_ref()), &imu)?;
        let requirement = block.and_then(|b| b.requirement.as_ref());
        Ok(Budget {
            motion: valid_motion,
            start,
            samples,
            initial_sigmas: sigmas,
            alignment,
            filter,
            requirement: requirement
                .map(|r| self.requirement(w, r, duration, &imu, &mechanization))
                .transpose()?,
            mechanization,
            imu,
            runs,
            runs_of_each: block.and_then(|b| b.runs_of) != Some(written::RunsOf::Total),
        })
    }

    /// The error dynamics of the budget have the nine navigation errors and no state of a loop.
    fn second_order_at_most(&self, w: &Scenario, how: &Mechanization) -> Result<(), Diagnostic> {
        match how.vertical {
            Vertical::Damped(damping) if damping.order != 2 => {
                let node = w.mechanization.as_ref().map_or(self.root(), |m| m.node);
                Err(self
                    .diagnostic(Spot::Node(node), "a budget has no third-order vertical loop")
                    .expected("`held`, `free`, or a loop of order 2")
                    .example("vertical: { damped: { order: 2, tau: 100 s } }"))
            }
            _ => Ok(()),
        }
    }

    /// A vertical channel that is held, or slaved to the height of the start, goes with a motion that keeps its height.
    fn keeps_height(
        &self,
        w: &Scenario,
        how: &Mechanization,
        trajectory: Option<&dyn Trajectory>,
        duration: f64,
    ) -> Result<(), Diagnostic> {
        /// Where the height is looked at, and by how much it may differ, m.
        const MOMENTS: u32 = 200;
        const LEVEL: f64 = 1.0;
        let Some(trajectory) = trajectory.filter(|_| how.vertical != Vertical::Free) else { return Ok(()) };
        let height = |k: u32| trajectory.at(duration * f64::from(k) / f64::from(MOMENTS)).position.h;
        let first = height(0);
        let largest = (1..=MOMENTS).map(|k| (height(k) - first).abs()).fold(0.0, f64::max);
        if largest <= LEVEL {
            return Ok(());
        }
        let node = w.mechanization.as_ref().map_or(self.root(), |m| m.node);
        Err(self
            .diagnostic(
                Spot::Node(node),
                "the height changes, but the navigator takes it to stay: its error would be the climb",
            )
            .expected(
                "`vertical: free`, with a height in `aiding` where it lasts long; or a motion at one height",
            )
            .found(format!("{largest:.1} m away from the height of the start")))
    }

    /// Runs draw what has a standard deviation: a fixed value has no share of what they scatter.
    fn runs(&self, runs: Option<&At<u64>>, imu: &Imu) -> Result<u64, Diagnostic> {
        let Some(runs) = runs else { return Ok(0) };
        let fault = |problem: &str| self.diagnostic(Spot::Node(runs.node), problem);
        if !(2..=MAX_RUNS).contains(&runs.value) {
            return Err(fault("no such number of runs")
                .expected(format!("2 to {MAX_RUNS}"))
                .found(runs.value.to_string())
                .example("runs: 200"));
        }
        let fixed = imu.spec.components().find(|c| c.evolution().linear_model().x0.iter().any(|x| *x != 0.0));
        match fixed {
            Some(component) => Err(fault("a fixed value does not scatter from run to run")
                .expected(
                    "sources with a standard deviation: `sigma` instead of `value` or `rate`, no `phase`",
                )
                .found(component.to_string())),
            None => Ok(runs.value),
        }
    }

    fn requirement(
        &self,
        w: &Scenario,
        requirement: &At<written::Requirement>,
        duration: f64,
        imu: &Imu,
        mechanization: &Mechanization,
    ) -> Result<Requirement, Diagnostic> {
        let r = &requirement.value;
        let at = self.quantity(&r.at, Unit::SECOND, Range::Positive)?;
        let every = w.output.as_ref().and_then(|o| o.value.every.as_ref());
        let every =
            every.map_or(Ok(1.0 / imu.rate), |every| self.quantity(every, Unit::SECOND, Range::Positive))?;
        let rows = at / every;
        let is_row = (rows - rows.round()).abs() < 1e-6 || (at - duration).abs() < 1e-6 / imu.rate;
        if at > duration * (1.0 + 1e-12) || !is_row {
            return Err(self
                .diagnostic(Spot::Node(r.at.node), "no row at the time of the requirement")
                .expected(format!("a multiple of {every} s up to the duration, {duration} s"))
                .found(format!("{at} s")));
        }
        let probability = self.quantity(&r.probability, Unit::ONE, Range::Any)?;
        if !(probability > 0.0 && probability < 1.0) {
            let all = probability >= 1.0;
            let problem = if all { "no radius holds everything" } else { "a radius that holds nothing" };
            let expected = if all { "a probability below one" } else { "a probability above zero" };
            return Err(self
                .diagnostic(Spot::Node(r.probability.node), problem)
                .expected(expected)
                .found(probability.to_string())
                .example("probability: 95 %"));
        }
        let speed = Unit::METRE.over(Unit::SECOND);
        let given = [
            (Required::Horizontal, &r.horizontal, Unit::METRE),
            (Required::Down, &r.down, Unit::METRE),
            (Required::Velocity, &r.velocity, speed),
            (Required::Tilt, &r.tilt, Unit::RADIAN),
            (Required::Heading, &r.heading, Unit::RADIAN),
        ];
        let mut limits = Vec::new();
        for (of, limit, unit) in given {
            let Some(limit) = limit else { continue };
            if of == Required::Down && mechanization.vertical == Vertical::Held {
                return Err(self
                    .diagnostic(Spot::Node(limit.node), "a height that is held has no error")
                    .help("let the vertical channel free: `mechanization: { vertical: free, … }`"));
            }
            limits.push((of, self.quantity(limit, unit, Range::Positive)?));
        }
        if limits.is_empty() {
            return Err(self
                .diagnostic(Spot::Node(requirement.node), "nothing is required")
                .expected("horizontal, down, velocity, tilt or heading")
                .example("requirement: { horizontal: 1 nmi, at: 1 h, probability: 95 % }"));
        }
        Ok(Requirement { limits, at, probability })
    }
}
