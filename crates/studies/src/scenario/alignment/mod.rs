//! `study: align`: from the written to the valid form.

mod filter;
#[cfg(test)]
mod tests;
pub(super) mod valid;
pub(super) mod written;

use schuler_frames::Gravity;
use schuler_imu::Unit;
use schuler_strapdown::align::{AnyHeadingNoise, Solution, Vectors};

use super::{
    de::At,
    document::{Document, NodeId, Spot},
    quantity::Range,
    valid::{Frame, Start},
    valid_motion::Motion,
    written::Scenario,
};
use crate::Diagnostic;
use valid::{AlignStudy, Coarse, Knock, Method, MethodKind, Origin, Velocity};

const VELOCITY: Unit = Unit::METRE.over(Unit::SECOND);

/// Methods that stand side by side: more would not be read.
const MAX_METHODS: usize = 20;

/// Runs of one alignment; beyond it a typing error.
const MAX_RUNS: u64 = 1_000_000;

impl Document {
    pub(super) fn align_study(&self, w: &Scenario) -> Result<AlignStudy, Diagnostic> {
        let example = "alignment: { methods: [{ triad: {} }] }";
        let alignment = &self.required(&w.alignment, "alignment", "align", example)?.value;
        let start = self.required_start(w, "align")?;
        let mechanization = self.mechanization(w, "align")?;
        if mechanization.frame != Frame::T || mechanization.coning.samples() != 1 {
            let node = w.mechanization.as_ref().map_or(self.root(), |m| m.node);
            return Err(self
                .diagnostic(Spot::Node(node), "an alignment navigates in the local level, sample by sample")
                .expected("`frame: t`, and `coning: one` or `previous`")
                .example(
                    "mechanization: { frame: t, vertical: held, gravity: somigliana, coning: previous }",
                ));
        }
        let origin = self.origin(w, alignment, &start)?;
        let (rate, samples) = match &origin {
            Origin::Simulated { imu, samples, .. } => (imu.rate, *samples),
            Origin::Log { log, window } => (log.rate, *window),
        };
        let velocity = self.velocity_reference(alignment.velocity.as_ref(), rate, samples)?;
        let coarse = alignment.coarse.as_ref().map(|c| self.coarse(c, rate, samples)).transpose()?;
        if let (Origin::Log { .. }, Some(Coarse::Value(_) | Coarse::Sigma(_))) = (&origin, &coarse) {
            let node = alignment.coarse.as_ref().map_or(self.root(), |c| c.node);
            return Err(self
                .diagnostic(Spot::Node(node), "errors of a true attitude, which a log does not have")
                .expected("a coarse method")
                .example("coarse: { inertial: { window: 60 s } }"));
        }
        let methods = self.methods(alignment, coarse, &velocity)?;
        let runs = alignment.runs.as_ref().map_or(1, |r| r.value);
        if let Some(node) = alignment.runs.as_ref().map(|r| r.node) {
            let one = matches!(origin, Origin::Log { .. });
            if runs == 0 || runs > (if one { 1 } else { MAX_RUNS }) {
                let expected = if one { "1: a log is what it is".into() } else { format!("1 to {MAX_RUNS}") };
                return Err(self
                    .diagnostic(Spot::Node(node), "no such number of runs")
                    .expected(expected)
                    .found(runs.to_string())
                    .example("runs: 200"));
            }
        }
        let knock = match (&alignment.knock, &origin) {
            (Some(knock), Origin::Log { .. }) => {
                return Err(self
                    .diagnostic(
                        Spot::Node(knock.node),
                        "`knock` belongs to a simulation, and there is a `log`",
                    )
                    .help("take one of them out"));
            }
            (Some(knock), Origin::Simulated { .. }) => Some(self.knock(&knock.value, rate, samples)?),
            (None, _) => None,
        };
        let navigate = match &alignment.navigate {
            Some(duration) => self.whole_samples(duration, rate)?,
            None => 0,
        };
        Ok(AlignStudy { start, origin, mechanization, methods, coarse, velocity, knock, runs, navigate })
    }

