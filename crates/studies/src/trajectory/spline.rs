//! Splines of fifth degree: four continuous derivatives, for what needs the change of an acceleration.

use nalgebra::{Matrix2, Matrix2x3};

use super::Jet;

/// Three functions of time that pass through points, each the natural quintic spline: of all functions through the
/// points the one with the least integral of the square of its third derivative (jerk). Through two points a straight line.
#[derive(Clone, Debug, PartialEq)]
pub struct Interpolation {
    times: Vec<f64>,
    /// Coefficients of the powers of the time since the begin of each interval.
    pieces: Vec<[[f64; 6]; 3]>,
}

impl Interpolation {
    /// Through `values` at `times` (s), two or more, increasing.
    pub fn new(times: &[f64], values: &[[f64; 3]]) -> Self {
        let slopes = slopes(times, values);
        let pieces = times.windows(2).zip(values.windows(2)).zip(slopes.windows(2));
        let pieces = pieces
            .map(|((t, y), slopes)| {
                let h = t[1] - t[0];
                std::array::from_fn(|axis| {
                    let [first, second] = [0, 1].map(|row| [0, 1].map(|k| slopes[k][(row, axis)]));
                    hermite(h, [y[0][axis], y[1][axis]], first, second)
                })
            })
            .collect();
        Interpolation { times: times.to_vec(), pieces }
    }

    /// Value and four derivatives at the time `t`; beyond the ends the outer pieces go on.
    pub fn at(&self, t: f64) -> [Jet<5>; 3] {
        let inner = &self.times[1..self.times.len() - 1];
        let piece = inner.partition_point(|begin| *begin <= t);
        let time = Jet::<5>::time(t - self.times[piece]);
        self.pieces[piece].map(|c| c.iter().rev().fold(Jet::constant(0.0), |sum, c| sum * time + *c))
    }
}

/// Coefficients from values, first and second derivatives at both ends of an interval of length `h`.
fn hermite(h: f64, y: [f64; 2], d: [f64; 2], s: [f64; 2]) -> [f64; 6] {
    let (rise, d0, d1) = (y[1] - y[0], h * d[0], h * d[1]);
    let (s0, s1) = (h * h * s[0], h * h * s[1]);
    let cubic = 10.0 * rise - 6.0 * d0 - 4.0 * d1 - 1.5 * s0 + 0.5 * s1;
    let quartic = -15.0 * rise + 8.0 * d0 + 7.0 * d1 + 1.5 * s0 - s1;
    let quintic = 6.0 * rise - 3.0 * d0 - 3.0 * d1 - 0.5 * s0 + 0.5 * s1;
    let h3 = h * h * h;
    [y[0], d[0], 0.5 * s[0], cubic / h3, quartic / (h3 * h), quintic / (h3 * h * h)]
}

/// First and second derivatives (rows) of the three functions (columns) in the knots: those with which the third and fourth
/// derivatives are continuous, and zero at the ends.
fn slopes(times: &[f64], values: &[[f64; 3]]) -> Vec<Matrix2x3<f64>> {
    let n = times.len();
    if n == 2 {
        let slope = |axis: usize| (values[1][axis] - values[0][axis]) / (times[1] - times[0]);
        return vec![Matrix2x3::new(slope(0), slope(1), slope(2), 0.0, 0.0, 0.0); 2];
    }
    // Of the interval after knot k: third (over 6) and fourth (over 24) derivative at its begin and at its end, as they
    // depend on the slopes at begin and end, and on the values.
    let parts = |k: usize| {
        let h = times[k + 1] - times[k];
        let (h2, h3, h4) = (h * h, h * h * h, h * h * h * h);
        let begin = [
            Matrix2::new(-6.0 * h / h3, -1.5 * h2 / h3, 8.0 * h / h4, 1.5 * h2 / h4),
            Matrix2::new(-4.0 * h / h3, 0.5 * h2 / h3, 7.0 * h / h4, -h2 / h4),
        ];
        let end = [
            Matrix2::new(-4.0 * h / h3, -0.5 * h2 / h3, -7.0 * h / h4, -h2 / h4),
            Matrix2::new(-6.0 * h / h3, 1.5 * h2 / h3, -8.0 * h / h4, 1.5 * h2 / h4),
        ];
        let rise = [0, 1, 2].map(|axis| values[k + 1][axis] - values[k][axis]);
        let of = |third: f64, fourth: f64| {
            Matrix2x3::from_fn(|row, axis| rise[axis] * if row == 0 { third / h3 } else { fourth / h4 })
        };
        (begin, of(10.0, -15.0), end, of(10.0, 15.0))
    };
    // Forward elimination: slopes[k] = constant[k] - factor[k] slopes[k + 1].
    let mut factor: Vec<Matrix2<f64>> = Vec::with_capacity(n);
    let mut slopes: Vec<Matrix2x3<f64>> = Vec::with_capacity(n);
    for k in 0..n {
        let (mut diagonal, mut right) = (Matrix2::zeros(), Matrix2x3::zeros());
        let mut above = Matrix2::zeros();
        if k + 1 < n {
            let (begin, rise, ..) = parts(k);
            diagonal -= begin[0];
            above = -begin[1];
            right += rise;
        }
        if k > 0 {
            let (.., end, rise) = parts(k - 1);
            diagonal += end[1];
            right -= rise;
            diagonal -= end[0] * factor[k - 1];
            right -= end[0] * slopes[k - 1];
        }
        let inverse = diagonal.try_inverse().expect("invariant: knots of a spline increase");
        factor.push(inverse * above);
        slopes.push(inverse * right);
    }
    for k in (0..n - 1).rev() {
        let next = slopes[k + 1];
        slopes[k] -= factor[k] * next;
    }
    slopes
}

