//! What normal errors of a predicted mean and covariance do in magnitude: exceedance and quantiles.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::prediction::Predicted;
use crate::budget::radius;

/// Directions of the quadrature.
const DIRECTIONS: usize = 256;
/// Standard deviations beyond which nothing is.
const FAR: f64 = 9.0;
/// Part of the longer axis below which the shorter one of a plane distribution does not count.
const FLAT: f64 = 1e-4;

impl Predicted {
    /// Probability that the magnitude of error `k`, or from 9 on of the horizontal error, is larger than `r`.
    pub fn beyond(&self, k: usize, r: f64) -> f64 {
        if k < 9 {
            return line(self.mean[k], self.sd(k), r);
        }
        // Along the main axes the two errors are independent.
        let main = self.p.fixed_view::<2, 2>(0, 0).into_owned().symmetric_eigen();
        let mean = main.eigenvectors.transpose() * self.mean.fixed_rows::<2>(0);
        let sd = main.eigenvalues.map(|x| x.max(0.0).sqrt());
        let (long, short) = if sd[0] >= sd[1] { (0, 1) } else { (1, 0) };
        plane([mean[long], mean[short]], [sd[long], sd[short]], r)
    }

    /// The magnitude that error `k`, or from 9 on the horizontal error, does not exceed with probability `p` (between 0 and 1).
    pub fn quantile(&self, k: usize, p: f64) -> f64 {
        let (mean, sd) = (self.mean(k).abs(), self.sd(k));
        if sd == 0.0 {
            return mean;
        }
        if k >= 9 && mean == 0.0 {
            return radius(&self.p.fixed_view::<2, 2>(0, 0).into_owned(), p);
        }
        // The rule of Illinois: the secant, an end that stays counting half.
        let off = |r: f64| 1.0 - p - self.beyond(k, r);
        let (mut a, mut b) = (0.0, mean + FAR * sd);
        let (mut fa, mut fb) = (off(a), off(b));
        for _ in 0..100 {
            let r = (a * fb - b * fa) / (fb - fa);
            let f = off(r);
            if f.abs() < 1e-13 || (b - a).abs() < 1e-12 * r {
                return r;
            }
            if f * fb < 0.0 {
                (a, fa) = (b, fb);
            } else {
                fa *= 0.5;
            }
            (b, fb) = (r, f);
        }
        b
    }
}

/// Of a normal number.
fn line(mean: f64, sd: f64, r: f64) -> f64 {
    if sd == 0.0 {
        return if mean.abs() > r { 1.0 } else { 0.0 };
    }
    let tail = |x: f64| 0.5 * libm::erfc(x / sd * FRAC_1_SQRT_2);
    tail(r - mean) + tail(r + mean)
}

