//! `study: monte_carlo`: from the written to the valid form.

pub(super) mod valid;
pub(super) mod written;

use schuler_imu::Unit;

use super::{
    de::{At, one_of},
    document::{Document, Spot},
    quantity::Range,
    valid::Initial,
    valid_motion,
    written::Scenario,
    written_motion,
};
use crate::{Diagnostic, record::columns, similar::similar};
use valid::{MonteCarlo, RunFigure, Threshold, Until};

/// Beyond it a typing error: a thousand years of one core.
const MAX_RUNS: u64 = 1_000_000_000;
/// Rows of time; each keeps counts of its own in memory.
const MAX_ROWS: u64 = 1000;

impl Document {
    pub(super) fn monte_carlo(&self, w: &Scenario) -> Result<MonteCarlo, Diagnostic> {
        const STUDY: &str = "monte_carlo";
        let block = self.required(&w.monte_carlo, STUDY, STUDY, "monte_carlo: { runs: 1000 }")?;
        let start = self.required_start(w, STUDY)?;
        let imu = self.imu(self.required(&w.imu, "imu", STUDY, "imu: { rate: 100 Hz }")?)?;
        let samples = self.samples(w, STUDY, imu.rate)?;
        let duration = samples as f64 / imu.rate;
        let mechanization = self.mechanization(w, STUDY)?;
        let written = self.required(&w.motion, "motion", STUDY, "motion: static")?;
        let motion = self.flown(written, &start, duration, STUDY)?;
        let trajectory = motion
            .trajectory(&start, mechanization.gravity, samples, 1.0 / imu.rate)
            .map_err(|fault| self.impossible(written, &fault))?;
        let end = trajectory.and_then(|trajectory| trajectory.duration()).unwrap_or(f64::INFINITY);
        if duration > end * (1.0 + 1e-9) {
            let node = w.duration.as_ref().map_or(written.node, |d| d.node);
            return Err(self
                .diagnostic(Spot::Node(node), "the motion ends before the duration")
                .expected(format!("{end:.3} s or less"))
                .found(format!("{duration} s")));
        }
        let every = w.output.as_ref().and_then(|o| o.value.every.as_ref());
        let interval = every.map(|every| self.quantity(every, Unit::SECOND, Range::Positive)).transpose()?;
        let interval = interval.unwrap_or(1.0 / imu.rate);
        if duration / interval > MAX_ROWS as f64 {
            let node = every.map_or(self.root(), |every| every.node);
            return Err(self
                .diagnostic(Spot::Node(node), "too many rows")
                .expected(format!(
                    "at most {MAX_ROWS}: `output: {{ every: … }}` of {} s or more",
                    duration / MAX_ROWS as f64
                ))
                .found(format!("{:.0}", duration / interval))
                .example(format!("every: {} s", (duration / 100.0).max(1.0 / imu.rate))));
        }
        let block = &block.value;
        if !(2..=MAX_RUNS).contains(&block.runs.value) {
            return Err(self
                .diagnostic(Spot::Node(block.runs.node), "no such number of runs")
                .expected(format!("2 to {MAX_RUNS}"))
                .found(block.runs.value.to_string())
                .example("runs: 1000"));
        }
        let sigmas = self.initial_errors(block.initial_sigmas.as_ref())?;
        let negative = |i: &Initial| [i.position, i.velocity, i.phi].iter().flatten().any(|x| *x < 0.0);
        if let (Some(at), Some(initial)) = (&block.initial_sigmas, sigmas.iter().find(|i| negative(i))) {
            return Err(self
                .diagnostic(Spot::Node(at.node), "a standard deviation must not be negative")
                .found(initial.name));
        }
        if sigmas.is_empty() && imu.spec.sources().next().is_none() && imu.spec.readout.is_none() {
            return Err(self
                .diagnostic(Spot::Node(self.root()), "nothing differs from run to run")
                .expected("error sources, or `monte_carlo: { initial_sigmas: … }`")
                .example("gyro: [{ bias: { constant: { sigma: 0.01 deg/h } } }]"));
        }
        let thresholds: Vec<Threshold> =
            block.thresholds.iter().map(|t| self.threshold(t)).collect::<Result<_, _>>()?;
        for (k, threshold) in thresholds.iter().enumerate() {
            if thresholds[..k].iter().any(|other| other.name == threshold.name) {
                return Err(self
                    .diagnostic(Spot::Node(block.thresholds[k].value.name.node), "two thresholds of one name")
                    .found(format!("`{}`", threshold.name)));
            }
        }
        let until = block.until.as_ref().map(|u| self.until(u, interval, duration, imu.rate)).transpose()?;
        Ok(MonteCarlo {
            motion,
            start,
            samples,
            imu,
            initial_sigmas: sigmas,
            mechanization,
            runs: block.runs.value,
            thresholds,
            until,
        })
    }

