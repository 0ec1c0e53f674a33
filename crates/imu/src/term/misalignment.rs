use super::{Coefficients, Term};
use crate::{Input, Instrument, Unit};

/// Small angles between the sensitive axes and the sensor frame.
///
/// Coefficient `xz` is the part of the input along z that is seen on the output of x.
pub struct Misalignment;

impl Term for Misalignment {
    fn name(&self) -> &'static str {
        "misalignment"
    }
    fn doc(&self) -> &'static str {
        "Small angles of the sensitive axes; xz is the part of input z seen on output x"
    }
    fn formula(&self) -> &'static str {
        "e_i = sum over j != i of m_ij u_j"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, misalignment"
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE
    }
    fn labels(&self) -> &'static [&'static str] {
        &["xy", "xz", "yx", "yz", "zx", "zy"]
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let [ux, uy, uz] = x.u;
        [c[0] * uy + c[1] * uz, c[2] * ux + c[3] * uz, c[4] * ux + c[5] * uy]
    }
}
