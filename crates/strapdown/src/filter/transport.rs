//! The kernel of the time update, in the widest lanes of the machine.
//!
//! Plain multiplications and additions in the same order whatever the width: the same bits everywhere.

use fearless_simd::{Simd, SimdBase, f64x4};

/// A column of the rows of the navigation errors, at most nine, filled up with zeros.
pub(crate) type Column = [f64; 16];

/// What a time update does to a covariance.
pub(crate) struct Transport<'a, const N: usize> {
    /// Columns of the rows of the navigation errors.
    pub phi: &'a [Column; N],
    /// By what source states are scaled; those of blocks of two are not.
    pub decay: &'a [f64; N],
    /// Row of each source state within its block, and whether a state and the next one are a block.
    pub phi_s: &'a [[f64; 2]; N],
    pub paired: &'a [bool; N],
    /// Process noise of the rows of the navigation errors.
    pub q: Option<&'a [[f64; N]; 9]>,
    /// Number of navigation errors, and of states.
    pub m: usize,
    pub n: usize,
}

impl<const N: usize> Transport<'_, N> {
    /// `p`, which is symmetric, becomes Phi P Phi' + Q, but for Q of the source states.
    #[inline(always)]
    pub fn run<S: Simd>(&self, simd: S, p: &mut [[f64; N]; N]) {
        // Where all is in use the loops have known lengths.
        if self.n == N && self.m == 9 {
            self.all(simd, p, 9, N);
        } else {
            self.all(simd, p, self.m, self.n);
        }
    }

    #[inline(always)]
    fn all<S: Simd>(&self, simd: S, p: &mut [[f64; N]; N], m: usize, n: usize) {
        let mut w = [[0.0; N]; 9];
        self.rows(simd, p, &mut w, n);
        self.fade(simd, p, m, n);
        self.couplings(simd, p, &w, m, n);
        self.squares(simd, p, &w, m, n);
        for i in 0..m {
            for j in m..n {
                p[j][i] = p[i][j];
            }
        }
        for s in (m..n).filter(|&s| self.paired[s]) {
            self.pair(p, &w, s, m, n);
        }
    }

    /// A block of two states, which has not been scaled.
    fn pair(&self, p: &mut [[f64; N]; N], w: &[[f64; N]; 9], s: usize, m: usize, n: usize) {
        let (t, [a, b], [c, d]) = (s + 1, self.phi_s[s], self.phi_s[s + 1]);
        for j in m..n {
            let (u, v) = (p[s][j], p[t][j]);
            (p[s][j], p[t][j]) = (a * u + b * v, c * u + d * v);
        }
        for j in m..n {
            let (u, v) = (p[j][s], p[j][t]);
            (p[j][s], p[j][t]) = (a * u + b * v, c * u + d * v);
        }
        p[s][t] = p[t][s];
        for i in 0..m {
            let (u, v) = (w[i][s], w[i][t]);
            let (q_s, q_t) = self.q.map_or((0.0, 0.0), |q| (q[i][s], q[i][t]));
            (p[i][s], p[i][t]) = (a * u + b * v + q_s, c * u + d * v + q_t);
            (p[s][i], p[t][i]) = (p[i][s], p[i][t]);
        }
    }

    /// Source states among themselves. What lies left of them is overwritten later.
    #[inline(always)]
    fn fade<S: Simd>(&self, simd: S, p: &mut [[f64; N]; N], m: usize, n: usize) {
        let len = S::f64s::LEN;
        let mut end = n;
        while end > m {
            let from = end.saturating_sub(len);
            if end - from == len {
                let decay = S::f64s::from_slice(simd, &self.decay[from..end]);
                for i in m..n {
                    let row = S::f64s::from_slice(simd, &p[i][from..end]);
                    (row * (decay * self.decay[i])).store_slice(&mut p[i][from..end]);
                }
            } else {
                for i in m..n {
                    for j in from..end {
                        p[i][j] *= self.decay[i] * self.decay[j];
                    }
                }
            }
            end = from;
        }
    }

    /// W = Phi P, nine rows and as many columns as lanes at a time.
    #[inline(always)]
    fn rows<S: Simd>(&self, simd: S, p: &[[f64; N]; N], w: &mut [[f64; N]; 9], n: usize) {
        let len = S::f64s::LEN;
        if n < len {
            for j in 0..n {
                for i in 0..9 {
                    w[i][j] = (0..n).map(|k| self.phi[k][i] * p[k][j]).sum();
                }
            }
            return;
        }
        let mut first = 0;
        while first < n {
            // The last lanes once more with those that are left.
            let from = first.min(n - len);
            let mut sum = [S::f64s::splat(simd, 0.0); 9];
            for (p, phi) in p[..n].iter().zip(&self.phi[..n]) {
                let row = S::f64s::from_slice(simd, &p[from..from + len]);
                for i in 0..9 {
                    sum[i] += row * phi[i];
                }
            }
            for i in 0..9 {
                sum[i].store_slice(&mut w[i][from..from + len]);
            }
            first += len;
        }
    }

    /// Navigation errors with source states. What lies left of those is overwritten by the squares.
    #[inline(always)]
    fn couplings<S: Simd>(&self, simd: S, p: &mut [[f64; N]; N], w: &[[f64; N]; 9], m: usize, n: usize) {
        let len = S::f64s::LEN;
        if n < len {
            for i in 0..m {
                for j in m..n {
                    p[i][j] = self.decay[j] * w[i][j] + self.q.map_or(0.0, |q| q[i][j]);
                }
            }
            return;
        }
        let mut first = m;
        while first < n {
            let from = first.min(n - len);
            let decay = S::f64s::from_slice(simd, &self.decay[from..from + len]);
            for i in 0..m {
                let mut row = S::f64s::from_slice(simd, &w[i][from..from + len]) * decay;
                if let Some(q) = self.q {
                    row += S::f64s::from_slice(simd, &q[i][from..from + len]);
                }
                row.store_slice(&mut p[i][from..from + len]);
            }
            first += len;
        }
    }

    /// Navigation errors among themselves, from W: on and below the diagonal, and what mirrors it.
    #[inline(always)]
    fn squares<S: Simd>(&self, simd: S, p: &mut [[f64; N]; N], w: &[[f64; N]; 9], m: usize, n: usize) {
        let mut out = [[0.0; 16]; 9];
        self.square::<S, 0>(simd, &mut out, w, n);
        self.square::<S, 4>(simd, &mut out, w, n);
        self.square::<S, 8>(simd, &mut out, w, n);
        if let Some(q) = self.q {
            for i in 0..m {
                for (out, q) in out[i][..m].iter_mut().zip(&q[i][..m]) {
                    *out += q;
                }
            }
        }
        for i in 0..m {
            p[i][..m].copy_from_slice(&out[i][..m]);
        }
        for i in 1..m {
            for j in 0..i {
                p[j][i] = out[i][j];
            }
        }
    }

    /// Rows from FIRST on of four columns from FIRST on: wider lanes would lie above the diagonal.
    #[inline(always)]
    fn square<S: Simd, const FIRST: usize>(
        &self,
        simd: S,
        out: &mut [[f64; 16]; 9],
        w: &[[f64; N]; 9],
        n: usize,
    ) {
        let mut sum = [f64x4::splat(simd, 0.0); 9];
        for (k, phi) in self.phi[..n].iter().enumerate() {
            let column = f64x4::from_slice(simd, &phi[FIRST..FIRST + 4]);
            for i in FIRST..9 {
                sum[i] += column * w[i][k];
            }
        }
        for i in FIRST..9 {
            sum[i].store_slice(&mut out[i][FIRST..FIRST + 4]);
        }
    }
}
