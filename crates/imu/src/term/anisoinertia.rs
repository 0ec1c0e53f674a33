use super::{Coefficients, PRODUCTS, Term, by_matrix, products};
use crate::{Input, Instrument, Unit};

/// Rate error proportional to products of rates about two axes.
pub struct Anisoinertia;

impl Term for Anisoinertia {
    fn name(&self) -> &'static str {
        "anisoinertia"
    }
    fn doc(&self) -> &'static str {
        "Rate error proportional to products of rates about two axes"
    }
    fn formula(&self) -> &'static str {
        "e_i = a_i,yz w_y w_z + a_i,zx w_z w_x + a_i,xy w_x w_y"
    }
    fn source(&self) -> &'static str {
        "Titterton and Weston, Strapdown Inertial Navigation Technology, anisoinertia error"
    }
    fn instruments(&self) -> &'static [Instrument] {
        &[Instrument::Gyro]
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE.over(Unit::RATE)
    }
    fn labels(&self) -> &'static [&'static str] {
        PRODUCTS
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_matrix(c, products(x.omega))
    }
}
