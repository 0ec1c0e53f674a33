use super::{Coefficients, MATRIX, Term, by_matrix};
use crate::{Input, Instrument, Unit};

/// Rate error proportional to squares of specific force; xz is the part of f_z^2 seen on output x.
///
/// The diagonal of the symmetric quadratic form in f; `anisoelastic` has the rest.
pub struct GSquared;

impl Term for GSquared {
    fn name(&self) -> &'static str {
        "g_squared"
    }
    fn doc(&self) -> &'static str {
        "Rate error proportional to squares of specific force; xz is the part of f_z^2 seen on output x"
    }
    fn formula(&self) -> &'static str {
        "e_i = sum over j of d_ij f_j^2"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, acceleration-squared-sensitive drift rate"
    }
    fn instruments(&self) -> &'static [Instrument] {
        &[Instrument::Gyro]
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::RATE.over(Unit::FORCE).over(Unit::FORCE)
    }
    fn labels(&self) -> &'static [&'static str] {
        MATRIX
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let [fx, fy, fz] = x.f;
        by_matrix(c, [fx * fx, fy * fy, fz * fz])
    }
}
