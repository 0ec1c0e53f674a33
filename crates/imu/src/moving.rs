//! Parts of coefficients that have states, and their way through eight steps in lanes.
//!
//! No two parts and no two steps meet in an operation, so the width of the lanes does not change a bit.

use core::ops::Range;

use fearless_simd::Simd;
use fearless_simd::prelude::*;

use crate::bank::{MAX_FIRST, MAX_SECOND};
use crate::process::Step;
use crate::random::{Drawn, STEPS};

/// First-order parts, of each number those of all parts; what is not in use is zero.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct First {
    phi: [f64; MAX_FIRST],
    /// Mean and noise of its step, and the factor on the coefficient.
    step: [(f64, [f64; 3], f64); MAX_FIRST],
    /// With that factor.
    mean: [f64; MAX_FIRST],
    s: [f64; MAX_FIRST],
    k: [f64; MAX_FIRST],
    /// The state before each step.
    before: [[f64; STEPS]; MAX_FIRST],
    pub count: usize,
}

/// Second-order parts.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Second {
    gain: [f64; MAX_SECOND],
    /// With the factor `gain` on the coefficient.
    mean: [[f64; 2]; MAX_SECOND],
    s: [f64; MAX_SECOND],
    k: [[f64; MAX_SECOND]; 2],
    phi: [[[f64; MAX_SECOND]; 2]; 2],
    before: [[[f64; STEPS]; MAX_SECOND]; 2],
    step: [Step; MAX_SECOND],
    pub count: usize,
}

impl First {
    pub const NONE: First = First {
        count: 0,
        phi: [0.0; MAX_FIRST],
        mean: [0.0; MAX_FIRST],
        step: [(0.0, [0.0; 3], 0.0); MAX_FIRST],
        s: [0.0; MAX_FIRST],
        k: [0.0; MAX_FIRST],
        before: [[0.0; STEPS]; MAX_FIRST],
    };

    /// Part `i` follows `step` and counts `gain` times.
    pub fn set(&mut self, i: usize, step: &Step, gain: f64) {
        let ([n11, ..], [n31, _, n33]) = (step.noise[0], step.noise[2]);
        self.step[i] = (step.mean[0], [n11, n31, n33], gain);
        (self.phi[i], self.mean[i]) = (step.phi[0][0], gain * step.mean[0]);
    }

    /// Innovations of the next step from the covariances before it, which move on where `moves` says so.
    pub fn innovate(&mut self, covariances: &mut [f64; MAX_FIRST], moves: bool) {
        for (i, p) in covariances[..self.count].iter_mut().enumerate() {
            let (mean, noise, gain) = self.step[i];
            let now = Step::first_order(self.phi[i], mean, noise).innovation(&[*p, 0.0, 0.0]);
            (self.s[i], self.k[i]) = (gain * now.s, now.k[0]);
            if moves {
                *p = now.covariance[0];
            }
        }
    }

    /// State of part `i` before the step in `row`.
    pub fn before(&self, i: usize, row: usize) -> f64 {
        self.before[i][row]
    }

    /// Interval mean of part `i` in `row`, with the normal `w`.
    pub fn mean(&self, i: usize, row: usize, w: f64) -> f64 {
        self.mean[i] * self.before[i][row] + self.s[i] * w
    }

    /// Takes the states `x` through `rows`, with eight number `octet` of the normals.
    #[inline(always)]
    pub fn forward<S: Simd>(
        &mut self,
        simd: S,
        normals: &[Drawn],
        octet: usize,
        x: &mut [f64; MAX_FIRST],
        rows: Range<usize>,
    ) {
        if rows.len() < STEPS {
            for i in 0..self.count {
                for t in rows.clone() {
                    self.before[i][t] = x[i];
                    x[i] = self.phi[i] * x[i] + self.k[i] * normals[i][octet][t];
                }
            }
            return;
        }
        let n = S::f64s::LEN;
        for at in (0..self.count).step_by(n) {
            let (phi, k, mut now) = (load(simd, &self.phi, at), load(simd, &self.k, at), load(simd, x, at));
            for from in (0..STEPS).step_by(n) {
                let w = columns(simd, &normals[at..at + n], octet, from);
                let mut before = w;
                for t in 0..n {
                    before[t] = now;
                    now = now * phi + w[t] * k;
                }
                store_columns(simd, before, &mut self.before[at..at + n], from);
            }
            now.store_slice(&mut x[at..at + n]);
        }
    }

