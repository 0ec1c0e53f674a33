//! Rotations between frames as unit quaternions.

use core::marker::PhantomData;
use core::ops::Mul;

use crate::error::TOLERANCE;
use crate::{Dcm, Frame, Real, RotationError, Vec3};

/// The rotation that takes a vector resolved in `From` to the same vector resolved in `To`
/// (`c_tb: Rot<T, B>`, `f_t = c_tb * f_b`).
///
/// Stored as a Hamilton unit quaternion, scalar first. A frame must match at every product:
/// `Rot<A, B> * Rot<B, C> = Rot<A, C>`, `Rot<A, B> * Vec3<B> = Vec3<A>`.
///
/// `q` and `-q` are the same rotation, and `==` compares components: to compare rotations use
/// [`phi_between`](crate::phi_between). Products of rotations leave norm 1 by rounding, 1e-16 a step:
/// long chains need [`Rot::normalized`] now and then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rot<To: Frame, From: Frame, S = f64>([S; 4], PhantomData<(To, From)>);

impl<To: Frame, From: Frame, S> Rot<To, From, S> {
    /// The door from untyped to typed: claims that `wxyz` is a unit quaternion, scalar first, that
    /// takes vectors from `From` to `To`. Nothing is checked or normalised.
    #[inline(always)]
    pub const fn claim(wxyz: [S; 4]) -> Self {
        Rot(wxyz, PhantomData)
    }

    /// Quaternion components, scalar first.
    #[inline(always)]
    pub fn as_quaternion(self) -> [S; 4] {
        self.0
    }
}

impl<To: Frame, From: Frame, S: Real> Rot<To, From, S> {
    /// The inverse rotation, `From` from `To`.
    #[inline(always)]
    pub fn inverse(self) -> Rot<From, To, S> {
        let [w, x, y, z] = self.0;
        Rot::claim([w, -x, -y, -z])
    }

    /// Direction cosine matrix; cheaper than the quaternion when several vectors are turned.
    #[inline(always)]
    pub fn as_dcm(self) -> Dcm<To, From, S> {
        let [w, x, y, z] = self.0;
        let (x2, y2, z2) = (x + x, y + y, z + z);
        let (xx, yy, zz) = (x * x2, y * y2, z * z2);
        let (xy, xz, yz) = (x * y2, x * z2, y * z2);
        let (wx, wy, wz) = (w * x2, w * y2, w * z2);
        let one = w.lift(1.0);
        Dcm::claim([
            [one - yy - zz, xy - wz, xz + wy],
            [xy + wz, one - xx - zz, yz - wx],
            [xz - wy, yz + wx, one - xx - yy],
        ])
    }
}

impl<To: Frame, From: Frame> Rot<To, From> {
    /// No rotation: the two frames coincide.
    pub const IDENTITY: Self = Self::claim([1.0, 0.0, 0.0, 0.0]);

    /// From quaternion components, scalar first, checked: the norm must be 1 within 1e-6. What passes is normalised.
    pub fn from_quaternion(wxyz: [f64; 4]) -> Result<Self, RotationError> {
        let norm = norm(wxyz);
        // Asked this way round, a NaN is an error as well.
        if (norm - 1.0).abs() <= TOLERANCE {
            Ok(Self::claim(wxyz).normalized())
        } else {
            Err(RotationError::NotUnit { norm })
        }
    }

    /// Divided by its norm, whatever that is (not zero).
    pub fn normalized(self) -> Self {
        let k = 1.0 / norm(self.0);
        Rot::claim(self.0.map(|c| c * k))
    }
}

impl<A: Frame, M: Frame, C: Frame, S: Real> Mul<Rot<M, C, S>> for Rot<A, M, S> {
    type Output = Rot<A, C, S>;
    #[inline(always)]
    fn mul(self, o: Rot<M, C, S>) -> Rot<A, C, S> {
        let ([a, b, c, d], [w, x, y, z]) = (self.0, o.0);
        Rot::claim([
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ])
    }
}

impl<To: Frame, From: Frame, S: Real> Mul<Vec3<From, S>> for Rot<To, From, S> {
    type Output = Vec3<To, S>;
    #[inline(always)]
    fn mul(self, v: Vec3<From, S>) -> Vec3<To, S> {
        self.as_dcm() * v
    }
}

fn norm([w, x, y, z]: [f64; 4]) -> f64 {
    libm::sqrt(w * w + x * x + y * y + z * z)
}
