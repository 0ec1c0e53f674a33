//! The inner loops: sums of squared differences of phase at a fixed distance.
//!
//! Sixteen running sums hide the latency of the addition and are what the vector unit wants. Their number does
//! not depend on the width of the unit, so every processor adds in the same order and gives the same bits.

use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};

/// sum over k of (x[k+2m] - 2 x[k+m] + x[k])², k = 0 .. len-2m.
pub(crate) fn second_difference_squares(x: &[f64], m: usize) -> f64 {
    let count = x.len().saturating_sub(2 * m);
    if count == 0 {
        return 0.0;
    }
    dispatch!(Level::new(), simd => second(simd, &x[..count], &x[m..m + count], &x[2 * m..2 * m + count]))
}

/// sum over k of (x[k+3m] - 3 x[k+2m] + 3 x[k+m] - x[k])², k = 0 .. len-3m.
pub(crate) fn third_difference_squares(x: &[f64], m: usize) -> f64 {
    let count = x.len().saturating_sub(3 * m);
    let (a, b, c) = (x, &x[m.min(x.len())..], &x[(2 * m).min(x.len())..]);
    let d = &x[(3 * m).min(x.len())..];
    let mut sums = [0.0; 16];
    for k in 0..count {
        let t = (d[k] - a[k]) - 3.0 * (c[k] - b[k]);
        sums[k % 16] += t * t;
    }
    total(&sums)
}

#[inline(always)]
fn second<S: Simd>(simd: S, a: &[f64], b: &[f64], c: &[f64]) -> f64 {
    let mut s0 = f64x8::splat(simd, 0.0);
    let mut s1 = f64x8::splat(simd, 0.0);
    let (pa, ra) = a.as_chunks::<16>();
    let (pb, rb) = b.as_chunks::<16>();
    let (pc, rc) = c.as_chunks::<16>();
    for ((a, b), c) in pa.iter().zip(pb).zip(pc) {
        s0 = squares(simd, s0, &a[..8], &b[..8], &c[..8]);
        s1 = squares(simd, s1, &a[8..], &b[8..], &c[8..]);
    }
    let mut sums = [0.0; 16];
    s0.store_slice(&mut sums[..8]);
    s1.store_slice(&mut sums[8..]);
    for (k, ((a, b), c)) in ra.iter().zip(rb).zip(rc).enumerate() {
        let t = (c - b) - (b - a);
        sums[k] += t * t;
    }
    total(&sums)
}

#[inline(always)]
fn squares<S: Simd>(simd: S, sum: f64x8<S>, a: &[f64], b: &[f64], c: &[f64]) -> f64x8<S> {
    let (a, b, c) = (f64x8::from_slice(simd, a), f64x8::from_slice(simd, b), f64x8::from_slice(simd, c));
    let t = (c - b) - (b - a);
    sum + t * t
}

/// Pairwise, so that the order is one and the rounding small.
fn total(sums: &[f64; 16]) -> f64 {
    let mut s = *sums;
    for width in [8, 4, 2, 1] {
        for k in 0..width {
            s[k] += s[k + width];
        }
    }
    s[0]
}