    /// A motion that `study` navigates along: on the Earth, without jumps and without a file.
    pub(super) fn flown(
        &self,
        motion: &At<written_motion::Motion>,
        start: &super::valid::Start,
        duration: f64,
        study: &str,
    ) -> Result<valid_motion::Motion, Diagnostic> {
        if matches!(motion.value, written_motion::Motion::ZeroTruth) {
            return Err(self
                .diagnostic(Spot::Node(motion.node), "zero truth is no place on the Earth to navigate from")
                .expected("a motion")
                .example("motion: static"));
        }
        let valid = self.motion(motion, Some(start), Some(duration))?;
        if valid.is_mounted_anew() {
            return Err(self
                .diagnostic(
                    Spot::Node(motion.node),
                    "a rate table mounts the instrument anew between its axes: no navigator follows that jump",
                )
                .expected("a motion without jumps of the attitude")
                .example("motion: { sway: { roll: { amplitude: 5 deg, period: 10 s } } }"));
        }
        if valid.file().is_some() {
            return Err(self
                .diagnostic(Spot::Node(motion.node), format!("the study `{study}` reads no trajectory"))
                .help("choose another motion"));
        }
        Ok(valid)
    }

    fn threshold(&self, threshold: &At<written::Threshold>) -> Result<Threshold, Diagnostic> {
        let t = &threshold.value;
        let (quantity, unit) = self.error_quantity(&t.quantity)?;
        let limit = self.quantity(&t.limit, unit, Range::Positive)?;
        Ok(Threshold { name: t.name.value.clone(), quantity, limit })
    }

    /// Number of an error among those of `monte_carlo.csv`, and its unit.
    fn error_quantity(&self, word: &At<String>) -> Result<(usize, Unit), Diagnostic> {
        let known = &columns::MONTE_CARLO[3..];
        let number = known.iter().position(|name| *name == word.value);
        number.and_then(|k| Some((k, columns::unit(known[k])?))).ok_or_else(|| {
            let fault = self
                .diagnostic(Spot::Node(word.node), format!("unknown quantity `{}`", word.value))
                .expected(one_of(known));
            match similar(&word.value, known.iter().copied()) {
                Some(near) => fault.help(format!("did you mean `{near}`?")),
                None => fault,
            }
        })
    }

    fn until(
        &self,
        until: &At<written::Until>,
        interval: f64,
        duration: f64,
        rate: f64,
    ) -> Result<Until, Diagnostic> {
        let u = &until.value;
        let (quantity, _) = self.error_quantity(&u.quantity)?;
        let figure = RunFigure::ALL.iter().find(|(word, _)| *word == u.way.value).map(|(_, figure)| *figure);
        let Some(figure) = figure else {
            return Err(self
                .diagnostic(Spot::Node(u.way.node), format!("unknown way `{}`", u.way.value))
                .expected(one_of(&RunFigure::ALL.map(|(word, _)| word)))
                .example("way: q95"));
        };
        let at = self.quantity(&u.at, Unit::SECOND, Range::Positive)?;
        let rows = at / interval;
        let is_row = (rows - rows.round()).abs() < 1e-6 || (at - duration).abs() < 1e-6 / rate;
        if at > duration * (1.0 + 1e-12) || !is_row {
            return Err(self
                .diagnostic(Spot::Node(u.at.node), "no row at this time")
                .expected(format!("a multiple of {interval} s up to the duration, {duration} s"))
                .found(format!("{at} s")));
        }
        let relative = self.quantity(&u.relative, Unit::ONE, Range::Positive)?;
        Ok(Until { quantity, figure, at, relative })
    }
}
