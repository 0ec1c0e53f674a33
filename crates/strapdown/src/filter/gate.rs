//! Which measurements are refused.

use super::chi_square;

/// When a measurement is refused by its innovation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Gate {
    /// Never.
    #[default]
    Off,
    /// Each row by itself: where its normalized innovation squared is above the threshold of one degree of freedom.
    /// Where the noise of the rows is correlated, all are refused with any.
    Scalar(f64),
    /// The whole measurement, where its normalized innovation squared is above the threshold for its number of rows
    /// (one, two, three).
    Vector([f64; 3]),
}

impl Gate {
    /// A gate for each row by itself that refuses a good one with probability `p`.
    pub fn scalar(p: f64) -> Self {
        Gate::Scalar(chi_square::quantile(p, 1))
    }

    /// A gate for the whole measurement that refuses a good one with probability `p`.
    pub fn vector(p: f64) -> Self {
        Gate::Vector([1, 2, 3].map(|dof| chi_square::quantile(p, dof)))
    }

    /// Which of `len` rows pass, given the innovations, their covariance and their normalized square.
    pub(crate) fn judge(&self, nu: [f64; 3], s: &[[f64; 3]; 3], nis: f64, len: usize) -> [bool; 3] {
        match *self {
            Gate::Off => [true; 3],
            Gate::Scalar(threshold) => {
                core::array::from_fn(|i| i >= len || nu[i] * nu[i] <= threshold * s[i][i])
            }
            Gate::Vector(thresholds) => [len == 0 || nis <= thresholds[len - 1]; 3],
        }
    }
}
