//! What an error of a sensor is worth as a mean over a time.

use nalgebra::{DMatrix, DVector};
use schuler_imu::process::LinearModel;

use crate::drift::van_loan;

/// Mean and variance of `(1/t) ∫ c` over `t` (s) from the start, of a coefficient c without its white noise.
///
/// Exact: the integral is one more state, `J' = C x`, and all of it is discretised over the whole time.
pub fn of_process(model: &LinearModel, t: f64) -> [f64; 2] {
    let n = model.n;
    let entry = |m: &[[f64; schuler_imu::process::MAX_STATES]; schuler_imu::process::MAX_STATES]| {
        DMatrix::from_fn(n + 1, n + 1, |i, j| if i < n && j < n { m[i][j] } else { 0.0 })
    };
    let (mut a, q, p0) = (entry(&model.a), entry(&model.q), entry(&model.p0));
    let x0 = DVector::from_fn(n + 1, |i, _| if i < n { model.x0[i] } else { 0.0 });
    for i in 0..n {
        a[(n, i)] = model.c[i];
    }
    let (phi, noise) = van_loan(&a, &q, t);
    let p = &phi * p0 * phi.transpose() + noise;
    [(phi * x0)[n] / t, p[(n, n)].max(0.0) / (t * t)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: a constant is its own mean, of a ramp b t the half of its end, of a random walk from zero q t/3, of a stationary
    /// Gauss-Markov process 2 sigma² tau/t² (t - tau (1 - e^(-t/tau))).
    #[test]
    fn means_of_processes() {
        let (t, tau, sigma) = (600.0, 200.0, 3e-8);
        let cases = [
            (LinearModel::scalar(0.0, 0.0, 5.0, 4.0), [5.0, 4.0]),
            (LinearModel::planar([[0.0, 1.0], [0.0, 0.0]], [0.0, 2e-3]), [0.6, 0.0]),
            (LinearModel::scalar(0.0, 1e-6, 0.0, 0.0), [0.0, 2e-4]),
            (
                LinearModel::scalar(-1.0 / tau, 2.0 * sigma * sigma / tau, 0.0, sigma * sigma),
                [0.0, 2.0 * sigma * sigma * tau / (t * t) * (t - tau * (1.0 - (-t / tau).exp()))],
            ),
        ];
        for (model, expected) in cases {
            let found = of_process(&model, t);
            for k in 0..2 {
                assert!((found[k] - expected[k]).abs() <= 1e-10 * expected[k], "{found:?} {expected:?}");
            }
        }
    }
}
