use super::{Coefficients, MATRIX, Term, by_matrix};
use crate::{Input, Instrument, Unit};

/// Rotation of the case, exact for any angle: coefficients are the entries of C_sb - 1.
///
/// [`mounting_coefficients`] makes them from roll, pitch and yaw.
pub struct Mounting;

impl Term for Mounting {
    fn name(&self) -> &'static str {
        "mounting"
    }
    fn doc(&self) -> &'static str {
        "Rotation of the case, exact for any angle: coefficients are the entries of C_sb - 1"
    }
    fn formula(&self) -> &'static str {
        "e_i = sum over j of (C_sb - 1)_ij u_j"
    }
    fn source(&self) -> &'static str {
        "Exact direction cosines in place of small angles"
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE
    }
    fn labels(&self) -> &'static [&'static str] {
        MATRIX
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        by_matrix(c, x.u)
    }
}

/// Coefficients of the term `mounting` for a case that is turned from the body by `yaw`, then
/// `pitch`, then `roll` (rad): C_sb - 1, row by row, exact.
pub fn mounting_coefficients(roll: f64, pitch: f64, yaw: f64) -> Coefficients {
    let ((sr, cr), (sp, cp), (sy, cy)) = (libm::sincos(roll), libm::sincos(pitch), libm::sincos(yaw));
    [
        cp * cy - 1.0,
        cp * sy,
        -sp,
        sr * sp * cy - cr * sy,
        sr * sp * sy + cr * cy - 1.0,
        sr * cp,
        cr * sp * cy + sr * sy,
        cr * sp * sy - sr * cy,
        cr * cp - 1.0,
    ]
}
