use super::{Coefficients, Term};
use crate::{Input, Instrument, Unit};

/// Products with the acceleration along the output axis: io with the input, po with the pendulous axis.
///
/// The pendulous axis p of the accelerometer along i is the next axis, its output axis o the one after.
pub struct CrossCoupling;

impl Term for CrossCoupling {
    fn name(&self) -> &'static str {
        "cross_coupling"
    }
    fn doc(&self) -> &'static str {
        "Products with the acceleration along the output axis: io with the input, po with the pendulous axis"
    }
    fn formula(&self) -> &'static str {
        "e_i = k_io f_i f_o + k_po f_p f_o, (i, p, o) = (x, y, z) and cyclic"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 1293, cross-coupling coefficients"
    }
    fn instruments(&self) -> &'static [Instrument] {
        &[Instrument::Accel]
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE.over(Unit::FORCE)
    }
    fn labels(&self) -> &'static [&'static str] {
        &["x_io", "x_po", "y_io", "y_po", "z_io", "z_po"]
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let [fx, fy, fz] = x.f;
        [c[0] * fx * fz + c[1] * fy * fz, c[2] * fy * fx + c[3] * fz * fx, c[4] * fz * fy + c[5] * fx * fy]
    }
}
