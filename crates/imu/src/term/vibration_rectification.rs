use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Bias shift proportional to the mean square of vibration along the axis.
pub struct VibrationRectification;

impl Term for VibrationRectification {
    fn name(&self) -> &'static str {
        "vibration_rectification"
    }
    fn doc(&self) -> &'static str {
        "Bias shift proportional to the mean square of vibration along the axis"
    }
    fn formula(&self) -> &'static str {
        "e_i = v_i mean(a_i^2)"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 1293, vibration rectification error"
    }
    fn unit(&self, instrument: Instrument) -> Unit {
        instrument.unit().over(Unit::FORCE).over(Unit::FORCE)
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_axis(c, x.vibration)
    }
}
