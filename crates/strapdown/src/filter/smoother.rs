//! Fixed-interval smoothing.

use nalgebra::{SMatrix, SVector};

use super::{Filter, Propagation};

/// What a filter knew at one time; a slice of them is all that the smoother needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Record<const N: usize> {
    /// Transition from the record before to this one.
    pub phi: SMatrix<f64, N, N>,
    /// Prediction: after the time update, before any measurement of this time.
    pub x_predicted: SVector<f64, N>,
    /// Its covariance.
    pub p_predicted: SMatrix<f64, N, N>,
    /// After the measurements of this time and before feedback; [`smooth`] replaces it by the smoothed estimate.
    pub x: SVector<f64, N>,
    /// Its covariance; likewise.
    pub p: SMatrix<f64, N, N>,
}

impl<const N: usize> Record<N> {
    /// Of a filter that has just been moved by `step`; [`Record::updated`] completes it.
    pub fn predicted(filter: &Filter<N>, step: &Propagation<N>) -> Self {
        Record { phi: step.phi(), x_predicted: filter.x, p_predicted: filter.p, x: filter.x, p: filter.p }
    }

    /// Takes in what the filter knows after the measurements of this time.
    pub fn updated(&mut self, filter: &Filter<N>) {
        (self.x, self.p) = (filter.x, filter.p);
    }
}

/// Fixed-interval smoother: goes back from the last record to the first and replaces x and P of each by the estimate from
/// **all** measurements. Only the first `n` states are looked at.
///
/// ```text
/// C_k = P_k Phi' (P⁻_{k+1})⁻¹
/// x^s_k = x_k + C_k (x^s_{k+1} - x⁻_{k+1}),   P^s_k = P_k + C_k (P^s_{k+1} - P⁻_{k+1}) C_k'
/// ```
///
/// With feedback after each update the same holds: x_k is then the error of the navigator before feedback, x⁻_{k+1} is what
/// the filter said after it. Directions that P⁻ is sure of (a walk that starts at zero) are left as they are.
///
/// Source: Rauch, Tung and Striebel, Maximum likelihood estimates of linear dynamic systems, AIAA Journal 3 (1965).
pub fn smooth<const N: usize>(records: &mut [Record<N>], n: usize) {
    let n = n.min(N);
    for k in (1..records.len()).rev() {
        let (before, after) = records.split_at_mut(k);
        let (Some(now), Some(next)) = (before.last_mut(), after.first()) else { continue };
        // C' = (P⁻)⁻¹ Phi P.
        let c_t = solve(&next.p_predicted, &(next.phi * now.p), n);
        let c = c_t.transpose();
        now.x += c * (next.x - next.x_predicted);
        let p = now.p + c * (next.p - next.p_predicted) * c_t;
        now.p = (p + p.transpose()) * 0.5;
    }
}

/// a⁻¹ b over the first `n` rows (the others are zero), for a positive semidefinite `a`: L D L', with directions of no variance left out.
pub(crate) fn solve<const N: usize>(
    a: &SMatrix<f64, N, N>,
    b: &SMatrix<f64, N, N>,
    n: usize,
) -> SMatrix<f64, N, N> {
    let mut l = SMatrix::<f64, N, N>::identity();
    let mut d = [0.0; N];
    let mut x = *b;
    for j in 0..n {
        let pivot = a[(j, j)] - (0..j).map(|k| l[(j, k)] * l[(j, k)] * d[k]).sum::<f64>();
        d[j] = if pivot > 1e-15 * a[(j, j)] { pivot } else { 0.0 };
        for i in j + 1..n {
            let sum: f64 = (0..j).map(|k| l[(i, k)] * l[(j, k)] * d[k]).sum();
            l[(i, j)] = if d[j] > 0.0 { (a[(i, j)] - sum) / d[j] } else { 0.0 };
        }
    }
    for column in 0..N {
        for i in 0..n {
            for k in 0..i {
                x[(i, column)] -= l[(i, k)] * x[(k, column)];
            }
        }
        for i in 0..n {
            x[(i, column)] = if d[i] > 0.0 { x[(i, column)] / d[i] } else { 0.0 };
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                x[(i, column)] -= l[(k, i)] * x[(k, column)];
            }
        }
    }
    for row in n..N {
        x.row_mut(row).fill(0.0);
    }
    x
}
