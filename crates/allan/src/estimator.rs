use crate::kernel::{second_difference_squares, third_difference_squares};
use crate::{AllanError, Grid, Phase};

/// How a variance is estimated from phase. Definitions: NIST SP 1065, section 5.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Estimator {
    /// Allan variance from adjacent averages that do not overlap.
    NonOverlapping,
    /// Allan variance from all averages, one per sample: the default everywhere.
    Overlapping,
    /// Modified Allan variance: tells white from flicker phase noise; quantization falls with tau^-3.
    Modified,
    /// Hadamard variance without overlap: blind to a linear ramp of the rate.
    HadamardNonOverlapping,
    /// Hadamard variance from all third differences.
    Hadamard,
    /// Total Allan variance: the log is extended by reflection, more confidence at long averaging times.
    Total,
}

/// One estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Averaging factor.
    pub m: usize,
    /// Averaging time m tau0 (s).
    pub tau: f64,
    /// Variance, square of the rate unit.
    pub variance: f64,
    /// Number of differences averaged.
    pub terms: usize,
}

impl Point {
    /// Deviation, the unit of the rate.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        self.variance.sqrt()
    }
}

/// Estimates over averaging times.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// How they were made.
    pub estimator: Estimator,
    /// Sample interval (s).
    pub tau0: f64,
    /// Number of phase samples.
    pub n_phase: usize,
    /// The estimates, averaging time increasing.
    pub points: Vec<Point>,
}

impl Curve {
    /// Estimates from phase at the averaging factors of `grid` that the length allows.
    ///
    /// # Errors
    /// No averaging factor of the grid is short enough for the log.
    pub fn estimate(phase: &Phase, estimator: Estimator, grid: &Grid) -> Result<Self, AllanError> {
        let n = phase.samples().len();
        let factors = grid.factors(estimator.longest(n));
        if factors.is_empty() {
            return Err(AllanError::TooShort {
                got: n - 1,
                need: 3,
                what: "an estimate at the averaging times asked for",
            });
        }
        let points = match estimator {
            Estimator::Overlapping => overlapping(phase, &factors),
            _ => factors.iter().map(|m| estimator.point(phase, *m)).collect(),
        };
        Ok(Self { estimator, tau0: phase.tau0(), n_phase: n, points })
    }

    /// The part with at least `share` of the log outside one averaging time: tau at most `T / share`.
    #[must_use]
    pub fn up_to(&self, share: f64) -> Self {
        let longest = (self.n_phase - 1) as f64 / share;
        let points = self.points.iter().copied().filter(|p| p.m as f64 <= longest).collect();
        Self { points, ..self.clone() }
    }
}

impl Estimator {
    /// Differences taken of phase: 2 for the Allan family, 3 for Hadamard.
    #[must_use]
    pub fn order(self) -> usize {
        match self {
            Estimator::HadamardNonOverlapping | Estimator::Hadamard => 3,
            _ => 2,
        }
    }

    /// Largest averaging factor that `n` phase samples allow.
    #[must_use]
    pub fn longest(self, n: usize) -> usize {
        match self {
            Estimator::NonOverlapping | Estimator::Overlapping => n.saturating_sub(1) / 2,
            Estimator::Modified => n / 3,
            Estimator::HadamardNonOverlapping | Estimator::Hadamard => n.saturating_sub(1) / 3,
            Estimator::Total => n.saturating_sub(1),
        }
    }

    fn point(self, phase: &Phase, m: usize) -> Point {
        let x = phase.samples();
        let tau = m as f64 * phase.tau0();
        let (sum, terms, scale) = match self {
            Estimator::NonOverlapping => {
                let x = every(x, m);
                (second_difference_squares(&x, 1), x.len() - 2, 2.0)
            }
            Estimator::Overlapping => return overlapping(phase, &[m])[0],
            Estimator::Modified => modified(x, m),
            Estimator::HadamardNonOverlapping => {
                let x = every(x, m);
                (third_difference_squares(&x, 1), x.len() - 3, 6.0)
            }
            Estimator::Hadamard => (third_difference_squares(x, m), x.len() - 3 * m, 6.0),
            Estimator::Total => total(x, m),
        };
        Point { m, tau, variance: sum / (scale * tau * tau * terms as f64), terms }
    }
}

/// Phase samples whose differences at all distances are taken before the next ones are.
const BLOCK: usize = 4096;

/// Overlapping variances at all `factors`, block by block: what one averaging time reads the next one finds in the
/// cache, and at octaves the end of a difference is the middle of the next.
fn overlapping(phase: &Phase, factors: &[usize]) -> Vec<Point> {
    let (x, n) = (phase.samples(), phase.samples().len());
    let mut sums = vec![0.0; factors.len()];
    for start in (0..n).step_by(BLOCK) {
        for (sum, m) in sums.iter_mut().zip(factors) {
            let end = n.min(start + BLOCK + 2 * m);
            *sum += second_difference_squares(&x[start..end], *m);
        }
    }
    let point = |(sum, m): (f64, &usize)| {
        let (tau, terms) = (*m as f64 * phase.tau0(), n - 2 * m);
        Point { m: *m, tau, variance: sum / (2.0 * tau * tau * terms as f64), terms }
    };
    sums.into_iter().zip(factors).map(point).collect()
}

fn every(x: &[f64], m: usize) -> Vec<f64> {
    x.iter().step_by(m).copied().collect()
}

/// Differences of phase averaged over m samples; the average runs along by one sample in and one out.
fn modified(x: &[f64], m: usize) -> (f64, usize, f64) {
    let terms = x.len() + 1 - 3 * m;
    let mut run: f64 = (0..m).map(|i| (x[i + 2 * m] - x[i + m]) - (x[i + m] - x[i])).sum();
    let mut sum = run * run;
    for j in 1..terms {
        run += (x[j + 3 * m - 1] - 3.0 * x[j + 2 * m - 1]) + (3.0 * x[j + m - 1] - x[j - 1]);
        sum += run * run;
    }
    (sum, terms, 2.0 * (m * m) as f64)
}

/// Second differences about every inner sample, the log reflected about both of its end points.
fn total(x: &[f64], m: usize) -> (f64, usize, f64) {
    let n = x.len();
    let at = |k: isize| {
        let last = n as isize - 1;
        if k < 0 {
            2.0 * x[0] - x[-k as usize]
        } else if k > last {
            2.0 * x[n - 1] - x[(2 * last - k) as usize]
        } else {
            x[k as usize]
        }
    };
    let sum = (1..n as isize - 1)
        .map(|k| {
            let d = (at(k + m as isize) - at(k)) - (at(k) - at(k - m as isize));
            d * d
        })
        .sum();
    (sum, n - 2, 2.0)
}
