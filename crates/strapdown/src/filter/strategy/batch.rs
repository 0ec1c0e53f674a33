//! The noise of a measurement estimated from sums of innovations, so that coloured noise is seen for what it does.

use nalgebra::SMatrix;

use super::{Moment, Square3, Strategy};

/// Bounds of the factor on what the measurement says.
const RANGE: [f64; 2] = [1e-4, 1e4];

/// Batches after which one counts 1/e.
const MEMORY: f64 = 10.0;

/// Batches that what the measurement says counts for at the start.
const PRIOR: f64 = 1.0;

/// One factor on R by sums of what the updates left over, in batches of 1, 2, 3 … and at last `length` updates.
///
/// What coloured noise does to a state that moves slowly is made by its density at low frequency, not by its variance: for
/// first-order Gauss-Markov noise of the step factor a it is (1 + a)/(1 - a) times that of white noise of the same variance.
/// The variance of a sum of n values, over n, tends to just that. With w = R/S and the innovations nu, a batch of n updates
/// says in each row
///
/// ```text
/// mean R + [(Σ w nu)² - Σ w² S]/n
/// ```
///
/// which is never negative, is R when the innovations are white and of the covariance S, and with n = 1 is what
/// [`ResidualNoise`](super::ResidualNoise) takes. Its mean over the rows, in units of the R of the measurement, is averaged
/// with weights that fade over ten batches, beginning with one batch of what the measurement says. The first batches are short because an R that is badly wrong must be found before the filter has settled. The factor is
/// the same for all rows, since an estimate that wanders costs accuracy itself; it stays within 1e-4 and 1e4.
///
/// Half as long as the noise is correlated is enough for `length`: a factor of four in place of twenty has most of the effect.
/// Innovations hang together too when P is wrong (a start that was too sure, a base that was moved): there errors are taken
/// for noise, more so than by [`ResidualNoise`](super::ResidualNoise).
///
/// Source: batch means, Fishman, Grouping observations in digital simulation, Management Science 24 (1978), upon the residuals
/// of Mehra (1972).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BatchNoise {
    length: usize,
    /// Batches that were completed.
    batches: usize,
    /// Weighted sum of what they said, and of the weights.
    said: [f64; 2],
    /// Updates of the batch that is being gathered, and by row: Σ w nu, Σ w² S and Σ R, in units of R.
    count: usize,
    sums: [[f64; 3]; 3],
}

impl BatchNoise {
    /// Nothing has been seen; batches of `length` updates at most.
    pub const fn new(length: usize) -> Self {
        BatchNoise { length, batches: 0, said: [PRIOR; 2], count: 0, sums: [[0.0; 3]; 3] }
    }

    /// The factor on R.
    pub fn factor(&self) -> f64 {
        let [said, weight] = self.said;
        (said / weight).clamp(RANGE[0], RANGE[1])
    }

    fn end_batch(&mut self, rows: usize) {
        let [left, expected, noise] = self.sums;
        let one = |i: usize| noise[i] + left[i] * left[i] - expected[i];
        let said = (0..rows).map(one).sum::<f64>() / (rows * self.count) as f64;
        let keep = 1.0 - 1.0 / MEMORY;
        self.said = [self.said[0] * keep + said, self.said[1] * keep + 1.0];
        self.batches += 1;
        (self.count, self.sums) = (0, [[0.0; 3]; 3]);
    }
}

impl<const N: usize> Strategy<N> for BatchNoise {
    fn before(&mut self, _: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        let factor = self.factor();
        for i in 0..moment.len() {
            let unit = moment.r[i][i];
            let s = moment.predicted(i) / unit + factor;
            let w = factor / s;
            self.sums[0][i] += w * moment.innovation[i] / libm::sqrt(unit);
            self.sums[1][i] += w * w * s;
            self.sums[2][i] += factor;
        }
        self.count += 1;
        if self.count > self.batches.min(self.length.saturating_sub(1)) && !moment.is_empty() {
            self.end_batch(moment.len());
        }
        let factor = self.factor();
        moment.r.map(|row| row.map(|r| r * factor))
    }
}
