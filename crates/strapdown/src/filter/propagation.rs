//! Transition and process noise over an interval, and what they do to a covariance.

use nalgebra::{SMatrix, SVector};

use super::{Model, Row};

/// The transition matrix and the process noise of all states over an interval, stored as sparse as they are:
///
/// ```text
/// Phi = [Phi_nn Phi_ns]     Q = [Q_nn  Q_ns]
///       [0      Phi_ss]         [Q_ns' Q_ss]
/// ```
///
/// with n the at most nine navigation errors and s the source states, whose Phi_ss and Q_ss have blocks of one or two
/// states on the diagonal. Multiplying with it costs nine times the square of the number of states, not twice the cube.
#[derive(Clone, Debug, PartialEq)]
pub struct Propagation<const N: usize> {
    /// Length of the interval, s.
    pub dt: f64,
    /// Number of navigation errors.
    pub(crate) m: usize,
    /// Number of states.
    pub(crate) n: usize,
    /// Rows of the navigation errors.
    pub(crate) phi_n: [[f64; N]; 9],
    pub(crate) q_n: [[f64; N]; 9],
    /// Row of each source state within its block.
    pub(crate) phi_s: [[f64; 2]; N],
    pub(crate) q_s: [[f64; 2]; N],
    /// Whether a state and the next one are a block.
    pub(crate) paired: [bool; N],
}

impl<const N: usize> Propagation<N> {
    /// Nothing happens, over no time.
    pub fn identity(model: &Model<N>) -> Self {
        let (m, n) = (model.nav_len(), model.len());
        let mut p = Propagation {
            dt: 0.0,
            m,
            n,
            phi_n: [[0.0; N]; 9],
            q_n: [[0.0; N]; 9],
            phi_s: [[1.0, 0.0]; N],
            q_s: [[0.0; 2]; N],
            paired: [false; N],
        };
        for k in 0..m {
            p.phi_n[k][k] = 1.0;
        }
        for block in model.blocks().filter(|b| b.len == 2) {
            p.paired[block.first] = true;
            p.phi_s[block.first + 1] = [0.0, 1.0];
        }
        p
    }

    /// Number of states.
    #[allow(clippy::len_without_is_empty, reason = "a filter without states makes no sense")]
    pub fn len(&self) -> usize {
        self.n
    }

    /// The transition matrix in full.
    pub fn phi(&self) -> SMatrix<f64, N, N> {
        self.full(&self.phi_n, &self.phi_s, false)
    }

    /// The process noise covariance in full.
    pub fn q(&self) -> SMatrix<f64, N, N> {
        self.full(&self.q_n, &self.q_s, true)
    }

    fn full(&self, rows: &[[f64; N]; 9], blocks: &[[f64; 2]; N], symmetric: bool) -> SMatrix<f64, N, N> {
        let mut full = SMatrix::zeros();
        for i in 0..self.m {
            for j in 0..self.n {
                full[(i, j)] = rows[i][j];
                if symmetric {
                    full[(j, i)] = rows[i][j];
                }
            }
        }
        let mut s = self.m;
        while s < self.n {
            let len = self.block(s);
            for i in 0..len {
                for j in 0..len {
                    full[(s + i, s + j)] = blocks[s + i][j];
                }
            }
            s += len;
        }
        full
    }

    /// Number of states of the block that begins at `s`.
    fn block(&self, s: usize) -> usize {
        if self.paired[s] { 2 } else { 1 }
    }

    /// x := Phi x.
    pub fn carry(&self, x: &mut SVector<f64, N>) {
        let old = *x;
        for i in 0..self.m {
            x[i] = dot(&self.phi_n[i][..self.n], &old.as_slice()[..self.n]);
        }
        let mut s = self.m;
        while s < self.n {
            let [[a, b], [c, d]] = self.phi_of(s);
            let (u, v) = (old[s], if self.paired[s] { old[s + 1] } else { 0.0 });
            x[s] = a * u + b * v;
            if self.paired[s] {
                x[s + 1] = c * u + d * v;
            }
            s += self.block(s);
        }
    }

    fn phi_of(&self, s: usize) -> [[f64; 2]; 2] {
        [self.phi_s[s], if self.paired[s] { self.phi_s[s + 1] } else { [0.0; 2] }]
    }

    /// P := Phi P Phi', symmetric to the last bit.
    pub fn transport(&self, p: &mut SMatrix<f64, N, N>) {
        let (m, n) = (self.m, self.n);
        let p = &mut p.data.0;
        // W = Phi_n P: rows of the navigation errors.
        let mut w = [[0.0; N]; 9];
        for (row, w) in self.phi_n[..m].iter().zip(&mut w) {
            let w = &mut w[..n];
            for (k, &phi) in row[..n].iter().enumerate() {
                for (w, p) in w.iter_mut().zip(&p[k][..n]) {
                    *w += phi * p;
                }
            }
        }
        // Navigation errors among themselves.
        for i in 0..m {
            for j in 0..=i {
                let value = dot(&w[i][..n], &self.phi_n[j][..n]);
                p[i][j] = value;
                p[j][i] = value;
            }
        }
        // Source states among themselves, and with the navigation errors.
        let mut s = m;
        while s < n {
            let len = self.block(s);
            let [[a, b], [c, d]] = self.phi_of(s);
            if len == 1 {
                if a != 1.0 {
                    for j in m..n {
                        p[s][j] *= a;
                    }
                    for j in m..n {
                        p[j][s] *= a;
                    }
                }
                for i in 0..m {
                    let value = a * w[i][s];
                    p[i][s] = value;
                    p[s][i] = value;
                }
            } else {
                let t = s + 1;
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
                    (p[i][s], p[i][t]) = (a * u + b * v, c * u + d * v);
                    (p[s][i], p[t][i]) = (p[i][s], p[i][t]);
                }
            }
            s += len;
        }
    }

    /// Q h'.
    pub(crate) fn noise_times(&self, row: &Row<N>) -> [f64; N] {
        let mut out = [0.0; N];
        for (k, h) in row.pairs().filter(|(k, _)| *k < self.n) {
            if k < self.m {
                for (out, q) in out[..self.n].iter_mut().zip(&self.q_n[k][..self.n]) {
                    *out += h * q;
                }
                continue;
            }
            for i in 0..self.m {
                out[i] += h * self.q_n[i][k];
            }
            let second = k > self.m && self.paired[k - 1];
            let first = if second { k - 1 } else { k };
            for l in 0..self.block(first) {
                out[first + l] += h * self.q_s[k][l];
            }
        }
        out
    }

    /// P := P + Q.
    pub fn diffuse(&self, p: &mut SMatrix<f64, N, N>) {
        let (m, n) = (self.m, self.n);
        let p = &mut p.data.0;
        for i in 0..m {
            for (p, q) in p[i][..n].iter_mut().zip(&self.q_n[i][..n]) {
                *p += q;
            }
            for j in m..n {
                p[j][i] = p[i][j];
            }
        }
        let mut s = m;
        while s < n {
            let len = self.block(s);
            for i in s..s + len {
                for j in 0..len {
                    p[i][s + j] += self.q_s[i][j];
                }
            }
            s += len;
        }
    }
}

/// Scalar product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