    /// Adds the interval means of `parts` in all rows to `c`, with eight number `octet` of the normals of all parts.
    #[inline(always)]
    pub fn add<S: Simd>(
        &self,
        simd: S,
        parts: Range<usize>,
        normals: &[Drawn],
        octet: usize,
        c: &mut [f64; STEPS],
    ) {
        let n = S::f64s::LEN;
        for at in (0..STEPS).step_by(n) {
            let mut sum = load(simd, c, at);
            for i in parts.clone() {
                let (x, w) = (load(simd, &self.before[i], at), load(simd, &normals[i][octet], at));
                sum += x * self.mean[i] + w * self.s[i];
            }
            sum.store_slice(&mut c[at..at + n]);
        }
    }
}

impl Second {
    pub const NONE: Second = Second {
        count: 0,
        step: [Step::NONE; MAX_SECOND],
        gain: [0.0; MAX_SECOND],
        mean: [[0.0; 2]; MAX_SECOND],
        s: [0.0; MAX_SECOND],
        k: [[0.0; MAX_SECOND]; 2],
        phi: [[[0.0; MAX_SECOND]; 2]; 2],
        before: [[[0.0; STEPS]; MAX_SECOND]; 2],
    };

    /// As [`First::set`].
    pub fn set(&mut self, i: usize, step: &Step, gain: f64) {
        (self.step[i], self.gain[i]) = (*step, gain);
        self.mean[i] = [gain * step.mean[0], gain * step.mean[1]];
        for r in 0..2 {
            (0..2).for_each(|c| self.phi[r][c][i] = step.phi[r][c]);
        }
    }

    /// As [`First::innovate`], for the first `noisy` parts; the others have no noise.
    pub fn innovate(&mut self, noisy: usize, covariances: &mut [[f64; 3]; MAX_SECOND], moves: bool) {
        for (i, p) in covariances[..noisy].iter_mut().enumerate() {
            let now = self.step[i].innovation(p);
            (self.s[i], self.k[0][i], self.k[1][i]) = (self.gain[i] * now.s, now.k[0], now.k[1]);
            if moves {
                *p = now.covariance;
            }
        }
    }

    /// As [`First::before`].
    pub fn before(&self, i: usize, row: usize) -> [f64; 2] {
        [self.before[0][i][row], self.before[1][i][row]]
    }

    /// As [`First::mean`].
    pub fn mean(&self, i: usize, row: usize, w: f64) -> f64 {
        let ([x1, x2], [mean1, mean2]) = (self.before(i, row), self.mean[i]);
        mean1 * x1 + mean2 * x2 + self.s[i] * w
    }

