//! The strong tracking filter.

use nalgebra::SMatrix;

use super::{Moment, Square3, Strategy, inflate, scale_by};

/// Factors that keep successive innovations uncorrelated, sub-optimally:
///
/// ```text
/// V_1 = nu nu',   V_k = (rho V_{k-1} + nu nu') / (1 + rho)
/// N = V - H Q H' - beta R,   M = Phi P Phi' H' H
/// one factor:      lambda = max(1, tr N / tr M),            P⁻ = lambda Phi P Phi' + Q
/// one per state:   lambda_i = max(1, alpha_i c),  c = tr N / Σ alpha_i M_ii,
///                  P⁻ = L^½ Phi P Phi' L^½ + Q
/// ```
///
/// Source: Zhou and Frank, Strong tracking filtering of nonlinear time-varying stochastic systems with coloured noise:
/// application to parameter estimation and empirical robustness analysis, Int. J. Control 65 (1996). The symmetric form of
/// several factors is used, without which P would not stay symmetric.
#[derive(Clone, Debug, PartialEq)]
pub struct StrongTracking<const N: usize> {
    /// Forgetting factor of the innovations' covariance, usually 0.95.
    pub rho: f64,
    /// Softening factor, one or more: the larger, the calmer.
    pub beta: f64,
    /// Weights of the states' own factors; `None` for one factor.
    pub alpha: Option<[f64; N]>,
    v: Option<Square3>,
}

impl<const N: usize> StrongTracking<N> {
    /// With one factor, rho = 0.95, and the softening factor `beta`.
    pub fn new(beta: f64) -> Self {
        StrongTracking { rho: 0.95, beta, alpha: None, v: None }
    }

    /// With a factor per state, in proportion to `alpha` (zero or more).
    pub fn with_weights(beta: f64, alpha: [f64; N]) -> Self {
        StrongTracking { alpha: Some(alpha), ..StrongTracking::new(beta) }
    }
}

impl<const N: usize> Strategy<N> for StrongTracking<N> {
    fn before(&mut self, p: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        let nu = moment.innovation;
        let v = match &self.v {
            None => core::array::from_fn(|i| core::array::from_fn(|j| nu[i] * nu[j])),
            Some(old) => core::array::from_fn(|i| {
                core::array::from_fn(|j| (self.rho * old[i][j] + nu[i] * nu[j]) / (1.0 + self.rho))
            }),
        };
        self.v = Some(v);
        let len = moment.len();
        let excess: f64 = (0..len).map(|i| v[i][i] - moment.driven[i][i] - self.beta * moment.r[i][i]).sum();
        match &self.alpha {
            None => {
                let carried: f64 = (0..len).map(|i| moment.carried[i][i]).sum();
                if carried > 0.0 {
                    inflate(p, (excess / carried).max(1.0), moment.n);
                }
            }
            Some(alpha) => {
                // M_ii = Σ_rows (Phi P Phi' h')_i h_i
                let mut weighted = 0.0;
                for row in moment.rows {
                    for (i, h) in row.pairs() {
                        weighted += alpha[i] * h * row.dot(&p.data.0[i]);
                    }
                }
                if weighted > 0.0 {
                    let c = excess / weighted;
                    scale_by(p, &alpha.map(|a| libm::sqrt((a * c).max(1.0))), moment.n);
                }
            }
        }
        moment.r
    }
}
