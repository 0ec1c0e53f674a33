//! The bound on what a strategy may make of the covariance.

use nalgebra::SMatrix;

/// Sweeps of the eigenvalue search at most; four to six do.
const SWEEPS: usize = 30;

/// Elements of the whitened matrix, whose bound is one, that count as zero.
const ZERO: f64 = 1e-12;

/// Takes back of an inflation from `before` to `p` what goes beyond the prior covariance D = diag(`cap`).
///
/// In units of the prior, `W = D^-½ P D^-½`, with the eigenvalues mu_j and eigenvectors u_j,
///
/// ```text
/// P := C P C',   C = D^½ [I - Σ (1 - sqrt(t_j/mu_j)) u_j u_j'] D^-½,   t_j = max(1, u_j' W_before u_j)
/// ```
///
/// over all mu_j above t_j: no direction is left with less information than the prior has, unless it had less before. This is
/// a bound on the matrix and not on its diagonal, which is what fading of an alignment needs. Along what no measurement
/// observes, N, the covariance tends to `N (N' D⁻¹ N)⁻¹ N'`, which has just the eigenvalue one there, so that windup ends
/// where it begins; what is observed is far below one and fades as without cap. To bound the variances one by
/// one is not enough: an accelerometer bias cannot be told from its tilt, and to scale one of the two cuts their correlation,
/// which makes the filter sure of a difference that it has not seen.
///
/// A congruence, so that P stays positive. A state whose prior is zero is measured by its variance in `before`.
pub fn hold<const N: usize>(
    p: &mut SMatrix<f64, N, N>,
    before: &SMatrix<f64, N, N>,
    cap: &[f64; N],
    n: usize,
) {
    if (0..n).all(|k| p[(k, k)] <= before[(k, k)]) {
        return;
    }
    let mut d = [0.0; N];
    for k in 0..n {
        d[k] = libm::sqrt(if cap[k] > 0.0 { cap[k] } else { before[(k, k)] });
    }
    let mut w = [[0.0; N]; N];
    for i in 0..n {
        for j in 0..n {
            let unit = d[i] * d[j];
            w[i][j] = if unit > 0.0 { p[(i, j)] / unit } else { 0.0 };
        }
    }
    let (values, vectors) = eigen(w, n);
    for (mu, u) in values[..n].iter().zip(&vectors) {
        if *mu <= 1.0 {
            continue;
        }
        // Along u, in the units of P: what P sees of it and what it was.
        let mut scaled = [0.0; N];
        for k in (0..n).filter(|&k| d[k] > 0.0) {
            scaled[k] = u[k] / d[k];
        }
        let limit = quadratic(before, &scaled, n).max(1.0);
        if *mu <= limit {
            continue;
        }
        // P := (I - a b') P (I - b a') with a = beta D^½ u, b = D^-½ u.
        let beta = 1.0 - libm::sqrt(limit / mu);
        let mut seen = [0.0; N];
        for i in 0..n {
            seen[i] = (0..n).map(|j| p.data.0[i][j] * scaled[j]).sum();
        }
        let square: f64 = (0..n).map(|k| seen[k] * scaled[k]).sum();
        for i in 0..n {
            let a = beta * d[i] * u[i];
            for j in 0..=i {
                let b = beta * d[j] * u[j];
                let value = p.data.0[i][j] - a * seen[j] - seen[i] * b + a * b * square;
                (p.data.0[i][j], p.data.0[j][i]) = (value, value);
            }
        }
    }
}

/// v' m v.
fn quadratic<const N: usize>(m: &SMatrix<f64, N, N>, v: &[f64; N], n: usize) -> f64 {
    (0..n).map(|i| v[i] * (0..n).map(|j| m.data.0[i][j] * v[j]).sum::<f64>()).sum()
}

/// Eigenvalues of a symmetric matrix and the eigenvectors, by rows: cyclic Jacobi rotations (Golub and Van Loan, Matrix
/// Computations, section 8.5), each of which makes one element off the diagonal zero.
fn eigen<const N: usize>(mut w: [[f64; N]; N], n: usize) -> ([f64; N], [[f64; N]; N]) {
    let mut u = [[0.0; N]; N];
    for k in 0..n {
        u[k][k] = 1.0;
    }
    for _ in 0..SWEEPS {
        let mut turned = false;
        for i in 0..n {
            for j in i + 1..n {
                if w[i][j].abs() <= ZERO {
                    continue;
                }
                turned = true;
                let theta = 0.5 * (w[j][j] - w[i][i]) / w[i][j];
                let t = libm::copysign(1.0, theta) / (theta.abs() + libm::sqrt(theta * theta + 1.0));
                let c = 1.0 / libm::sqrt(t * t + 1.0);
                let s = t * c;
                let small = t * w[i][j];
                w[i][i] -= small;
                w[j][j] += small;
                (w[i][j], w[j][i]) = (0.0, 0.0);
                for k in (0..n).filter(|&k| k != i && k != j) {
                    let (a, b) = (w[i][k], w[j][k]);
                    (w[i][k], w[j][k]) = (c * a - s * b, s * a + c * b);
                    (w[k][i], w[k][j]) = (w[i][k], w[j][k]);
                }
                for k in 0..n {
                    let (a, b) = (u[i][k], u[j][k]);
                    (u[i][k], u[j][k]) = (c * a - s * b, s * a + c * b);
                }
            }
        }
        if !turned {
            break;
        }
    }
    (core::array::from_fn(|k| w[k][k]), u)
}
