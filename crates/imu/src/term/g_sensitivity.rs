use super::{Coefficients, MATRIX, Term, by_matrix};
use crate::{Input, Instrument, Unit};

/// Rate error proportional to specific force; xz is the part of f_z seen on output x.
pub struct GSensitivity;

impl Term for GSensitivity {
    fn name(&self) -> &'static str {
        "g_sensitivity"
    }
    fn doc(&self) -> &'static str {
        "Rate error proportional to specific force; xz is the part of f_z seen on output x"
    }
    fn formula(&self) -> &'static str {
        "e_i = sum over j of g_ij f_j"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, acceleration-sensitive drift rate"
    }
    fn instruments(&self) -> &'static [Instrument] {
        &[Instrument::Gyro]
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::RATE.over(Unit::FORCE)
    }
    fn labels(&self) -> &'static [&'static str] {
        MATRIX
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_matrix(c, x.f)
    }
}
