//! Angular rates that know what turns, against what, and where they are resolved.

use core::marker::PhantomData;
use core::ops::{Add, Mul, Neg, Sub};

use crate::{Dcm, Frame, Real, Rot, Vec3};

/// Angular rate of frame `A` with respect to frame `R`, resolved in frame `F` (rad/s):
/// `Rate<B, I, B>` is the field's omega_ib^b, what a gyro senses.
///
/// Rates of a chain add: `Rate<A, M, F> + Rate<M, R, F> = Rate<A, R, F>`; anything else does not compile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rate<A: Frame, R: Frame, F: Frame, S = f64>(Vec3<F, S>, PhantomData<(A, R)>);

impl<A: Frame, R: Frame, F: Frame, S> Rate<A, R, F, S> {
    /// The door from untyped to typed: claims that `omega` (rad/s) is the rate of `A` with respect to `R`.
    #[inline(always)]
    pub const fn claim(omega: Vec3<F, S>) -> Self {
        Rate(omega, PhantomData)
    }

    /// The rate as a plain vector of `F`, rad/s.
    #[inline(always)]
    pub fn as_vec3(self) -> Vec3<F, S> {
        self.0
    }
}

impl<A: Frame, M: Frame, R: Frame, F: Frame, S: Real> Add<Rate<M, R, F, S>> for Rate<A, M, F, S> {
    type Output = Rate<A, R, F, S>;
    #[inline(always)]
    fn add(self, o: Rate<M, R, F, S>) -> Rate<A, R, F, S> {
        Rate::claim(self.0 + o.0)
    }
}

/// `omega_ar - omega_mr = omega_am`: what is common to both is taken away.
impl<A: Frame, M: Frame, R: Frame, F: Frame, S: Real> Sub<Rate<M, R, F, S>> for Rate<A, R, F, S> {
    type Output = Rate<A, M, F, S>;
    #[inline(always)]
    fn sub(self, o: Rate<M, R, F, S>) -> Rate<A, M, F, S> {
        Rate::claim(self.0 - o.0)
    }
}

/// `-omega_ar = omega_ra`: object and reference change places.
impl<A: Frame, R: Frame, F: Frame, S: Real> Neg for Rate<A, R, F, S> {
    type Output = Rate<R, A, F, S>;
    #[inline(always)]
    fn neg(self) -> Rate<R, A, F, S> {
        Rate::claim(-self.0)
    }
}

impl<To: Frame, From: Frame, A: Frame, R: Frame, S: Real> Mul<Rate<A, R, From, S>> for Rot<To, From, S> {
    type Output = Rate<A, R, To, S>;
    #[inline(always)]
    fn mul(self, omega: Rate<A, R, From, S>) -> Rate<A, R, To, S> {
        Rate::claim(self * omega.0)
    }
}

impl<To: Frame, From: Frame, A: Frame, R: Frame, S: Real> Mul<Rate<A, R, From, S>> for Dcm<To, From, S> {
    type Output = Rate<A, R, To, S>;
    #[inline(always)]
    fn mul(self, omega: Rate<A, R, From, S>) -> Rate<A, R, To, S> {
        Rate::claim(self * omega.0)
    }
}
