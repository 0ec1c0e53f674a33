use super::{Coefficients, MATRIX, Term, lever_gradient};
use crate::{Input, Instrument, Unit};

/// Each accelerometer senses at its own point: lever arm of each from the reference point.
///
/// Coefficient `xz` is the z coordinate of the accelerometer that points along x.
pub struct SizeEffect;

impl Term for SizeEffect {
    fn name(&self) -> &'static str {
        "size_effect"
    }
    fn doc(&self) -> &'static str {
        "Each accelerometer senses at its own point: lever arm of each from the reference point"
    }
    fn formula(&self) -> &'static str {
        "e_i = row i of (w x (w x r_i) + dw/dt x r_i)"
    }
    fn source(&self) -> &'static str {
        "Savage, Strapdown Analytics, accelerometer size effect"
    }
    fn instruments(&self) -> &'static [Instrument] {
        &[Instrument::Accel]
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::METRE
    }
    fn labels(&self) -> &'static [&'static str] {
        MATRIX
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let g = lever_gradient(x);
        let row = |i: usize| g[i][0] * c[3 * i] + g[i][1] * c[3 * i + 1] + g[i][2] * c[3 * i + 2];
        [row(0), row(1), row(2)]
    }
}
