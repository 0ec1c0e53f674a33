use super::{Coefficients, PRODUCTS, Term, by_matrix, products};
use crate::{Input, Instrument, Unit};

/// Rate error proportional to products of specific force along two axes.
///
/// The off-diagonal part of the symmetric quadratic form in f; `g_squared` has the diagonal.
pub struct Anisoelastic;

impl Term for Anisoelastic {
    fn name(&self) -> &'static str {
        "anisoelastic"
    }
    fn doc(&self) -> &'static str {
        "Rate error proportional to products of specific force along two axes"
    }
    fn formula(&self) -> &'static str {
        "e_i = d_i,yz f_y f_z + d_i,zx f_z f_x + d_i,xy f_x f_y"
    }
    fn source(&self) -> &'static str {
        "Titterton and Weston, Strapdown Inertial Navigation Technology, anisoelastic bias"
    }
    fn instruments(&self) -> &'static [Instrument] {
        &[Instrument::Gyro]
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::RATE.over(Unit::FORCE).over(Unit::FORCE)
    }
    fn labels(&self) -> &'static [&'static str] {
        PRODUCTS
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_matrix(c, products(x.f))
    }
}
