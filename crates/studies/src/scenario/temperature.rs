//! The temperature of a run.

use schuler_imu::Unit;

use super::{
    de::At,
    document::{Document, Spot},
    quantity::Range,
    schema::Scalar,
    valid::Temperature,
    written,
};
use crate::Diagnostic;

/// Zero of the Celsius scale, K (exact by definition).
const CELSIUS: f64 = 273.15;

impl Document {
    pub(super) fn temperature(&self, w: &written::Temperature) -> Result<Temperature, Diagnostic> {
        Ok(match w {
            written::Temperature::Constant(value) => Temperature::Constant(self.absolute_temperature(value)?),
            written::Temperature::Ramp(ramp) => Temperature::Ramp {
                start: self.absolute_temperature(&ramp.start)?,
                rate: self.quantity(&ramp.rate, Unit::KELVIN.over(Unit::SECOND), Range::Any)?,
            },
            written::Temperature::WarmUp(warm_up) => Temperature::WarmUp {
                start: self.absolute_temperature(&warm_up.start)?,
                end: self.absolute_temperature(&warm_up.end)?,
                tau: self.quantity(&warm_up.tau, Unit::SECOND, Range::Positive)?,
            },
            written::Temperature::Table(table) => Temperature::Table(self.table(table)?),
        })
    }

    fn table(&self, table: &At<Vec<At<[At<Scalar>; 2]>>>) -> Result<Vec<(f64, f64)>, Diagnostic> {
        let example = "table: [[0 s, 20 degC], [10 min, 45 degC]]";
        let mut points: Vec<(f64, f64)> = Vec::new();
        for point in &table.value {
            let [time, temperature] = &point.value;
            let t = self.quantity(time, Unit::SECOND, Range::Any)?;
            if let Some((before, _)) = points.last().filter(|(before, _)| *before >= t) {
                return Err(self
                    .diagnostic(Spot::Node(time.node), "the times of the table do not increase")
                    .expected(format!("a time after {before} s"))
                    .found(format!("{t} s"))
                    .example(example));
            }
            points.push((t, self.absolute_temperature(temperature)?));
        }
        if points.is_empty() {
            return Err(self
                .diagnostic(Spot::Node(table.node), "the table has no point")
                .expected("one point [time, temperature] or more")
                .example(example));
        }
        Ok(points)
    }

    /// A temperature on the Kelvin or the Celsius scale, K. Anywhere else `degC` is a difference.
    pub(super) fn absolute_temperature(&self, written: &At<Scalar>) -> Result<f64, Diagnostic> {
        let kelvin = self.quantity(written, Unit::KELVIN, Range::Any)?;
        let celsius = match &written.value {
            Scalar::Text(text) => ["degC", "°C"].iter().any(|symbol| text.trim_end().ends_with(symbol)),
            Scalar::Bare(_) => false,
        };
        let kelvin = if celsius { kelvin + CELSIUS } else { kelvin };
        if kelvin > 0.0 {
            return Ok(kelvin);
        }
        Err(self
            .diagnostic(Spot::Node(written.node), "no temperature above absolute zero")
            .expected("an absolute temperature, in degC or K")
            .found(format!("{kelvin:.2} K"))
            .example("20 degC"))
    }
}
