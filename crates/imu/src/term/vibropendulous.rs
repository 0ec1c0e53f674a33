use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Product of the accelerations along input and pendulous axis.
///
/// Vibration along both axes in phase rectifies to half the product of the amplitudes.
pub struct Vibropendulous;

impl Term for Vibropendulous {
    fn name(&self) -> &'static str {
        "vibropendulous"
    }
    fn doc(&self) -> &'static str {
        "Product of the accelerations along input and pendulous axis"
    }
    fn formula(&self) -> &'static str {
        "e_i = k_ip f_i f_p, (i, p) = (x, y) and cyclic"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 1293, cross-coupling coefficient K_ip; Titterton and Weston, vibro-pendulous error"
    }
    fn instruments(&self) -> &'static [Instrument] {
        &[Instrument::Accel]
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE.over(Unit::FORCE)
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let [fx, fy, fz] = x.f;
        by_axis(c, [fx * fy, fy * fz, fz * fx])
    }
}