    fn origin(
        &self,
        w: &Scenario,
        alignment: &written::Alignment,
        start: &Start,
    ) -> Result<Origin, Diagnostic> {
        let Some(log) = &w.log else {
            let imu = self.required(&w.imu, "imu", "align", "imu: { rate: 100 Hz }")?;
            let imu = self.imu(imu)?;
            let samples = self.samples(w, "align", imu.rate)?;
            if let Some(window) = &alignment.window {
                return Err(self
                    .diagnostic(Spot::Node(window.node), "a window of a log, but there is no `log`")
                    .help("`duration` is the time of a simulated alignment"));
            }
            let motion = self.base(w, start, samples, 1.0 / imu.rate)?;
            return Ok(Origin::Simulated { motion, imu: Box::new(imu), samples });
        };
        for (node, key) in [
            (w.imu.as_ref().map(|k| k.node), "imu"),
            (w.motion.as_ref().map(|k| k.node), "motion"),
            (w.duration.as_ref().map(|k| k.node), "duration"),
        ] {
            if let Some(node) = node {
                return Err(self
                    .diagnostic(
                        Spot::Node(node),
                        format!("`{key}` belongs to a simulation, and there is a `log`"),
                    )
                    .help("take one of them out"));
            }
        }
        let log = self.imu_log(log)?;
        let window = alignment.window.as_ref().ok_or_else(|| {
            self.diagnostic(Spot::Node(self.root()), "the key `window` is missing")
                .expected("the length of the windows of the log that are aligned")
                .example("alignment: { window: 300 s, … }")
        })?;
        let window = self.whole_samples(window, log.rate)?;
        Ok(Origin::Log { log, window })
    }

    /// A positive time as a whole number of samples.
    pub(super) fn whole_samples(
        &self,
        written: &super::written::Quantity,
        rate: f64,
    ) -> Result<u64, Diagnostic> {
        let samples = self.quantity(written, Unit::SECOND, Range::Positive)? * rate;
        if samples.round() < 1.0 || (samples - samples.round()).abs() > 1e-6 * samples.max(1.0) {
            return Err(self
                .diagnostic(Spot::Node(written.node), "the time is not a whole number of samples")
                .found(format!("{samples} samples at {rate} Hz"))
                .example("60 s"));
        }
        Ok(samples.round() as u64)
    }

    fn velocity_reference(
        &self,
        velocity: Option<&At<written::Velocity>>,
        rate: f64,
        samples: u64,
    ) -> Result<Velocity, Diagnostic> {
        let Some(velocity) = velocity else {
            let every = rate.round().max(1.0) as u64;
            return Ok(Velocity { every, noise: 0.0, coloured: None, burst: None });
        };
        let w = &velocity.value;
        let coloured = match &w.coloured {
            Some(coloured) => Some((
                self.quantity(&coloured.value.sigma, VELOCITY, Range::NonNegative)?,
                self.quantity(&coloured.value.tau, Unit::SECOND, Range::Positive)?,
            )),
            None => None,
        };
        let burst = match &w.burst {
            Some(burst) => {
                let window = self.quantities(&burst.value.window, Unit::SECOND)?;
                if window[0] >= window[1] {
                    return Err(self
                        .diagnostic(Spot::Node(burst.value.window.node), "the burst ends before it begins")
                        .expected("begin and end")
                        .example("burst: { window: [200 s, 260 s], factor: 20 }"));
                }
                if window[0] * rate >= samples as f64 {
                    return Err(self.after_the_end(
                        burst.value.window.node,
                        "the burst begins",
                        samples,
                        rate,
                    ));
                }
                Some((window, self.quantity(&burst.value.factor, Unit::ONE, Range::NonNegative)?))
            }
            None => None,
        };
        let every = self.whole_samples(&w.every, rate)?;
        if every > samples {
            return Err(self.after_the_end(
                w.every.node,
                "the first measurement of the velocity comes",
                samples,
                rate,
            ));
        }
        Ok(Velocity {
            every,
            noise: w.noise.as_ref().map_or(Ok(0.0), |n| self.quantity(n, VELOCITY, Range::NonNegative))?,
            coloured,
            burst,
        })
    }

