use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Bias proportional to the third power of T - T_cal.
pub struct Thermal3;

impl Term for Thermal3 {
    fn name(&self) -> &'static str {
        "thermal_3"
    }
    fn doc(&self) -> &'static str {
        "Bias proportional to the third power of T - T_cal"
    }
    fn formula(&self) -> &'static str {
        "e_i = c_i (T - T_cal)^3"
    }
    fn source(&self) -> &'static str {
        "Third order of the thermal polynomial of a bias"
    }
    fn unit(&self, instrument: Instrument) -> Unit {
        instrument.unit().over(Unit::KELVIN).over(Unit::KELVIN).over(Unit::KELVIN)
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_axis(c, [x.delta_t * x.delta_t * x.delta_t; 3])
    }
}