    /// As [`First::forward`]. What stands in `normals` for parts without noise does not matter.
    #[inline(always)]
    pub fn forward<S: Simd>(
        &mut self,
        simd: S,
        normals: &[Drawn],
        octet: usize,
        x: &mut [[f64; MAX_SECOND]; 2],
        rows: Range<usize>,
    ) {
        let [[p11, p12], [p21, p22]] = &self.phi;
        let [k1, k2] = &self.k;
        let ([before1, before2], [x1, x2]) = (&mut self.before, x);
        if rows.len() < STEPS {
            for i in 0..self.count {
                for t in rows.clone() {
                    let w = normals[i][octet][t];
                    (before1[i][t], before2[i][t]) = (x1[i], x2[i]);
                    x1[i] = p11[i] * before1[i][t] + p12[i] * before2[i][t] + k1[i] * w;
                    x2[i] = p21[i] * before1[i][t] + p22[i] * before2[i][t] + k2[i] * w;
                }
            }
            return;
        }
        let n = S::f64s::LEN;
        for at in (0..self.count).step_by(n) {
            let (p11, p12) = (load(simd, p11, at), load(simd, p12, at));
            let (p21, p22) = (load(simd, p21, at), load(simd, p22, at));
            let (k1, k2) = (load(simd, k1, at), load(simd, k2, at));
            let (mut now1, mut now2) = (load(simd, x1, at), load(simd, x2, at));
            for from in (0..STEPS).step_by(n) {
                let w = columns(simd, &normals[at..at + n], octet, from);
                let (mut first, mut second) = (w, w);
                for t in 0..n {
                    (first[t], second[t]) = (now1, now2);
                    now1 = first[t] * p11 + second[t] * p12 + w[t] * k1;
                    now2 = first[t] * p21 + second[t] * p22 + w[t] * k2;
                }
                store_columns(simd, first, &mut before1[at..at + n], from);
                store_columns(simd, second, &mut before2[at..at + n], from);
            }
            now1.store_slice(&mut x1[at..at + n]);
            now2.store_slice(&mut x2[at..at + n]);
        }
    }

    /// As [`First::add`].
    #[inline(always)]
    pub fn add<S: Simd>(&self, simd: S, i: usize, w: &[f64; STEPS], c: &mut [f64; STEPS]) {
        let [mean1, mean2] = self.mean[i];
        let [before1, before2] = &self.before;
        add(simd, c, [(mean1, &before1[i]), (mean2, &before2[i]), (self.s[i], w)]);
    }
}

/// Numbers from `at` on, as many as there are lanes.
#[inline(always)]
fn load<S: Simd>(simd: S, all: &[f64], at: usize) -> S::f64s {
    S::f64s::from_slice(simd, &all[at..at + S::f64s::LEN])
}

/// Adds the sum of products to `c`.
#[inline(always)]
pub(crate) fn add<S: Simd, const N: usize>(
    simd: S,
    c: &mut [f64; STEPS],
    products: [(f64, &[f64; STEPS]); N],
) {
    let n = S::f64s::LEN;
    for at in (0..STEPS).step_by(n) {
        let mut sum = load(simd, products[0].1, at) * products[0].0;
        for (factor, x) in &products[1..] {
            sum += load(simd, *x, at) * *factor;
        }
        (load(simd, c, at) + sum).store_slice(&mut c[at..at + n]);
    }
}

/// Of eight number `octet` of `rows` as many columns as there are lanes, from column `from` on; the rest is of no interest.
#[inline(always)]
fn columns<S: Simd>(simd: S, rows: &[Drawn], octet: usize, from: usize) -> [S::f64s; STEPS] {
    let n = S::f64s::LEN;
    let mut v = [S::f64s::splat(simd, 0.0); STEPS];
    for i in 0..n {
        v[i] = load(simd, &rows[i][octet], from);
    }
    transpose::<S>(v)
}

/// The way back from [`columns`].
#[inline(always)]
fn store_columns<S: Simd>(_: S, v: [S::f64s; STEPS], rows: &mut [[f64; STEPS]], from: usize) {
    let v = transpose::<S>(v);
    for (row, v) in rows.iter_mut().zip(v) {
        v.store_slice(&mut row[from..from + S::f64s::LEN]);
    }
}

/// Exchanges lanes and places of the first vectors, as many as there are lanes: at each stage their first
/// half is shuffled into the second.
#[inline(always)]
fn transpose<S: Simd>(mut v: [S::f64s; STEPS]) -> [S::f64s; STEPS] {
    let n = S::f64s::LEN;
    for _ in 0..n.ilog2() {
        let old = v;
        for i in 0..n / 2 {
            v[2 * i] = old[i].zip_low(old[i + n / 2]);
            v[2 * i + 1] = old[i].zip_high(old[i + n / 2]);
        }
    }
    v
}
