//! Transition and process noise over an interval, and what they do to a covariance.

use fearless_simd::{Level, dispatch};
use nalgebra::{SMatrix, SVector};

use super::transport::{Column, Transport};
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
#[derive(Clone, Debug)]
pub struct Propagation<const N: usize> {
    /// Length of the interval, s.
    pub dt: f64,
    /// Number of navigation errors.
    pub(crate) m: usize,
    /// Number of states.
    pub(crate) n: usize,
    /// Rows of the navigation errors: of Phi by columns, of Q by rows.
    pub(crate) phi_n: [Column; N],
    pub(crate) q_n: [[f64; N]; 9],
    pub(crate) sources: SourceStates<N>,
    /// Whether a state and the next one are a block.
    pub(crate) paired: [bool; N],
    /// How wide the machine's lanes are.
    pub(crate) level: Level,
}

/// What an interval does to the source states by themselves.
#[derive(Clone, Debug)]
pub(crate) struct SourceStates<const N: usize> {
    /// Row of each state within its block.
    phi: [[f64; 2]; N],
    /// The same of blocks of one state; one for the others.
    decay: [f64; N],
    q: [[f64; 2]; N],
}

impl<const N: usize> SourceStates<N> {
    /// Nothing happens.
    pub fn identity(model: &Model<N>) -> Self {
        let mut new = SourceStates { phi: [[1.0, 0.0]; N], decay: [1.0; N], q: [[0.0; 2]; N] };
        for block in model.blocks().filter(|b| b.len == 2) {
            new.phi[block.first + 1] = [0.0, 1.0];
        }
        new
    }

    /// Sets element `l` of the row of state `s` within its block, which is one of a pair or not.
    pub fn set(&mut self, s: usize, l: usize, pair: bool, phi: f64, q: f64) {
        self.phi[s][l] = phi;
        self.q[s][l] = q;
        if !pair {
            self.decay[s] = phi;
        }
    }
}

impl<const N: usize> Propagation<N> {
    /// Nothing happens, over no time.
    pub fn identity(model: &Model<N>) -> Self {
        let (m, n) = (model.nav_len(), model.len());
        let mut p = Propagation {
            dt: 0.0,
            m,
            n,
            phi_n: [[0.0; 16]; N],
            q_n: [[0.0; N]; 9],
            sources: SourceStates::identity(model),
            paired: [false; N],
            level: schuler_imu::random::best_level(),
        };
        for k in 0..m {
            p.phi_n[k][k] = 1.0;
        }
        for block in model.blocks().filter(|b| b.len == 2) {
            p.paired[block.first] = true;
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
        let rows = core::array::from_fn(|i| core::array::from_fn(|j| self.phi_n[j][i]));
        self.full(&rows, &self.sources.phi, false)
    }

    /// The process noise covariance in full.
    pub fn q(&self) -> SMatrix<f64, N, N> {
        self.full(&self.q_n, &self.sources.q, true)
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
        if x.iter().all(|x| *x == 0.0) {
            return;
        }
        let old = *x;
        x.as_mut_slice()[..self.m].fill(0.0);
        for (column, old) in self.phi_n[..self.n].iter().zip(old.iter()) {
            for (x, phi) in x.as_mut_slice()[..self.m].iter_mut().zip(column) {
                *x += phi * old;
            }
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
        [self.sources.phi[s], if self.paired[s] { self.sources.phi[s + 1] } else { [0.0; 2] }]
    }

    /// P := Phi P Phi' + Q, symmetric to the last bit.
    pub fn apply(&self, p: &mut SMatrix<f64, N, N>) {
        self.carry_covariance(p, Some(&self.q_n));
        self.diffuse_sources(p);
    }

    /// P := Phi P Phi', symmetric to the last bit.
    pub fn transport(&self, p: &mut SMatrix<f64, N, N>) {
        self.carry_covariance(p, None);
    }

    fn carry_covariance(&self, p: &mut SMatrix<f64, N, N>, q: Option<&[[f64; N]; 9]>) {
        let p = &mut p.data.0;
        let kernel = Transport {
            phi: &self.phi_n,
            decay: &self.sources.decay,
            phi_s: &self.sources.phi,
            paired: &self.paired,
            q,
            m: self.m,
            n: self.n,
        };
        let level = self.level;
        dispatch!(level, simd => kernel.run(simd, p));
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
                out[first + l] += h * self.sources.q[k][l];
            }
        }
        out
    }

    /// P := P + Q.
    pub fn diffuse(&self, p_whole: &mut SMatrix<f64, N, N>) {
        let (m, n) = (self.m, self.n);
        let p = &mut p_whole.data.0;
        for (p, q) in p[..m].iter_mut().zip(&self.q_n) {
            for (p, q) in p[..n].iter_mut().zip(&q[..n]) {
                *p += q;
            }
        }
        for s in m..n {
            for i in 0..m {
                p[s][i] = p[i][s];
            }
        }
        self.diffuse_sources(p_whole);
    }

    fn diffuse_sources(&self, p: &mut SMatrix<f64, N, N>) {
        let p = &mut p.data.0;
        for s in self.m..self.n {
            let second = s > self.m && self.paired[s - 1];
            let first = if second { s - 1 } else { s };
            p[s][first] += self.sources.q[s][0];
            if second || self.paired[s] {
                p[s][first + 1] += self.sources.q[s][1];
            }
        }
    }
}

/// Scalar product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