    fn coarse(&self, coarse: &At<written::Coarse>, rate: f64, samples: u64) -> Result<Coarse, Diagnostic> {
        let angle = |q: &super::written::Quantity, range| self.quantity(q, Unit::RADIAN, range);
        let window = |w: &written::CoarseWindow| {
            let window = self.whole_samples(&w.window, rate)?;
            if window < samples {
                return Ok(window);
            }
            Err(self
                .diagnostic(Spot::Node(w.window.node), "the coarse method takes all the time")
                .expected("a window shorter than the alignment")
                .found(format!("{} s of {} s", window as f64 / rate, samples as f64 / rate))
                .example("coarse: { inertial: { window: 60 s } }"))
        };
        Ok(match &coarse.value {
            written::Coarse::Value(value) => {
                let [n, e] = self.quantities(&value.tilt, Unit::RADIAN)?;
                Coarse::Value([n, e, angle(&value.heading, Range::Any)?])
            }
            written::Coarse::Sigma(sigma) => Coarse::Sigma([
                angle(&sigma.tilt, Range::NonNegative)?,
                angle(&sigma.heading, Range::NonNegative)?,
            ]),
            written::Coarse::Triad(w) => Coarse::Triad(window(w)?),
            written::Coarse::Inertial(w) => Coarse::Inertial(window(w)?),
        })
    }

    fn knock(&self, w: &written::Knock, rate: f64, samples: u64) -> Result<Knock, Diagnostic> {
        let angle = |q: &super::written::Quantity| self.quantity(q, Unit::RADIAN, Range::Any);
        let [n, e] = self.quantities(&w.tilt, Unit::RADIAN)?;
        let at = self.whole_samples(&w.at, rate)?;
        if at >= samples {
            return Err(self.after_the_end(w.at.node, "the knock comes", samples, rate));
        }
        Ok(Knock { at, phi: [n, e, angle(&w.heading)?] })
    }

    fn after_the_end(&self, node: NodeId, what: &str, samples: u64, rate: f64) -> Diagnostic {
        self.diagnostic(Spot::Node(node), format!("{what} after the end of the alignment"))
            .expected(format!("a time within its {} s", samples as f64 / rate))
    }

    fn methods(
        &self,
        alignment: &written::Alignment,
        coarse: Option<Coarse>,
        velocity: &Velocity,
    ) -> Result<Vec<Method>, Diagnostic> {
        let list = &alignment.methods;
        if list.value.is_empty() || list.value.len() > MAX_METHODS {
            return Err(self
                .diagnostic(Spot::Node(list.node), "no such number of methods")
                .expected(format!("1 to {MAX_METHODS}"))
                .found(list.value.len().to_string())
                .example("methods: [{ triad: {} }, { inertial: { solution: optimal } }]"));
        }
        let mut methods: Vec<Method> = Vec::new();
        for at in &list.value {
            let method = self.method(alignment, at, coarse, velocity)?;
            if methods.iter().any(|m| m.name == method.name) {
                return Err(self
                    .diagnostic(Spot::Node(at.node), format!("a second method `{}`", method.name))
                    .expected("different names in the results")
                    .example("- filter: { name: fading, strategy: { fading: { factor: 1.01 } } }"));
            }
            methods.push(method);
        }
        Ok(methods)
    }

