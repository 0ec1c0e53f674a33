use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Scale factor that differs between positive and negative input.
///
/// The scale factor is too large by a for positive and too small by a for negative input.
pub struct Asymmetry;

impl Term for Asymmetry {
    fn name(&self) -> &'static str {
        "asymmetry"
    }
    fn doc(&self) -> &'static str {
        "Scale factor that differs between positive and negative input"
    }
    fn formula(&self) -> &'static str {
        "e_i = a_i |u_i|"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, scale factor asymmetry"
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_axis(c, [x.u[0].abs(), x.u[1].abs(), x.u[2].abs()])
    }
}
