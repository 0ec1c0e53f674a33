//! Vectors resolved in a frame.

use core::marker::PhantomData;
use core::ops::{Add, AddAssign, Index, Mul, Neg, Sub, SubAssign};

use crate::{Frame, Real};

/// A vector of three components resolved in frame `F`. The unit is the caller's (SI by convention).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3<F: Frame, S = f64>([S; 3], PhantomData<F>);

impl<F: Frame, S> Vec3<F, S> {
    /// Components along the axes of `F`.
    #[inline(always)]
    pub const fn new(x: S, y: S, z: S) -> Self {
        Vec3([x, y, z], PhantomData)
    }

    /// The door from untyped to typed: claims that `xyz` is resolved in `F`.
    #[inline(always)]
    pub const fn claim(xyz: [S; 3]) -> Self {
        Vec3(xyz, PhantomData)
    }

    /// The components, without their frame.
    #[inline(always)]
    pub fn as_array(self) -> [S; 3] {
        self.0
    }
}

impl<F: Frame, S: Real> Vec3<F, S> {
    /// Scalar product; its unit is the product of the units.
    #[inline(always)]
    pub fn dot(self, other: Self) -> S {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    /// Vector product `self × other`.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self::new(b * z - c * y, c * x - a * z, a * y - b * x)
    }

    /// The vector times a constant.
    #[inline(always)]
    pub fn scaled(self, k: f64) -> Self {
        let [a, b, c] = self.0;
        Self::new(a * k, b * k, c * k)
    }

    /// Square of the Euclidean norm.
    #[inline(always)]
    pub fn norm_squared(self) -> S {
        self.dot(self)
    }
}

impl<F: Frame> Vec3<F> {
    /// The zero vector.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);

    /// Euclidean norm.
    pub fn norm(self) -> f64 {
        libm::sqrt(self.norm_squared())
    }

    /// The matrix `[self ×]`: `self.skew() * v` is the vector product of `self` and `v`.
    pub fn skew(self) -> nalgebra::Matrix3<f64> {
        let [x, y, z] = self.0;
        nalgebra::Matrix3::new(0.0, -z, y, z, 0.0, -x, -y, x, 0.0)
    }

    /// As a column of `nalgebra`, without its frame. The way back is [`Vec3::claim`].
    pub fn as_nalgebra(self) -> nalgebra::Vector3<f64> {
        self.0.into()
    }
}

impl<F: Frame, S: Real> Add for Vec3<F, S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, o.0);
        Self::new(a + x, b + y, c + z)
    }
}

impl<F: Frame, S: Real> Sub for Vec3<F, S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, o.0);
        Self::new(a - x, b - y, c - z)
    }
}

impl<F: Frame, S: Real> Neg for Vec3<F, S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let [a, b, c] = self.0;
        Self::new(-a, -b, -c)
    }
}

impl<F: Frame, S: Real> Mul<S> for Vec3<F, S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: S) -> Self {
        let [a, b, c] = self.0;
        Self::new(a * k, b * k, c * k)
    }
}

impl<F: Frame, S: Real> AddAssign for Vec3<F, S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<F: Frame, S: Real> SubAssign for Vec3<F, S> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<F: Frame, S> Index<usize> for Vec3<F, S> {
    type Output = S;
    #[inline(always)]
    fn index(&self, axis: usize) -> &S {
        &self.0[axis]
    }
}