/// Of two independent ones, the first of the larger deviation: with x = r sin a
///
/// ```text
/// P(< r) = ∫ p(r sin a) P(|y| < r cos a) r cos a da,  -pi/2 < a < pi/2
/// ```
///
/// by the midpoint rule, over the part where x is not far from its mean: even about both ends, the integrand is that of a period.
/// To rounding, but for what is nearly a line, there to 3e-6.
fn plane(mean: [f64; 2], sd: [f64; 2], r: f64) -> f64 {
    if sd[0] == 0.0 {
        return if mean[0].hypot(mean[1]) > r { 1.0 } else { 0.0 };
    }
    if r <= 0.0 {
        return 1.0;
    }
    // A line is an ellipse that is narrow enough: the midpoint rule does not like edges.
    let short = sd[1].max(FLAT * sd[0]);
    let end = |x: f64| (x / r).clamp(-1.0, 1.0).asin();
    let (from, to) = (end(mean[0] - FAR * sd[0]), end(mean[0] + FAR * sd[0]));
    let step = (to - from) / DIRECTIONS as f64;
    let sum: f64 = (0..DIRECTIONS)
        .map(|k| {
            let (s, c) = libm::sincos(from + (k as f64 + 0.5) * step);
            let x = (r * s - mean[0]) / sd[0];
            (-0.5 * x * x).exp() * (1.0 - line(mean[1], short, r * c)) * c
        })
        .sum();
    (1.0 - sum * step * r / (sd[0] * (2.0 * PI).sqrt())).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, SMatrix, SVector};

    use super::*;

    fn predicted(mean: [f64; 2], p: Matrix2<f64>) -> Predicted {
        let mut all = SMatrix::<f64, 9, 9>::zeros();
        all.fixed_view_mut::<2, 2>(0, 0).copy_from(&p);
        let mut centre = SVector::<f64, 9>::zeros();
        (centre[0], centre[1]) = (mean[0], mean[1]);
        Predicted { mean: centre, p: all }
    }

    /// A circle: exp(-r²/(2 s²)), CEP √(2 ln 2) s, R95 √(-2 ln 0.05) s. A line: erfc(r/(s √2)), 0.6744897502 s and 1.9599639845 s.
    #[test]
    fn circles_and_lines() {
        let circle = predicted([0.0; 2], Matrix2::new(4.0, 0.0, 0.0, 4.0));
        for r in [0.5, 2.0, 7.0] {
            assert!((circle.beyond(9, r) - (-r * r / 8.0f64).exp()).abs() < 1e-12, "{r}");
        }
        for p in [0.5f64, 0.95] {
            let expected = 2.0 * (-2.0 * (1.0 - p).ln()).sqrt();
            assert!((circle.quantile(9, p) / expected - 1.0).abs() < 1e-10);
        }
        // Along a diagonal: the variance is the trace.
        let diagonal = predicted([0.0; 2], Matrix2::new(2.0, 2.0, 2.0, 2.0));
        for (p, expected) in [(0.5, 0.6744897501960817), (0.95, 1.959963984540054)] {
            assert!((circle.quantile(0, p) / (2.0 * expected) - 1.0).abs() < 1e-10);
            assert!((diagonal.quantile(9, p) / (2.0 * expected) - 1.0).abs() < 1e-5);
        }
        assert_eq!(circle.quantile(3, 0.5), 0.0);
    }

    /// Away from zero: Q_1(a, a) = (1 + e^(-a²) I_0(a²))/2 (Marcum), with I_0(1) = 1.2660658777520084 (Abramowitz and Stegun 9.8);
    /// on a line the two tails; far away the distance itself.
    #[test]
    fn means_that_are_not_zero() {
        for mean in [[3.0, 0.0], [0.0, -3.0], [1.8, 2.4]] {
            let off = predicted(mean, Matrix2::new(9.0, 0.0, 0.0, 9.0));
            let expected = 0.5 * (1.0 + (-1.0f64).exp() * 1.2660658777520084);
            assert!((off.beyond(9, 3.0) - expected).abs() < 1e-12, "{}", off.beyond(9, 3.0));
            assert!((off.quantile(9, 1.0 - expected) - 3.0).abs() < 1e-9);
        }
        let line = predicted([1.0, 0.0], Matrix2::new(1.0, 0.0, 0.0, 0.0));
        // Phi(-1) + Phi(-3): above 2 and below -2 of a normal number about 1.
        let expected = 0.15865525393145707 + 0.0013498980316300933;
        assert!((line.beyond(0, 2.0) - expected).abs() < 1e-12);
        assert!((line.beyond(9, 2.0) - expected).abs() < 5e-6);
        let far = predicted([300.0, 400.0], Matrix2::new(1.0, 0.0, 0.0, 1.0));
        // The distance is normal about √(500² + 1) but for what the curvature does: 1e-3 of a deviation.
        assert!((far.quantile(9, 0.5) - 500.001).abs() < 1e-3, "{}", far.quantile(9, 0.5));
        let still = predicted([3.0, 4.0], Matrix2::zeros());
        assert!(still.quantile(9, 0.5) == 5.0 && still.beyond(9, 4.9) == 1.0 && still.beyond(9, 5.1) == 0.0);
    }
}
