//! A row of a measurement matrix, sparse.

/// Sensitivity of one scalar measurement to the states, those that are zero left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<const N: usize> {
    index: [usize; N],
    value: [f64; N],
    len: usize,
}

impl<const N: usize> Default for Row<N> {
    fn default() -> Self {
        Row { index: [0; N], value: [0.0; N], len: 0 }
    }
}

impl<const N: usize> Row<N> {
    /// From pairs of state and sensitivity. Zeros are left out, and a state named twice counts with the sum.
    pub fn from_pairs(pairs: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let mut row = Row::default();
        for (state, value) in pairs {
            row.add(state, value);
        }
        row
    }

    /// Adds `value` to the sensitivity to `state`, which must be below N; beyond it nothing happens.
    pub fn add(&mut self, state: usize, value: f64) {
        if value == 0.0 || state >= N {
            return;
        }
        match self.index[..self.len].iter().position(|&i| i == state) {
            Some(k) => self.value[k] += value,
            None if self.len < N => {
                (self.index[self.len], self.value[self.len]) = (state, value);
                self.len += 1;
            }
            None => {}
        }
    }

    /// The pairs of state and sensitivity.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.index[..self.len].iter().copied().zip(self.value[..self.len].iter().copied())
    }

    /// h x.
    pub fn dot(&self, x: &[f64]) -> f64 {
        self.pairs().map(|(k, h)| h * x[k]).sum()
    }

    /// Adds `factor` times another row.
    pub(crate) fn add_row(&mut self, factor: f64, other: &Row<N>) {
        for (k, h) in other.pairs() {
            self.add(k, factor * h);
        }
    }
}
