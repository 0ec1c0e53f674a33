//! One block of source states over a step by itself: closed against rounding by series and doubling.

use nalgebra::SMatrix;

use super::block::Block;

/// A block and the first three integrals of its coefficient: z3' = z2, z2' = z1, z1' = c x, x' = a x + w.
const D: usize = 5;

/// How a block passes a step of one length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SmallStep {
    /// Transition of the states.
    pub phi: [[f64; 2]; 2],
    /// Mean of the transition over the step.
    pub average: [[f64; 2]; 2],
    /// (z3, z2, z1) of a unit of the first state.
    pub integrals: [f64; 3],
    /// Covariance of (z3, z2, z1, x) that the driving noise makes over the step.
    pub q: SMatrix<f64, D, D>,
}

impl SmallStep {
    /// Over `dt` (s).
    pub fn new(block: &Block, dt: f64) -> Self {
        let mut a = SMatrix::<f64, D, D>::zeros();
        let mut density = SMatrix::<f64, D, D>::zeros();
        (a[(0, 1)], a[(1, 2)]) = (1.0, 1.0);
        for k in 0..block.len {
            a[(2, 3 + k)] = block.c[k];
            for l in 0..block.len {
                a[(3 + k, 3 + l)] = block.a[k][l];
                density[(3 + k, 3 + l)] = block.q[k][l];
            }
        }
        let rate = libm::sqrt(block.a.iter().flatten().map(|x| x * x).sum());
        // The chain of integrals ends by itself; only the rates of the block make the series long.
        let (phi, q) = super::exact::discretize(&a, &density, rate, dt);
        let at = |k: usize, l: usize| phi[(3 + k, 3 + l)];
        SmallStep {
            phi: [[at(0, 0), at(0, 1)], [at(1, 0), at(1, 1)]],
            average: average(block, rate, dt),
            integrals: [phi[(0, 3)], phi[(1, 3)], phi[(2, 3)]],
            q,
        }
    }
}

/// Mean of e^(a t) over 0..dt: the upper right of the exponential of [a I; 0 0].
fn average(block: &Block, rate: f64, dt: f64) -> [[f64; 2]; 2] {
    let mut a = SMatrix::<f64, 4, 4>::zeros();
    for k in 0..block.len {
        a[(k, 2 + k)] = 1.0;
        for l in 0..block.len {
            a[(k, l)] = block.a[k][l];
        }
    }
    let (phi, _) = super::exact::discretize(&a, &SMatrix::zeros(), rate, dt);
    core::array::from_fn(|k| core::array::from_fn(|l| phi[(k, 2 + l)] / dt))
}
