//! The kernel of the time update, in the widest lanes of the machine.
//!
//! Plain multiplications and additions in the same order whatever the width: the same bits everywhere.

use fearless_simd::{Simd, SimdBase};

/// A column of the rows of the navigation errors, at most nine, filled up with zeros.
pub(crate) type Column = [f64; 16];

/// W = Phi P for the `m` rows of the navigation errors, and Phi P Phi' written into `p`, in which source states are only
/// scaled by their `decay`; with `q` the process noise of the rows of the navigation errors is added. `p` is symmetric, `n`
/// states are in use.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "a kernel: what it works on, piece by piece")]
pub(crate) fn transport<S: Simd, const N: usize>(
    simd: S,
    phi: &[Column; N],
    decay: &[f64; N],
    q: Option<&[[f64; N]; 9]>,
    p: &mut [[f64; N]; N],
    w: &mut [[f64; N]; 9],
    m: usize,
    n: usize,
) {
    // Where all is in use the loops have known lengths.
    if n == N && m == 9 {
        all::<S, N>(simd, phi, decay, q, p, w, 9, N);
    } else {
        all::<S, N>(simd, phi, decay, q, p, w, m, n);
    }
}

#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "a kernel: what it works on, piece by piece")]
fn all<S: Simd, const N: usize>(
    simd: S,
    phi: &[Column; N],
    decay: &[f64; N],
    q: Option<&[[f64; N]; 9]>,
    p: &mut [[f64; N]; N],
    w: &mut [[f64; N]; 9],
    m: usize,
    n: usize,
) {
    rows::<S, N>(simd, phi, p, w, n);
    squares::<S, N>(simd, phi, p, w, m, n);
    for i in m..n {
        let a = decay[i];
        for (p, decay) in p[i][m..n].iter_mut().zip(&decay[m..n]) {
            *p *= a * decay;
        }
    }
    for i in 0..m {
        for ((p, w), decay) in p[i][m..n].iter_mut().zip(&w[i][m..n]).zip(&decay[m..n]) {
            *p = decay * w;
        }
    }
    if let Some(q) = q {
        for i in 0..m {
            for (p, q) in p[i][..n].iter_mut().zip(&q[i][..n]) {
                *p += q;
            }
        }
    }
    for j in m..n {
        for i in 0..m {
            p[j][i] = p[i][j];
        }
    }
}

/// W = Phi P, nine rows and as many columns as lanes at a time.
#[inline(always)]
fn rows<S: Simd, const N: usize>(
    simd: S,
    phi: &[Column; N],
    p: &[[f64; N]; N],
    w: &mut [[f64; N]; 9],
    n: usize,
) {
    let len = S::f64s::LEN;
    let mut first = 0;
    while first + len <= n {
        chunk::<S, N>(simd, phi, p, w, n, first);
        first += len;
    }
    if first < n && n >= len {
        // The last lanes once more with those that are left.
        chunk::<S, N>(simd, phi, p, w, n, n - len);
    } else {
        for j in first..n {
            for i in 0..9 {
                w[i][j] = (0..n).map(|k| phi[k][i] * p[k][j]).sum();
            }
        }
    }
}

#[inline(always)]
fn chunk<S: Simd, const N: usize>(
    simd: S,
    phi: &[Column; N],
    p: &[[f64; N]; N],
    w: &mut [[f64; N]; 9],
    n: usize,
    first: usize,
) {
    let len = S::f64s::LEN;
    let mut sum = [S::f64s::splat(simd, 0.0); 9];
    for k in 0..n {
        let row = S::f64s::from_slice(simd, &p[k][first..first + len]);
        for i in 0..9 {
            sum[i] += row * phi[k][i];
        }
    }
    for i in 0..9 {
        sum[i].store_slice(&mut w[i][first..first + len]);
    }
}

/// Phi P Phi' of the navigation errors, from W: on and below the diagonal.
#[inline(always)]
fn squares<S: Simd, const N: usize>(
    simd: S,
    phi: &[Column; N],
    p: &mut [[f64; N]; N],
    w: &[[f64; N]; 9],
    m: usize,
    n: usize,
) {
    let len = S::f64s::LEN;
    let mut out = [[0.0; 16]; 9];
    let mut first = 0;
    while first < m {
        if first + 1 == m {
            // One is left: lanes would be idle.
            out[first][first] = (0..n).map(|k| phi[k][first] * w[first][k]).sum();
            break;
        }
        let mut sum = [S::f64s::splat(simd, 0.0); 9];
        for k in 0..n {
            let column = S::f64s::from_slice(simd, &phi[k][first..first + len]);
            for i in first..9 {
                sum[i] += column * w[i][k];
            }
        }
        for i in first..9 {
            sum[i].store_slice(&mut out[i][first..first + len]);
        }
        first += len;
    }
    for i in 0..m {
        for j in 0..=i {
            (p[i][j], p[j][i]) = (out[i][j], out[i][j]);
        }
    }
}
