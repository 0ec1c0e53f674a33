//! The update of a covariance by one scalar measurement.

use nalgebra::{SMatrix, SVector};

use super::{FilterError, Row};

/// P h and h P h' of the first `n` states.
pub(crate) fn seen<const N: usize>(p: &SMatrix<f64, N, N>, row: &Row<N>, n: usize) -> ([f64; N], f64) {
    let mut b = [0.0; N];
    for (k, h) in row.pairs() {
        for (b, p) in b[..n].iter_mut().zip(&p.data.0[k][..n]) {
            *b += h * p;
        }
    }
    let variance = row.dot(&b);
    (b, variance)
}

/// P := (I - K h) P (I - K h)' + K r K' (Joseph), with `b = P h'` and `variance = h P h'` already known. It holds for
/// any gain `k` and is symmetric to the last bit:
///
/// ```text
/// P_ij := P_ij - K_i b_j + ((h P h' + r) K_i - b_i) K_j
/// ```
pub(crate) fn joseph<const N: usize>(
    p: &mut SMatrix<f64, N, N>,
    k: &[f64; N],
    b: &[f64; N],
    variance: f64,
    r: f64,
    n: usize,
) {
    let p = &mut p.data.0;
    let s = variance + r;
    for i in 0..n {
        let (k_i, rest) = (k[i], s * k[i] - b[i]);
        let row = &mut p[i][..=i];
        for ((p, k), b) in row.iter_mut().zip(&k[..=i]).zip(&b[..=i]) {
            *p += rest * k - k_i * b;
        }
    }
    for i in 1..n {
        for j in 0..i {
            p[j][i] = p[i][j];
        }
    }
}

/// One scalar measurement `z = h x + v`, v of variance `r`: x and P after it, and the innovation before it with its
/// variance. An error, and nothing changed, where the variance is not positive.
pub(crate) fn update<const N: usize>(
    x: &mut SVector<f64, N>,
    p: &mut SMatrix<f64, N, N>,
    row: &Row<N>,
    z: f64,
    r: f64,
    n: usize,
) -> Result<(f64, f64), FilterError> {
    let (b, variance) = seen(p, row, n);
    let s = variance + r;
    if !(s > 0.0 && s.is_finite()) {
        return Err(FilterError::Covariance { variance: s });
    }
    let innovation = z - row.dot(x.as_slice());
    let per_s = 1.0 / s;
    let gain = b.map(|b| b * per_s);
    for (x, k) in x.as_mut_slice()[..n].iter_mut().zip(&gain) {
        *x += k * innovation;
    }
    joseph(p, &gain, &b, variance, r, n);
    Ok((innovation, s))
}
