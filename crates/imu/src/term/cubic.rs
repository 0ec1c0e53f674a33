use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Third-order non-linearity along the input axis.
pub struct Cubic;

impl Term for Cubic {
    fn name(&self) -> &'static str {
        "cubic"
    }
    fn doc(&self) -> &'static str {
        "Third-order non-linearity along the input axis"
    }
    fn formula(&self) -> &'static str {
        "e_i = k3_i u_i^3"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 1293, third-order nonlinearity coefficient K3"
    }
    fn unit(&self, instrument: Instrument) -> Unit {
        Unit::ONE.over(instrument.unit()).over(instrument.unit())
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let [ux, uy, uz] = x.u;
        by_axis(c, [ux * ux * ux, uy * uy * uy, uz * uz * uz])
    }
}
