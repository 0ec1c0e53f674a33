use libm::sqrt;

use super::Step;

/// The same step with one standard normal w in place of three, for the interval means y alone:
///
/// ```text
/// y  = mean m + s w
/// m' = phi m + k w
/// ```
///
/// where m is the expectation of the states given all interval means so far. What remains unknown of
/// the states has a covariance that depends on the lengths of the steps and on nothing that was drawn, so
/// it is carried beside m. The joint law of all interval means is exactly that of the step: this is its
/// innovations representation (Anderson and Moore, *Optimal Filtering*, 1979, chapter 9).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Innovation {
    /// Standard deviation of the interval mean given all before.
    pub s: f64,
    /// What one w moves the expectation of each state by.
    pub k: [f64; 2],
    /// Covariance (11, 21, 22) of the states after the step, given the means until then.
    pub covariance: [f64; 3],
}

/// Steps of equal length after which an [`Innovation`] no longer changes: by each, what is left of the
/// beginning falls to 0.07 of its size with one state and to 0.19 with two.
pub const SETTLED: u32 = 24;

impl Step {
    /// The step with one normal where the covariance (11, 21, 22) of the states before it, given the means
    /// until then, is `covariance`; zero where the states are known.
    pub fn innovation(&self, covariance: &[f64; 3]) -> Innovation {
        let [p11, p21, p22] = *covariance;
        // A lower triangular factor of the covariance turns what is unknown into two normals more.
        let l11 = sqrt(p11);
        let l21 = if l11 > 0.0 { p21 / l11 } else { 0.0 };
        let l22 = sqrt((p22 - l21 * l21).max(0.0));
        let row = |r: [f64; 2], n: [f64; 3]| [r[0] * l11 + r[1] * l21, r[1] * l22, n[0], n[1], n[2]];
        let y = row(self.mean, self.noise[2]);
        let x = [row(self.phi[0], self.noise[0]), row(self.phi[1], self.noise[1])];
        let dot = |a: &[f64; 5], b: &[f64; 5]| -> f64 { (0..5).map(|i| a[i] * b[i]).sum() };
        let variance = dot(&y, &y);
        if variance == 0.0 {
            let covariance = [dot(&x[0], &x[0]), dot(&x[1], &x[0]), dot(&x[1], &x[1])];
            return Innovation { covariance, ..Innovation::default() };
        }
        let s = sqrt(variance);
        // x x' - x y' y x'/y y' as a sum over pairs of normals (Lagrange's identity): nothing cancels.
        let mut covariance = [0.0; 3];
        for i in 0..5 {
            for j in i + 1..5 {
                let [a, b] = [0, 1].map(|r| (x[r][i] * y[j] - x[r][j] * y[i]) / s);
                covariance = [covariance[0] + a * a, covariance[1] + a * b, covariance[2] + b * b];
            }
        }
        Innovation { s, k: [dot(&x[0], &y) / s, dot(&x[1], &y) / s], covariance }
    }
}