    fn method(
        &self,
        alignment: &written::Alignment,
        at: &At<written::Method>,
        coarse: Option<Coarse>,
        velocity: &Velocity,
    ) -> Result<Method, Diagnostic> {
        let named = |name: &Option<String>, default: &str| name.clone().unwrap_or_else(|| default.into());
        let needs_coarse = matches!(at.value, written::Method::Gyrocompass(_) | written::Method::Filter(_));
        if needs_coarse && coarse.is_none() {
            return Err(self
                .diagnostic(
                    Spot::Node(at.node),
                    "this method refines an attitude, and there is none to begin with",
                )
                .expected("`alignment.coarse`")
                .example("coarse: { sigma: { tilt: 0.1 deg, heading: 1 deg } }"));
        }
        Ok(match &at.value {
            written::Method::Triad(w) => {
                let (order, name) = match w.order.unwrap_or(written::Order::ForceFirst) {
                    written::Order::ForceFirst => (Vectors::ForceFirst, "triad"),
                    written::Order::RateFirst => (Vectors::RateFirst, "triad, rate first"),
                    written::Order::Inverse => (Vectors::Inverse, "triad, inverse"),
                };
                Method { name: named(&w.name, name), kind: MethodKind::Triad(order) }
            }
            written::Method::Inertial(w) => {
                let (solution, name) = match w.solution {
                    written::Solution::Velocity => (Solution::Velocity, "inertial velocity"),
                    written::Solution::Position => (Solution::Position, "inertial position"),
                    written::Solution::Optimal => (Solution::Optimal, "inertial optimal"),
                };
                let latitude_known = !matches!(w.latitude, Some(written::Latitude::Unknown));
                let name = if latitude_known { name.into() } else { format!("{name}, latitude unknown") };
                let kind = MethodKind::Inertial { solution, latitude_known };
                Method { name: named(&w.name, &name), kind }
            }
            written::Method::Gyrocompass(w) => {
                let tau = self.quantity(&w.tau, Unit::SECOND, Range::Positive)?;
                Method { name: named(&w.name, "gyrocompass"), kind: MethodKind::Gyrocompass(tau) }
            }
            written::Method::AnyHeading(w) => {
                let noise = AnyHeadingNoise {
                    tilt: self.quantity(&w.tilt, Unit::RADIAN, Range::Positive)?,
                    velocity: 10.0 * self.quantity(&w.noise, VELOCITY, Range::Positive)?,
                    measurement: self.quantity(&w.noise, VELOCITY, Range::Positive)?,
                    angle_walk: self.quantity(
                        &w.angle_random_walk,
                        Unit::RATE.times_half_seconds(1),
                        Range::NonNegative,
                    )?,
                    velocity_walk: self.quantity(
                        &w.velocity_random_walk,
                        Unit::FORCE.times_half_seconds(1),
                        Range::NonNegative,
                    )?,
                };
                Method { name: named(&w.name, "any heading"), kind: MethodKind::AnyHeading(noise) }
            }
            written::Method::Filter(w) => {
                let settings = self.filter_settings(alignment, at, w, coarse, velocity)?;
                Method { name: named(&w.name, "filter"), kind: MethodKind::Filter(Box::new(settings)) }
            }
        })
    }
}

impl Document {
    /// A motion on the spot.
    fn base(&self, w: &Scenario, start: &Start, samples: u64, dt: f64) -> Result<Motion, Diagnostic> {
        let at = self.required(&w.motion, "motion", "align", "motion: static")?;
        let motion = self.motion(at, Some(start), Some(samples as f64 * dt))?;
        if !matches!(motion, Motion::Static | Motion::Sway(_) | Motion::Positions(..) | Motion::Coning(_)) {
            return Err(self
                .diagnostic(Spot::Node(at.node), "an alignment stays where it is")
                .expected("`static`, `sway`, `coning` or `positions`")
                .example("motion: { sway: { roll: { amplitude: 2 deg, period: 8 s } } }"));
        }
        // Any field will do to see whether it can be.
        match motion.trajectory(start, Gravity::Normal, samples, dt) {
            Ok(_) => Ok(motion),
            Err(fault) => Err(self.impossible(at, &fault)),
        }
    }
}
