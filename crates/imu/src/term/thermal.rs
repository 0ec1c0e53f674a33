use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Bias proportional to T - T_cal.
pub struct Thermal;

impl Term for Thermal {
    fn name(&self) -> &'static str {
        "thermal"
    }
    fn doc(&self) -> &'static str {
        "Bias proportional to T - T_cal"
    }
    fn formula(&self) -> &'static str {
        "e_i = c_i (T - T_cal)"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, bias temperature sensitivity"
    }
    fn unit(&self, instrument: Instrument) -> Unit {
        instrument.unit().over(Unit::KELVIN)
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_axis(c, [x.delta_t; 3])
    }
}
