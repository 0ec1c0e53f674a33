use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Relative error of the linear scale factor.
pub struct ScaleFactor;

impl Term for ScaleFactor {
    fn name(&self) -> &'static str {
        "scale_factor"
    }
    fn doc(&self) -> &'static str {
        "Relative error of the linear scale factor"
    }
    fn formula(&self) -> &'static str {
        "e_i = k_i u_i"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, scale factor error"
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_axis(c, x.u)
    }
}
