//! Linear simulation of the ten-state model: truth, measurements, and a filter beside it.

use nalgebra::{SMatrix, SVector};
use rand::{RngExt, SeedableRng, rngs::StdRng};
use rand_distr::StandardNormal;
use schuler_strapdown::filter::Propagation;

pub struct Noise(StdRng);

impl Noise {
    pub fn new(seed: u64) -> Self {
        Noise(StdRng::seed_from_u64(seed))
    }

    pub fn normal(&mut self) -> f64 {
        self.0.sample(StandardNormal)
    }

    /// A draw of covariance `l l'`.
    pub fn draw<const N: usize>(&mut self, l: &SMatrix<f64, N, N>) -> SVector<f64, N> {
        l * SVector::<f64, N>::from_fn(|_, _| self.normal())
    }
}

/// Lower triangular root of a positive semidefinite matrix.
pub fn root<const N: usize>(p: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let mut l = SMatrix::<f64, N, N>::zeros();
    for j in 0..N {
        let d = p[(j, j)] - (0..j).map(|k| l[(j, k)] * l[(j, k)]).sum::<f64>();
        if d <= 1e-14 * p[(j, j)] {
            continue;
        }
        l[(j, j)] = d.sqrt();
        for i in j + 1..N {
            let sum: f64 = (0..j).map(|k| l[(i, k)] * l[(j, k)]).sum();
            l[(i, j)] = (p[(i, j)] - sum) / l[(j, j)];
        }
    }
    l
}

/// A linear system that is driven by its own process noise.
pub struct Truth<const N: usize> {
    phi: SMatrix<f64, N, N>,
    drive: SMatrix<f64, N, N>,
    pub x: SVector<f64, N>,
}

impl<const N: usize> Truth<N> {
    /// Starts at a draw of covariance `p0`.
    pub fn new(step: &Propagation<N>, p0: &SMatrix<f64, N, N>, noise: &mut Noise) -> Self {
        Truth { phi: step.phi(), drive: root(&step.q()), x: noise.draw(&root(p0)) }
    }

    pub fn step(&mut self, noise: &mut Noise) {
        self.x = self.phi * self.x + noise.draw(&self.drive);
    }
}
