//! Three by three in the machine's lanes.
//!
//! Everything is written out: what a closure does inside `map` or `from_fn` is not compiled for wide lanes.

use core::ops::{Add, Mul};

use fearless_simd::{Simd, SimdBase, f64x4};
use nalgebra::Vector3;

/// The columns of a matrix of three rows, each filled up with a zero.
pub(crate) type Columns3 = [[f64; 4]; 3];

/// A matrix of three rows and columns, a column in four lanes of which the last carries zero.
#[derive(Clone, Copy)]
pub(crate) struct Padded<S: Simd>([f64x4<S>; 3]);

impl<S: Simd> Padded<S> {
    #[inline(always)]
    pub fn new(simd: S, columns: &Columns3) -> Self {
        let [a, b, c] = columns;
        Padded([f64x4::from_slice(simd, a), f64x4::from_slice(simd, b), f64x4::from_slice(simd, c)])
    }

    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        Padded([f64x4::splat(simd, 0.0); 3])
    }

    #[inline(always)]
    pub fn diagonal(simd: S, [x, y, z]: [f64; 3]) -> Self {
        let one = Self::new(simd, &[[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
        one.scaled([x, y, z])
    }

    /// [v ×].
    #[inline(always)]
    pub fn cross(simd: S, v: Vector3<f64>) -> Self {
        let (x, y, z) = (v[0], v[1], v[2]);
        Self::new(simd, &[[0.0, z, -y, 0.0], [-z, 0.0, x, 0.0], [y, -x, 0.0, 0.0]])
    }

    /// Its columns.
    #[inline(always)]
    pub fn columns(&self) -> &[f64x4<S>; 3] {
        &self.0
    }

    #[inline(always)]
    pub fn transposed(&self) -> Self {
        let [a, b, c] = self.0;
        let zero = a * 0.0;
        let (ac, b_) = (a.zip_low(c), b.zip_low(zero));
        Padded([ac.zip_low(b_), ac.zip_high(b_), a.zip_high(c).zip_low(b.zip_high(zero))])
    }

    /// The last column times `down`.
    #[inline(always)]
    pub fn held(self, down: f64) -> Self {
        let [a, b, c] = self.0;
        Padded([a, b, c * down])
    }

    /// This matrix times [v ×].
    #[inline(always)]
    pub fn times_cross(&self, v: Vector3<f64>) -> Self {
        let (x, y, z) = (v[0], v[1], v[2]);
        let [a, b, c] = self.0;
        Padded([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// This matrix times one that lies in memory, where its elements are at hand one by one.
    #[inline(always)]
    pub fn times_stored(&self, m: &Columns3) -> Self {
        let [a, b, c] = self.0;
        Padded([
            a * m[0][0] + b * m[0][1] + c * m[0][2],
            a * m[1][0] + b * m[1][1] + c * m[1][2],
            a * m[2][0] + b * m[2][1] + c * m[2][2],
        ])
    }

    /// Rows times `factors`.
    #[inline(always)]
    pub fn rows(self, factors: f64x4<S>) -> Self {
        Padded([self.0[0] * factors, self.0[1] * factors, self.0[2] * factors])
    }

    /// Columns times `factors`.
    #[inline(always)]
    pub fn scaled(self, factors: [f64; 3]) -> Self {
        Padded([self.0[0] * factors[0], self.0[1] * factors[1], self.0[2] * factors[2]])
    }

    #[inline(always)]
    fn times(&self, v: f64x4<S>) -> f64x4<S> {
        self.0[0] * v[0] + self.0[1] * v[1] + self.0[2] * v[2]
    }

    /// Adds v v'.
    #[inline(always)]
    pub fn add_square(&mut self, v: f64x4<S>) {
        for j in 0..3 {
            self.0[j] += v * v[j];
        }
    }
}

impl<S: Simd> Add for Padded<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Padded([self.0[0] + other.0[0], self.0[1] + other.0[1], self.0[2] + other.0[2]])
    }
}

impl<S: Simd> Mul<f64> for Padded<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Padded([self.0[0] * factor, self.0[1] * factor, self.0[2] * factor])
    }
}

impl<S: Simd> Mul for Padded<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Padded([self.times(other.0[0]), self.times(other.0[1]), self.times(other.0[2])])
    }
}
