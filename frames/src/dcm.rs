//! Direction cosine matrices between frames.

use core::marker::PhantomData;
use core::ops::Mul;

use crate::error::TOLERANCE;
use crate::{Frame, Real, Rot, RotationError, Vec3};

/// Direction cosine matrix that takes a vector from `From` to `To`, stored by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dcm<To: Frame, From: Frame, S = f64>([[S; 3]; 3], PhantomData<(To, From)>);

impl<To: Frame, From: Frame, S> Dcm<To, From, S> {
    /// The door from untyped to typed: claims that `rows` is orthonormal with determinant one and
    /// takes vectors from `From` to `To`. Nothing is checked.
    #[inline(always)]
    pub const fn claim(rows: [[S; 3]; 3]) -> Self {
        Dcm(rows, PhantomData)
    }

    /// The rows of the matrix.
    #[inline(always)]
    pub fn as_rows(self) -> [[S; 3]; 3] {
        self.0
    }
}

impl<To: Frame, From: Frame> Dcm<To, From> {
    /// From rows that come from outside, checked: C Cᵀ within 1e-6 of the identity, determinant +1.
    /// The rows are kept as they are; pass through [`Rot::from_dcm`] to make them orthonormal to rounding.
    pub fn from_rows(rows: [[f64; 3]; 3]) -> Result<Self, RotationError> {
        let [x, y, z] = rows.map(Vec3::<From>::claim);
        let elements = [x.dot(x) - 1.0, y.dot(y) - 1.0, z.dot(z) - 1.0, x.dot(y), y.dot(z), z.dot(x)];
        // Written so that a NaN among the elements is an error too.
        if let Some(&excess) = elements.iter().find(|e| e.is_nan()) {
            return Err(RotationError::NotOrthonormal { excess });
        }
        let excess = elements.iter().fold(0.0, |m: f64, &e| if e.abs() > m.abs() { e } else { m });
        if excess.abs() > TOLERANCE {
            Err(RotationError::NotOrthonormal { excess })
        } else if x.cross(y).dot(z) < 0.0 {
            Err(RotationError::Reflection)
        } else {
            Ok(Self::claim(rows))
        }
    }

    /// As a matrix of `nalgebra`, without its frames.
    pub fn as_nalgebra(self) -> nalgebra::Matrix3<f64> {
        let [[a, b, c], [d, e, f], [g, h, i]] = self.0;
        nalgebra::Matrix3::new(a, b, c, d, e, f, g, h, i)
    }
}

impl<To: Frame, From: Frame> Rot<To, From> {
    /// From a direction cosine matrix, normalised, with a scalar part that is not negative.
    ///
    /// Shepperd's method: the largest of the four components is formed first, so that the divisor is at
    /// least 1/2 and no rotation is near a singularity.
    pub fn from_dcm(dcm: Dcm<To, From>) -> Self {
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = dcm.as_rows();
        let trace = xx + yy + zz;
        // Each branch is four times the largest component times the quaternion.
        let q = if trace >= xx && trace >= yy && trace >= zz {
            [1.0 + trace, zy - yz, xz - zx, yx - xy]
        } else if xx >= yy && xx >= zz {
            [zy - yz, 1.0 + xx - yy - zz, xy + yx, zx + xz]
        } else if yy >= zz {
            [xz - zx, xy + yx, 1.0 + yy - xx - zz, yz + zy]
        } else {
            [yx - xy, zx + xz, yz + zy, 1.0 + zz - xx - yy]
        };
        Self::claim(if q[0] < 0.0 { q.map(|c| -c) } else { q }).normalized()
    }
}

impl<To: Frame, From: Frame, S: Real> Dcm<To, From, S> {
    /// The transpose, which is the inverse rotation.
    #[inline(always)]
    pub fn transpose(self) -> Dcm<From, To, S> {
        let [[a, b, c], [d, e, f], [g, h, i]] = self.0;
        Dcm::claim([[a, d, g], [b, e, h], [c, f, i]])
    }
}

impl<To: Frame, From: Frame, S: Real> Mul<Vec3<From, S>> for Dcm<To, From, S> {
    type Output = Vec3<To, S>;
    #[inline(always)]
    fn mul(self, v: Vec3<From, S>) -> Vec3<To, S> {
        let [r0, r1, r2] = self.0;
        let [x, y, z] = v.as_array();
        Vec3::new(
            r0[0] * x + r0[1] * y + r0[2] * z,
            r1[0] * x + r1[1] * y + r1[2] * z,
            r2[0] * x + r2[1] * y + r2[2] * z,
        )
    }
}

impl<A: Frame, M: Frame, C: Frame, S: Real> Mul<Dcm<M, C, S>> for Dcm<A, M, S> {
    type Output = Dcm<A, C, S>;
    #[inline(always)]
    fn mul(self, o: Dcm<M, C, S>) -> Dcm<A, C, S> {
        let columns = o.transpose().0.map(|column| self * Vec3::<M, S>::claim(column));
        Dcm::<C, A, S>::claim(columns.map(|column| column.as_array())).transpose()
    }
}