/// Bases that are not zero at a time.
const ORDER: usize = 6;

/// Functions of time that follow samples as well as quintic splines with equal distances of their knots can: least squares.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit<const N: usize> {
    begin: f64,
    knots: f64,
    /// Number of intervals between knots.
    intervals: f64,
    /// Of the bases, one row each.
    coefficients: Vec<[f64; N]>,
}

impl<const N: usize> Fit<N> {
    /// To `values` at `times` (s, increasing), with knots every `knots` (s) or a little less. `None` where samples are too few
    /// for that many knots.
    pub fn new(times: &[f64], values: &[[f64; N]], knots: f64) -> Option<Self> {
        let (begin, end) = (*times.first()?, *times.last()?);
        let intervals = ((end - begin) / knots).ceil().max(1.0);
        let mut fit = Fit { begin, knots: (end - begin) / intervals, intervals, coefficients: Vec::new() };
        let bases = intervals as usize + ORDER - 1;
        // Normal equations: a band of which the diagonal and what follows it in a row are kept.
        let mut band = vec![[0.0; ORDER]; bases];
        let mut right = vec![[0.0; N]; bases];
        for (t, value) in times.iter().zip(values) {
            let (first, weights) = fit.weights(*t);
            for (i, wi) in weights.iter().enumerate() {
                for (j, wj) in weights[i..].iter().enumerate() {
                    band[first + i][j] += wi.value() * wj.value();
                }
                for (right, value) in right[first + i].iter_mut().zip(value) {
                    *right += wi.value() * value;
                }
            }
        }
        solve(&mut band, &mut right)?;
        fit.coefficients = right;
        Some(fit)
    }

    /// Values and four derivatives at the time `t`; beyond the ends the outer pieces go on.
    pub fn at(&self, t: f64) -> [Jet<5>; N] {
        let (first, weights) = self.weights(t);
        std::array::from_fn(|axis| {
            let rows = &self.coefficients[first..];
            weights.iter().zip(rows).fold(Jet::constant(0.0), |sum, (w, row)| sum + *w * row[axis])
        })
    }

    /// Distance of the knots, s.
    pub fn knots(&self) -> f64 {
        self.knots
    }

    /// The first basis that is not zero at `t`, and six of them.
    fn weights(&self, t: f64) -> (usize, [Jet<5>; ORDER]) {
        let x = (t - self.begin) / self.knots;
        let interval = x.floor().clamp(0.0, self.intervals - 1.0);
        let mut u = Jet::<5>::time(x - interval);
        u.0[1] = 1.0 / self.knots;
        // de Boor's recurrence for equal distances.
        let mut weights = [Jet::constant(0.0); ORDER];
        weights[0] = Jet::constant(1.0);
        for degree in 1..ORDER {
            let mut carried = Jet::constant(0.0);
            for (k, weight) in weights[..degree].iter_mut().enumerate() {
                // Knots from k + 1 - degree to k + 1 about the interval.
                let part = *weight * (1.0 / degree as f64);
                let (right, left) = (-u + (k + 1) as f64, u + (degree as f64 - 1.0 - k as f64));
                *weight = carried + part * right;
                carried = part * left;
            }
            weights[degree] = carried;
        }
        (interval as usize, weights)
    }
}

/// Solves a symmetric positive definite band by Cholesky, in place. `None` where it is not positive definite.
fn solve<const N: usize>(band: &mut [[f64; ORDER]], right: &mut [[f64; N]]) -> Option<()> {
    let n = band.len();
    let scale = band.iter().map(|row| row[0]).fold(0.0, f64::max);
    for k in 0..n {
        let pivot = band[k][0];
        if pivot <= 1e-12 * scale {
            return None;
        }
        for i in 1..ORDER.min(n - k) {
            let factor = band[k][i] / pivot;
            for j in i..ORDER.min(n - k) {
                band[k + i][j - i] -= factor * band[k][j];
            }
            for axis in 0..N {
                right[k + i][axis] -= factor * right[k][axis];
            }
        }
    }
    for k in (0..n).rev() {
        for axis in 0..N {
            let known: f64 = (1..ORDER.min(n - k)).map(|i| band[k][i] * right[k + i][axis]).sum();
            right[k][axis] = (right[k][axis] - known) / band[k][0];
        }
    }
    Some(())
}
