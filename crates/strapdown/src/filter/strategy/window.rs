//! The innovations of the last updates.

use super::{Moment, Square3};
use crate::filter::chi_square;
use crate::filter::small::Ldl;

/// The last `M` innovations, their covariance about zero and a test whether they are what the filter predicts.
#[derive(Clone, Debug, PartialEq)]
pub struct Window<const M: usize> {
    innovations: [[f64; 3]; M],
    nis: [f64; M],
    count: usize,
    /// Threshold of the sum of the normalized squares over a full window of one, two or three rows.
    threshold: [f64; 3],
}

impl<const M: usize> Window<M> {
    /// A window that calls innovations too large which a consistent filter would have with probability `p`.
    pub fn new(p: f64) -> Self {
        Window {
            innovations: [[0.0; 3]; M],
            nis: [0.0; M],
            count: 0,
            threshold: [1, 2, 3].map(|rows| chi_square::quantile(p, rows * M)),
        }
    }

    /// Takes in an innovation and how large it is by what the filter predicts.
    pub fn push<const N: usize>(&mut self, moment: &Moment<'_, N>) {
        let slot = self.count % M.max(1);
        if let (Some(innovation), Some(nis)) = (self.innovations.get_mut(slot), self.nis.get_mut(slot)) {
            *innovation = moment.innovation;
            *nis = Ldl::new(&moment.s(), moment.len())
                .map_or(0.0, |s| s.quadratic(moment.innovation, moment.len()));
            self.count += 1;
        }
    }

    /// Whether there are `M` of them.
    pub fn is_full(&self) -> bool {
        self.count >= M
    }

    /// Whether the window is full and its innovations, of `rows` rows, are larger than the filter predicts: the sum of their
    /// normalized squares is above the quantile of chi-square.
    pub fn exceeds(&self, rows: usize) -> bool {
        self.is_full() && (1..=3).contains(&rows) && self.nis.iter().sum::<f64>() > self.threshold[rows - 1]
    }

    /// C = (1/m) Σ nu nu' over those there are.
    pub fn covariance(&self) -> Square3 {
        let used = self.count.min(M);
        let mut c = [[0.0; 3]; 3];
        for nu in &self.innovations[..used] {
            for i in 0..3 {
                for j in 0..3 {
                    c[i][j] += nu[i] * nu[j] / used as f64;
                }
            }
        }
        c
    }
}
