//! What measurements can tell of the states, and what they never will.

use nalgebra::SMatrix;

use super::smoother::solve;
use super::{Model, Now, Observation, Row};
use crate::System;
use schuler_imu::Truth;

/// The space of states that measurements observe, gathered over one motion or several.
///
/// It is the smallest space that holds the rows h and with every row r its image r F: that of h, h F, h F², …, built row by
/// row, each made orthogonal to those before in units of the given standard deviations and scaled to one, so that a small rate
/// counts as much as a large one. The rank is their number. For several
/// motions one after the other (a turn between two positions) the rows of each are put together, which is right where what one
/// does not observe stands still in it, as it does at rest (Goshen-Meskin and Bar-Itzhack, Observability analysis of
/// piece-wise constant systems, IEEE Trans. Aerospace and Electronic Systems 28, 1992).
#[derive(Clone, Debug, PartialEq)]
pub struct Observability<const N: usize> {
    n: usize,
    sigma: [f64; N],
    /// Orthonormal rows, in units of `sigma`: the observed space first, the rest of the space behind it.
    rows: [[f64; N]; N],
    rank: usize,
}

/// A row whose part outside of the space is smaller than this is inside, by rounding.
const TOLERANCE: f64 = 1e-9;

impl<const N: usize> Observability<N> {
    /// Nothing observed yet, of `n` states with the standard deviations `sigma`; a state without any does not count as one.
    pub fn new(n: usize, sigma: [f64; N]) -> Self {
        Observability { n: n.min(N), sigma, rows: [[0.0; N]; N], rank: 0 }
    }

    /// Number of independent combinations that are observed.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Number of states that vary at all, of which [`Observability::rank`] combinations are observed.
    pub fn states(&self) -> usize {
        self.sigma[..self.n].iter().filter(|s| **s > 0.0).count()
    }

    /// Adds what `rows` tell under the constant dynamics `f` of all states.
    pub fn add(&mut self, f: &SMatrix<f64, N, N>, rows: &[Row<N>]) {
        for row in rows {
            let mut v = [0.0; N];
            for (k, h) in row.pairs().filter(|(k, _)| *k < self.n) {
                v[k] = h * self.sigma[k];
            }
            self.extend(v);
        }
        // The image of every row in the space, until none leads out of it. Those found under other dynamics too: what was
        // observed before stays observed.
        let mut k = 0;
        while k < self.rank {
            let row = self.rows[k];
            let mut image = [0.0; N];
            for i in (0..self.n).filter(|&i| row[i] != 0.0) {
                for j in 0..self.n {
                    image[j] += row[i] / self.sigma[i] * f[(i, j)] * self.sigma[j];
                }
            }
            self.extend(image);
            k += 1;
        }
    }

    /// Adds what an observation tells of a `model` under a constant `system` of its form, the sensors having `seen` the
    /// same all the time.
    pub fn add_observation(
        &mut self,
        model: &Model<N>,
        system: &System,
        seen: &Truth,
        observation: &Observation,
        now: &Now,
    ) {
        let rows = observation.rows(model, now);
        self.add(&model.dynamics(system, seen), &rows[..observation.len]);
    }

    /// Takes in the part of `v` outside of the space, if there is one.
    fn extend(&mut self, mut v: [f64; N]) -> bool {
        if self.rank >= self.n || !normalize(&mut v) {
            return false;
        }
        // Twice is enough (Parlett, The Symmetric Eigenvalue Problem).
        for _ in 0..2 {
            for row in &self.rows[..self.rank] {
                let along = super::propagation::dot(&v, row);
                v.iter_mut().zip(row).for_each(|(v, r)| *v -= along * r);
            }
        }
        let left = libm::sqrt(super::propagation::dot(&v, &v));
        if left < TOLERANCE {
            return false;
        }
        self.rows[self.rank] = v.map(|v| v / left);
        self.rank += 1;
        true
    }

    /// A basis of the combinations that are never observed, one a column, in the states' own units and scaled so that the
    /// largest part in units of its standard deviation is one; and how many there are.
    pub fn null_space(&self) -> (SMatrix<f64, N, N>, usize) {
        let mut whole = self.clone();
        // The unit vectors of what is observed least first, so that the basis is well conditioned.
        for _ in 0..self.n {
            let outside = |k: usize| 1.0 - whole.rows[..whole.rank].iter().map(|r| r[k] * r[k]).sum::<f64>();
            let free = (0..self.n).filter(|&k| self.sigma[k] > 0.0);
            let Some(most) = free.max_by(|&a, &b| outside(a).total_cmp(&outside(b))) else { break };
            let mut unit = [0.0; N];
            unit[most] = 1.0;
            if outside(most) < TOLERANCE || !whole.extend(unit) {
                break;
            }
        }
        let mut null = SMatrix::zeros();
        for (column, row) in whole.rows[self.rank..whole.rank].iter().enumerate() {
            let largest = row.iter().fold(0.0f64, |a, x| a.max(x.abs()));
            for k in 0..self.n {
                null[(k, column)] = row[k] / largest * self.sigma[k];
            }
        }
        (null, whole.rank - self.rank)
    }
}

/// To length one; false where there is none.
fn normalize<const N: usize>(v: &mut [f64; N]) -> bool {
    // Scaled first: squares of small rates to high powers would vanish.
    let largest = v.iter().fold(0.0f64, |a, x| a.max(x.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return false;
    }
    v.iter_mut().for_each(|x| *x /= largest);
    let length = libm::sqrt(super::propagation::dot(v, v));
    v.iter_mut().for_each(|x| *x /= length);
    true
}

/// What is left of the covariance `p0` after endless noise-free measurement at rest: with N a basis of the `nullity`
/// combinations that are never observed (columns of `null`),
///
/// ```text
/// P = N (N' P0⁻¹ N)⁻¹ N'
/// ```
pub fn limit_covariance<const N: usize>(
    null: &SMatrix<f64, N, N>,
    nullity: usize,
    p0: &SMatrix<f64, N, N>,
    n: usize,
) -> SMatrix<f64, N, N> {
    let information = null.transpose() * solve(p0, null, n);
    let basis = null.transpose();
    null * solve(&information, &basis, nullity.min(N))
}
