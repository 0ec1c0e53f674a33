//! Direction cosine matrices between frames.

use core::marker::PhantomData;
use core::ops::Mul;

use crate::{Frame, Real, Vec3};

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
