use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Second-order non-linearity along the input axis.
pub struct Quadratic;

impl Term for Quadratic {
    fn name(&self) -> &'static str {
        "quadratic"
    }
    fn doc(&self) -> &'static str {
        "Second-order non-linearity along the input axis"
    }
    fn formula(&self) -> &'static str {
        "e_i = k2_i u_i^2"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 1293, second-order nonlinearity coefficient K2"
    }
    fn unit(&self, instrument: Instrument) -> Unit {
        Unit::ONE.over(instrument.unit())
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let [ux, uy, uz] = x.u;
        by_axis(c, [ux * ux, uy * uy, uz * uz])
    }
}
