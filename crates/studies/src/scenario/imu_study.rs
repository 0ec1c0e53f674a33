//! `study: imu`: its motion and what is drawn of it.

use schuler_imu::Unit;

use super::{
    de::At,
    document::{Document, Spot},
    quantity::Range,
    valid::{ImuStudy, Motion, RateTable, Temperature},
    written,
};
use crate::Diagnostic;

/// Samples that an Allan picture keeps in memory, six numbers each.
const MAX_ALLAN: u64 = 20_000_000;

impl Document {
    pub(super) fn imu_study(&self, w: &written::Scenario) -> Result<ImuStudy, Diagnostic> {
        let motion = self.required(&w.motion, "motion", "imu", "motion: zero_truth")?;
        let needs_start = !matches!(motion.value, written::Motion::ZeroTruth);
        let start = match &w.start {
            None if needs_start => Some(self.required_start(w, "imu")?),
            start => start.as_ref().map(|s| self.start(s)).transpose()?,
        };
        let imu = self.imu(self.required(&w.imu, "imu", "imu", "imu: { rate: 100 Hz }")?)?;
        let samples = self.samples(w, "imu", imu.rate)?;
        let motion = match &motion.value {
            written::Motion::ZeroTruth => Motion::ZeroTruth,
            written::Motion::Static => Motion::Static,
            written::Motion::RateTable(table) => {
                Motion::RateTable(self.rate_table(table, samples as f64 / imu.rate)?)
            }
        };
        let allan = w.output.as_ref().and_then(|output| output.value.allan.as_ref()).filter(|a| a.value);
        if let Some(allan) = allan {
            self.unchanging(allan, &motion, imu.temperature.as_ref(), samples)?;
        }
        Ok(ImuStudy { motion, start, samples, imu, allan: allan.is_some() })
    }

    fn rate_table(&self, w: &written::RateTable, duration: f64) -> Result<RateTable, Diagnostic> {
        let rate = self.quantity(&w.rate, Unit::RATE, Range::Positive)?;
        let acceleration = match &w.acceleration {
            None => f64::INFINITY,
            Some(written) => {
                let unit = Unit::RATE.over(Unit::SECOND);
                let acceleration = self.quantity(written, unit, Range::Positive)?;
                let least = 12.0 * rate / duration;
                if acceleration < least {
                    return Err(self
                        .diagnostic(Spot::Node(written.node), "the table does not reach its rate")
                        .expected(format!(
                            "{:.4} deg/s^2 or more: it starts and stops in a sixth of the duration",
                            least.to_degrees()
                        ))
                        .found(format!("{:.4} deg/s^2", acceleration.to_degrees()))
                        .example("acceleration: 60 deg/s^2"));
                }
                acceleration
            }
        };
        let vibration = match &w.vibration {
            None => [0.0; 3],
            Some(vibration) => self.each_axis(vibration, Unit::FORCE, Range::NonNegative)?,
        };
        Ok(RateTable {
            rate,
            tilt: self.quantity(&w.tilt, Unit::RADIAN, Range::Any)?,
            acceleration,
            vibration,
        })
    }

    /// Theory has Allan deviations of errors under an input that stays as it is.
    fn unchanging(
        &self,
        allan: &At<bool>,
        motion: &Motion,
        temperature: Option<&Temperature>,
        samples: u64,
    ) -> Result<(), Diagnostic> {
        let fault = |problem: &str| self.diagnostic(Spot::Node(allan.node), problem);
        if matches!(motion, Motion::RateTable(_)) {
            return Err(fault("no Allan deviation of a motion")
                .expected("an instrument that stands still")
                .example("motion: static"));
        }
        if !matches!(temperature, None | Some(Temperature::Constant(_))) {
            return Err(fault("no Allan deviation of a temperature that changes")
                .expected("a constant temperature")
                .example("temperature: { constant: 35 degC }"));
        }
        if samples > MAX_ALLAN {
            return Err(fault("an Allan picture of more than 20 million samples")
                .expected("a shorter duration or a lower rate")
                .found(format!("{samples} samples")));
        }
        Ok(())
    }
}
