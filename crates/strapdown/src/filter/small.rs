//! Small positive definite matrices.

use nalgebra::{SMatrix, SVector};

/// `m = L D L'` of a matrix of at most three rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ldl {
    /// Below the diagonal; one on it.
    pub l: [[f64; 3]; 3],
    pub d: [f64; 3],
}

impl Ldl {
    /// The factors, or the row and the pivot that is not positive.
    pub fn new(m: &[[f64; 3]; 3], len: usize) -> Result<Self, (usize, f64)> {
        let mut f = Ldl { l: [[0.0; 3]; 3], d: [0.0; 3] };
        for i in 0..len {
            for j in 0..i {
                let sum: f64 = (0..j).map(|k| f.l[i][k] * f.l[j][k] * f.d[k]).sum();
                f.l[i][j] = (m[i][j] - sum) / f.d[j];
            }
            let sum: f64 = (0..i).map(|k| f.l[i][k] * f.l[i][k] * f.d[k]).sum();
            f.d[i] = m[i][i] - sum;
            if !(f.d[i] > 0.0 && f.d[i].is_finite()) {
                return Err((i, f.d[i]));
            }
        }
        Ok(f)
    }

    pub fn is_diagonal(&self, len: usize) -> bool {
        (0..len).all(|i| self.l[i][..i].iter().all(|l| *l == 0.0))
    }

    /// v' m⁻¹ v.
    pub fn quadratic(&self, mut v: [f64; 3], len: usize) -> f64 {
        for i in 0..len {
            for j in 0..i {
                v[i] -= self.l[i][j] * v[j];
            }
        }
        (0..len).map(|i| v[i] * v[i] / self.d[i]).sum()
    }
}

/// (x - truth)' P⁻¹ (x - truth) of chosen states, by elimination; `None` where P is not positive.
pub(crate) fn nees<const N: usize>(
    x: &SVector<f64, N>,
    p: &SMatrix<f64, N, N>,
    states: &[usize],
    truth: &[f64],
) -> Option<f64> {
    let len = states.len().min(truth.len()).min(N);
    let mut m = [[0.0; N]; N];
    let mut v = [0.0; N];
    for i in 0..len {
        if states[i] >= N {
            return None;
        }
        v[i] = x[states[i]] - truth[i];
        for j in 0..len {
            m[i][j] = p[(states[i], states[j])];
        }
    }
    let mut sum = 0.0;
    for k in 0..len {
        let pivot = m[k][k];
        // A pivot that cancellation has left is as good as zero.
        if pivot.is_nan() || pivot <= 1e-14 * p[(states[k], states[k])] {
            return None;
        }
        sum += v[k] * v[k] / pivot;
        let row = m[k];
        for i in k + 1..len {
            let factor = m[i][k] / pivot;
            v[i] -= factor * v[k];
            for j in k + 1..len {
                m[i][j] -= factor * row[j];
            }
        }
    }
    Some(sum)
}
