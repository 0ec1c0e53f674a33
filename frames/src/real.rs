//! The number that kernels are generic over.

use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A number with the four operations that hot loops use: no division, square root or
/// trigonometry. `f64` is one; lanes of `f64`, dual numbers and double-double can be others.
///
/// Constants enter through `f64` on the right of an operator or through [`Real::lift`], because a
/// lane type may need a witness value to be built from.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// The constant `c` as a number of the kind of `self`.
    fn lift(self, c: f64) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn lift(self, c: f64) -> f64 {
        c
    }
}
