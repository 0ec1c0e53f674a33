//! Figures of all runs, gathered run by run in the order of their numbers.

use std::sync::OnceLock;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::bands::{QuantileRanks, Z, chi_square_band};
use super::prediction::Predicted;
use super::sketch::Sketch;
use crate::scenario::{RunFigure, Threshold};

/// Nine errors and the horizontal distance.
pub const QUANTITIES: usize = 10;
/// Number of the horizontal distance.
pub const HORIZONTAL: usize = 9;
/// Runs of which every row is kept for pictures.
pub const SHOWN: usize = 50;

/// A figure with its 99 % confidence interval, whose upper end is infinite where the runs are too few to give one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// As found.
    pub value: f64,
    /// Ends of the interval.
    pub low: f64,
    pub high: f64,
}

/// Everything that is kept of the runs; it does not grow with their number.
pub struct Statistics<'a> {
    thresholds: &'a [Threshold],
    rows: Vec<Row>,
    /// Runs so far.
    pub runs: u64,
    /// 99 % band of their variances, which is worked out once.
    band: OnceLock<[f64; 2]>,
    /// The first runs.
    pub shown: Vec<Vec<[f64; 9]>>,
}

/// One time.
struct Row {
    runs: u64,
    mean: [f64; 9],
    /// Sums of the squares about the mean.
    squares: [f64; 9],
    sketches: Vec<Sketch>,
    beyond: Vec<u64>,
    nees: Option<Whitening>,
    nees_sum: f64,
}

/// What makes of an error independent numbers of variance one, if the prediction is right.
struct Whitening {
    mean: DVector<f64>,
    /// A row for each degree of freedom.
    to_normal: DMatrix<f64>,
}

/// Below this part of the largest variance (of errors scaled to one), a direction counts as one in which nothing happens.
const NOTHING: f64 = 1e-6;

impl Whitening {
    /// `None` where nothing is predicted to move.
    fn new(predicted: &Predicted) -> Option<Whitening> {
        let moving: Vec<usize> = (0..9).filter(|&k| predicted.sd(k) > 0.0).collect();
        let correlation = DMatrix::from_fn(moving.len(), moving.len(), |i, j| {
            let (i, j) = (moving[i], moving[j]);
            predicted.p[(i, j)] / (predicted.sd(i) * predicted.sd(j))
        });
        if moving.is_empty() {
            return None;
        }
        let eigen = correlation.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let kept: Vec<usize> =
            (0..moving.len()).filter(|&k| eigen.eigenvalues[k] > NOTHING * largest).collect();
        let to_normal = DMatrix::from_fn(kept.len(), 9, |row, column| {
            moving.iter().position(|&k| k == column).map_or(0.0, |i| {
                eigen.eigenvectors[(i, kept[row])]
                    / (eigen.eigenvalues[kept[row]].sqrt() * predicted.sd(column))
            })
        });
        Some(Whitening { mean: DVector::from_fn(9, |k, _| predicted.mean[k]), to_normal })
    }

    fn freedom(&self) -> usize {
        self.to_normal.nrows()
    }

    fn square(&self, error: &[f64; 9]) -> f64 {
        let mut sum = 0.0;
        for row in self.to_normal.row_iter() {
            let x: f64 = (0..9).map(|k| row[k] * (error[k] - self.mean[k])).sum();
            sum += x * x;
        }
        sum
    }
}

