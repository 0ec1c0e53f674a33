//! The three axes of an instrument side by side in lanes; the fourth is zero.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};

pub(super) type Axes = [f64; 4];

/// Of three axes.
pub(super) fn axes([x, y, z]: [f64; 3]) -> Axes {
    [x, y, z, 0.0]
}

#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, v: &Axes) -> f64x4<S> {
    f64x4::from_slice(simd, v)
}

#[inline(always)]
pub(super) fn store<S: Simd>(v: f64x4<S>, to: &mut Axes) {
    v.store_slice(to);
}

/// The nearest integers, and the even one of two, without a branch: numbers from 2^52 on are integers, and
/// adding that number leaves no room for a fraction.
#[inline(always)]
pub(super) fn round<S: Simd>(x: f64x4<S>) -> f64x4<S> {
    const INTEGERS: f64 = 4_503_599_627_370_496.0;
    let size = x.abs();
    size.simd_lt(INTEGERS).select(((size + INTEGERS) - INTEGERS).copysign(x), x)
}
