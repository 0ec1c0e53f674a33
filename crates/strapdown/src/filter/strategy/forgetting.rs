//! Forgetting that keeps the information in the filter bounded.

use nalgebra::SMatrix;

use super::Strategy;
use crate::filter::Outcome;

/// Variable forgetting: after an update, `P := P / lambda` with
///
/// ```text
/// lambda = 1 - (1 - h K) e² / Sigma0 = 1 - (nu' S⁻¹ nu) / N0,   not below `least`
/// ```
///
/// (with errors in units of the noise, 1 - h K = R/S and Sigma0 = sigma² N0). Innovations that bring information are answered
/// by as much forgetting, so that the information in the filter stays as of N0 measurements; where nothing happens, nothing
/// is forgotten.
///
/// Source: Fortescue, Kershenbaum and Ydstie, Implementation of self-tuning regulators with variable forgetting factors,
/// Automatica 17 (1981).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VariableForgetting {
    /// Number of scalar measurements N0 that the filter remembers.
    pub memory: f64,
    /// Smallest factor, between zero and one.
    pub least: f64,
}

impl VariableForgetting {
    /// A memory of `memory` scalar measurements, and no factor below one half.
    pub const fn new(memory: f64) -> Self {
        VariableForgetting { memory, least: 0.5 }
    }
}

impl<const N: usize> Strategy<N> for VariableForgetting {
    fn after(&mut self, p: &mut SMatrix<f64, N, N>, outcome: &Outcome) {
        // Written so that a memory or a bound without sense forgets nothing.
        let lambda = (1.0 - outcome.nis / self.memory).max(self.least);
        if lambda > 0.0 && lambda < 1.0 {
            super::inflate(p, 1.0 / lambda, N);
        }
    }
}
