use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Bias proportional to the rate of the temperature.
pub struct ThermalRate;

impl Term for ThermalRate {
    fn name(&self) -> &'static str {
        "thermal_rate"
    }
    fn doc(&self) -> &'static str {
        "Bias proportional to the rate of the temperature"
    }
    fn formula(&self) -> &'static str {
        "e_i = c_i dT/dt"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 952, bias temperature-ramp sensitivity"
    }
    fn unit(&self, instrument: Instrument) -> Unit {
        instrument.unit().times(Unit::SECOND).over(Unit::KELVIN)
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_axis(c, [x.temperature_rate; 3])
    }
}