impl<'a> Statistics<'a> {
    /// Nothing yet, for `rows` rows beside what is predicted of them.
    pub fn new(rows: usize, predicted: Option<&[Predicted]>, thresholds: &'a [Threshold]) -> Statistics<'a> {
        let row = |k: usize| Row {
            runs: 0,
            mean: [0.0; 9],
            squares: [0.0; 9],
            sketches: vec![Sketch::default(); QUANTITIES],
            beyond: vec![0; thresholds.len()],
            nees: predicted.and_then(|rows| Whitening::new(&rows[k])),
            nees_sum: 0.0,
        };
        let rows = (0..rows).map(row).collect();
        Statistics { thresholds, rows, runs: 0, band: OnceLock::new(), shown: Vec::new() }
    }

    /// More runs, one after the other: the errors of each at each row.
    pub fn add(&mut self, errors: &[[f64; 9]]) {
        let (rows, thresholds) = (self.rows.len(), self.thresholds);
        self.runs += (errors.len() / rows) as u64;
        self.band = OnceLock::new();
        let more = SHOWN - self.shown.len();
        self.shown.extend(errors.chunks_exact(rows).take(more).map(<[_]>::to_vec));
        self.rows.par_iter_mut().enumerate().for_each(|(k, row)| {
            errors.iter().skip(k).step_by(rows).for_each(|error| row.add(error, thresholds));
        });
    }

    /// [`chi_square_band`].
    fn band(&self, freedom: f64) -> [f64; 2] {
        let band = || chi_square_band(freedom);
        if freedom == (self.runs - 1) as f64 { *self.band.get_or_init(band) } else { band() }
    }

    /// Rows.
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Mean of a quantity; of the horizontal distance the length of the mean, without an interval.
    pub fn mean(&self, row: usize, quantity: usize) -> Estimate {
        let r = &self.rows[row];
        if quantity == HORIZONTAL {
            return Estimate { value: r.mean[0].hypot(r.mean[1]), low: f64::NAN, high: f64::NAN };
        }
        let half = Z * (r.variance(quantity) / r.runs as f64).sqrt();
        let value = r.mean[quantity];
        Estimate { value, low: value - half, high: value + half }
    }

    /// A figure of a quantity.
    pub fn figure(&self, row: usize, quantity: usize, figure: RunFigure) -> Estimate {
        let r = &self.rows[row];
        let square = match figure {
            RunFigure::Quantile(p) => {
                let sketch = &r.sketches[quantity];
                let ranks = QuantileRanks::of(p, sketch.total());
                return Estimate {
                    value: sketch.of_rank(ranks.value),
                    // No magnitude is below zero; above, too few runs say nothing.
                    low: ranks.low.map_or(0.0, |rank| sketch.of_rank(rank)),
                    high: ranks.high.map_or(f64::INFINITY, |rank| sketch.of_rank(rank)),
                };
            }
            RunFigure::Deviation => |r: &Row, k: usize| r.variance(k),
            RunFigure::Rms => |r: &Row, k: usize| r.mean_square(k),
        };
        let (value, freedom) = if quantity == HORIZONTAL {
            // Two variances that may differ count as Satterthwaite has it (Biometrics Bulletin 2, 1946).
            let (n, e) = (square(r, 0), square(r, 1));
            (n + e, (r.runs - 1) as f64 * (n + e) * (n + e) / (n * n + e * e))
        } else {
            (square(r, quantity), (r.runs - 1) as f64)
        };
        if value == 0.0 {
            return Estimate { value, low: 0.0, high: 0.0 };
        }
        let [low, high] = self.band(freedom);
        Estimate { value: value.sqrt(), low: (value / high).sqrt(), high: (value / low).sqrt() }
    }

    /// How many runs are beyond a threshold.
    pub fn beyond(&self, row: usize, threshold: usize) -> u64 {
        self.rows[row].beyond[threshold]
    }

    /// Mean normalized error squared a degree of freedom with its 99 % band about one, and the degrees of freedom of a run.
    pub fn nees(&self, row: usize) -> Option<(Estimate, usize)> {
        let r = &self.rows[row];
        let freedom = r.nees.as_ref()?.freedom();
        let all = (freedom as u64 * r.runs) as f64;
        let [low, high] = chi_square_band(all);
        Some((Estimate { value: r.nees_sum / all, low, high }, freedom))
    }
}

impl Row {
    fn add(&mut self, error: &[f64; 9], thresholds: &[Threshold]) {
        self.runs += 1;
        for k in 0..9 {
            // Welford: Technometrics 4 (1962).
            let off = error[k] - self.mean[k];
            self.mean[k] += off / self.runs as f64;
            self.squares[k] += off * (error[k] - self.mean[k]);
            self.sketches[k].add(error[k]);
        }
        let horizontal = error[0].hypot(error[1]);
        self.sketches[HORIZONTAL].add(horizontal);
        for (beyond, threshold) in self.beyond.iter_mut().zip(thresholds) {
            let x = error.get(threshold.quantity).copied().unwrap_or(horizontal);
            *beyond += u64::from(x.abs() > threshold.limit);
        }
        if let Some(whitening) = &self.nees {
            self.nees_sum += whitening.square(error);
        }
    }

    fn variance(&self, k: usize) -> f64 {
        self.squares[k] / (self.runs - 1) as f64
    }

    fn mean_square(&self, k: usize) -> f64 {
        self.squares[k] / self.runs as f64 + self.mean[k] * self.mean[k]
    }
}

/// Whether a sampled standard deviation is within the 99 % chi-square band about the predicted one: the ratio of their
/// squares and its band. `None` where nothing is predicted to move.
pub fn verdict(
    statistics: &Statistics,
    row: usize,
    quantity: usize,
    predicted: &Predicted,
) -> Option<Verdict> {
    let sd = predicted.sd(quantity);
    // Held heights move by rounding alone.
    if sd <= 0.0 {
        return None;
    }
    let found = statistics.figure(row, quantity, RunFigure::Deviation).value;
    let runs = (statistics.runs - 1) as f64;
    let freedom = if quantity == HORIZONTAL {
        let plane = predicted.p.fixed_view::<2, 2>(0, 0);
        runs * plane.trace() * plane.trace() / (plane * plane).trace()
    } else {
        runs
    };
    let [low, high] = statistics.band(freedom);
    Some(Verdict { ratio: (found / sd).powi(2), low, high })
}

/// A sampled variance over the predicted one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    pub ratio: f64,
    pub low: f64,
    pub high: f64,
}

impl Verdict {
    /// Whether it is within its band.
    pub fn holds(&self) -> bool {
        (self.low..=self.high).contains(&self.ratio)
    }
}
