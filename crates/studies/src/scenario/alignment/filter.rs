//! What a filter takes as given: its own settings before those of `alignment.filter`.

use schuler_imu::{Spec, Unit};
use schuler_strapdown::filter::Form;

use super::super::{
    de::At,
    document::{Document, Spot},
    quantity::Range,
    schema::Sources,
    sources,
    written::Quantity,
};
use super::{
    VELOCITY,
    valid::{Coarse, FilterSettings, Strategy, StrategyKind, Velocity},
    written,
};
use crate::Diagnostic;

/// Probability of a false alarm where none is given.
const GATE: f64 = 1e-3;

/// Measurements in a batch of residuals.
const BATCH: usize = 5;

/// Largest number of them: in longer ones nothing would be learned in an alignment.
const MAX_BATCH: usize = 1000;

impl Document {
    pub(super) fn filter_settings(
        &self,
        alignment: &written::Alignment,
        method: &At<written::Method>,
        own: &written::Filter,
        coarse: Option<Coarse>,
        velocity: &Velocity,
    ) -> Result<FilterSettings, Diagnostic> {
        let shared = alignment.filter.as_ref().map(|f| &f.value);
        let sources = |key: &str, get: fn(&written::Filter) -> &Option<At<Sources>>| {
            get(own).as_ref().or_else(|| get(shared?).as_ref()).ok_or_else(|| {
                self.diagnostic(Spot::Node(method.node), format!("the filter does not say which {key} errors it knows of"))
                    .expected(format!("a list `{key}` of error sources, here or in `alignment.filter`; empty where it knows of none"))
                    .example("filter: { gyro: [bias: { constant: { sigma: 0.01 deg/h } }], accel: [] }")
            })
        };
        let mut spec = Spec::new();
        let (gyro, accel) = (sources("gyro", |f| &f.gyro)?, sources("accel", |f| &f.accel)?);
        sources::add(self, &mut spec, &gyro.value, &accel.value)?;

        let sigma = |get: fn(&written::Filter) -> &Option<Quantity>, unit, range| {
            let written = get(own).as_ref().or_else(|| get(shared?).as_ref());
            written.map(|w| self.quantity(w, unit, range)).transpose()
        };
        let missing = |key: &str, example: &str| {
            self.diagnostic(Spot::Node(method.node), format!("the filter needs `{key}`"))
                .expected("a standard deviation, here or in `alignment.filter`")
                .example(example)
        };
        let drawn = match coarse {
            Some(Coarse::Sigma(sigma)) => Some(sigma),
            _ => None,
        };
        let position =
            matches!(own.measurement.or_else(|| shared?.measurement), Some(written::Measurement::Position));
        let noise_unit = if position { Unit::METRE } else { VELOCITY };
        let known_noise = (!position && velocity.noise > 0.0).then_some(velocity.noise);
        Ok(FilterSettings {
            spec,
            tilt: sigma(|f| &f.tilt, Unit::RADIAN, Range::Positive)?
                .or(drawn.map(|d| d[0]))
                .ok_or_else(|| missing("tilt", "tilt: 0.1 deg"))?,
            heading: sigma(|f| &f.heading, Unit::RADIAN, Range::Positive)?
                .or(drawn.map(|d| d[1]))
                .ok_or_else(|| missing("heading", "heading: 1 deg"))?,
            velocity: sigma(|f| &f.velocity, VELOCITY, Range::NonNegative)?.unwrap_or(0.1),
            noise: sigma(|f| &f.noise, noise_unit, Range::Positive)?
                .or(known_noise)
                .ok_or_else(|| missing("noise", "noise: 0.02 m/s"))?,
            coloured: match own.coloured.as_ref().or_else(|| shared?.coloured.as_ref()) {
                Some(coloured) => Some((
                    self.quantity(&coloured.value.sigma, noise_unit, Range::Positive)?,
                    self.quantity(&coloured.value.tau, Unit::SECOND, Range::Positive)?,
                )),
                None => None,
            },
            position,
            bound: match own.bound.as_ref().or_else(|| shared?.bound.as_ref()) {
                Some(bound) => Some([
                    self.quantity(&bound.value.tilt, Unit::RADIAN, Range::Positive)?,
                    self.quantity(&bound.value.heading, Unit::RADIAN, Range::Positive)?,
                ]),
                None => None,
            },
            form: match own.form.or_else(|| shared?.form) {
                Some(written::Form::Psi) => Form::Psi,
                Some(written::Form::Phi) | None => Form::Phi,
            },
            strategy: match own.strategy.as_ref().or_else(|| shared?.strategy.as_ref()) {
                Some(strategy) => self.strategy(&strategy.value)?,
                None => Strategy { kind: StrategyKind::Plain, cap: true },
            },
        })
    }

    fn strategy(&self, strategy: &written::Strategy) -> Result<Strategy, Diagnostic> {
        let at_least_one = |q: &Quantity, what: &str| {
            let value = self.quantity(q, Unit::ONE, Range::Positive)?;
            if value >= 1.0 { Ok(value) } else { Err(self.outside(q, what, "1 or more", value)) }
        };
        let below_one = |q: &Quantity, what: &str| {
            let value = self.quantity(q, Unit::ONE, Range::Positive)?;
            if value < 1.0 { Ok(value) } else { Err(self.outside(q, what, "above 0 and below 1", value)) }
        };
        let gate = |w: &written::Windowed| w.gate.as_ref().map_or(Ok(GATE), |q| below_one(q, "probability"));
        let (kind, cap) = match strategy {
            written::Strategy::Fading(w) => (StrategyKind::Fading(at_least_one(&w.factor, "factor")?), w.cap),
            written::Strategy::SingleFactor(w) => (StrategyKind::SingleFactor(gate(w)?), w.cap),
            written::Strategy::MultipleFading(w) => (StrategyKind::MultipleFading(gate(w)?), w.cap),
            written::Strategy::StrongTracking(w) => {
                (StrategyKind::StrongTracking(at_least_one(&w.beta, "softening factor")?), w.cap)
            }
            written::Strategy::Forgetting(w) => {
                (StrategyKind::Forgetting(at_least_one(&w.memory, "memory")?), w.cap)
            }
            written::Strategy::ResidualNoise => (StrategyKind::ResidualNoise, None),
            written::Strategy::BatchNoise(w) => (StrategyKind::BatchNoise(self.batch(w)?), None),
            written::Strategy::SageHusa(w) => {
                (StrategyKind::SageHusa(below_one(&w.forgetting, "forgetting factor")?), None)
            }
        };
        Ok(Strategy { kind, cap: cap.unwrap_or(true) })
    }

    fn batch(&self, w: &written::BatchNoise) -> Result<usize, Diagnostic> {
        match &w.length {
            None => Ok(BATCH),
            Some(length) if (1..=MAX_BATCH as u64).contains(&length.value) => Ok(length.value as usize),
            Some(length) => Err(self
                .diagnostic(Spot::Node(length.node), "no such length of a batch")
                .expected(format!("1 to {MAX_BATCH} measurements"))
                .found(length.value.to_string())
                .example("batch_noise: { length: 5 }")),
        }
    }

    fn outside(&self, q: &Quantity, what: &str, expected: &str, found: f64) -> Diagnostic {
        self.diagnostic(Spot::Node(q.node), format!("the {what} is out of range"))
            .expected(expected)
            .found(found.to_string())
    }
}
