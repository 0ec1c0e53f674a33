use super::{Coefficients, Term};
use crate::{Input, Instrument, Unit};

/// Small angles between the sensitive axes: x is right, y leans in the xy plane, z in both.
///
/// With a rotation of the case (`mounting`) this is the whole misalignment, split in two.
pub struct NonOrthogonality;

impl Term for NonOrthogonality {
    fn name(&self) -> &'static str {
        "non_orthogonality"
    }
    fn doc(&self) -> &'static str {
        "Small angles between the sensitive axes: x is right, y leans in the xy plane, z in both"
    }
    fn formula(&self) -> &'static str {
        "e_y = n_yx u_x, e_z = n_zx u_x + n_zy u_y"
    }
    fn source(&self) -> &'static str {
        "Split of misalignment into a lower triangle and a rotation of the case"
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE
    }
    fn labels(&self) -> &'static [&'static str] {
        &["yx", "zx", "zy"]
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let [ux, uy, _] = x.u;
        [0.0, c[0] * ux, c[1] * ux + c[2] * uy]
    }
}
