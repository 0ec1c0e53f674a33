//! What can be wrong with numbers that are offered as a rotation.

/// Why numbers from outside are not a rotation. Checks allow what a table printed with six digits
/// loses; what passes is made a rotation to rounding.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RotationError {
    /// The quaternion's norm is not 1.
    #[error("a rotation needs a quaternion of norm 1 (within 1e-6), but its norm is {norm}")]
    NotUnit {
        /// Norm of the quaternion given.
        norm: f64,
    },
    /// The rows of the matrix are not orthogonal unit vectors.
    #[error(
        "a rotation needs orthogonal rows of length 1 (within 1e-6), but C Cᵀ differs from the identity by {excess}"
    )]
    NotOrthonormal {
        /// Largest element of C Cᵀ - 1, by magnitude.
        excess: f64,
    },
    /// The matrix is orthonormal, but left-handed: an axis is reversed.
    #[error("a rotation needs determinant +1, but this matrix has -1: one axis is reversed")]
    Reflection,
}

/// How far a norm or an element of C Cᵀ may be from what it should be.
pub(crate) const TOLERANCE: f64 = 1e-6;
