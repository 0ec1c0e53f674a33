//! Strategies against wrong statistics: covariances and noise adapted by what the innovations show.
//!
//! A strategy is a small object that [`Filter::cycle`] asks once between transition and measurement. What none of them can
//! do is tell a wrong R from a wrong P: fading (a larger P) helps where P is too small (an overconfident start, a base that
//! was moved) and harms badly where R is (noise larger than said, or coloured); an adapted R does the opposite.
//!
//! **Windup.** Fading multiplies P along what no measurement observes, at every step, without end: 1.01 at 1 Hz is a factor
//! of 20 in standard deviation after ten minutes. So inflation is capped by the prior, [`Filter::cap`], on by default: as a
//! matrix, not variance by variance, so that nothing winds up and what is observed fades as it would without.

mod batch;
mod cap;
mod fading;
mod forgetting;
mod noise;
mod strong_tracking;
mod window;

pub use batch::BatchNoise;
pub use fading::{AdaptiveFading, ExponentialFading, MultipleFading};
pub use forgetting::VariableForgetting;
pub use noise::{ResidualNoise, SageHusa};
pub use strong_tracking::StrongTracking;
pub use window::Window;

use nalgebra::SMatrix;

use super::observation::{Now, Observation};
use super::{Filter, FilterError, Outcome, Propagation, Row};

/// Symmetric matrix of the rows of a measurement.
pub type Square3 = [[f64; 3]; 3];

/// What is known when a measurement comes in.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a, const N: usize> {
    /// Rows of the measurement.
    pub rows: &'a [Row<N>],
    /// Number of states.
    pub n: usize,
    /// Innovations.
    pub innovation: [f64; 3],
    /// H Phi P Phi' H'.
    pub carried: Square3,
    /// H Q H'.
    pub driven: Square3,
    /// R as the measurement says.
    pub r: Square3,
}

impl<const N: usize> Moment<'_, N> {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Diagonal of H P⁻ H', Q included.
    pub fn predicted(&self, row: usize) -> f64 {
        self.carried[row][row] + self.driven[row][row]
    }

    /// S = H P⁻ H' + R.
    pub fn s(&self) -> Square3 {
        core::array::from_fn(|i| {
            core::array::from_fn(|j| self.carried[i][j] + self.driven[i][j] + self.r[i][j])
        })
    }
}

/// A way to adapt a filter to what its innovations show.
pub trait Strategy<const N: usize> {
    /// Between transition and measurement: may inflate `p`, which is Phi P Phi' (Q is added afterwards), and returns
    /// the R to be used.
    fn before(&mut self, p: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        let _ = p;
        moment.r
    }

    /// After the update: may inflate `p`.
    fn after(&mut self, p: &mut SMatrix<f64, N, N>, outcome: &Outcome) {
        let _ = (p, outcome);
    }
}

/// No strategy: the plain filter.
impl<const N: usize> Strategy<N> for () {}

impl<const N: usize> Filter<N> {
    /// One cycle under a strategy: time update by `step`, measurement update by `observation`. Time updates without
    /// measurement in between are those of [`Filter::propagate`].
    ///
    /// # Errors
    /// As [`Filter::update_with`]; the time update has been made then.
    pub fn cycle(
        &mut self,
        strategy: &mut impl Strategy<N>,
        step: &Propagation<N>,
        observation: &Observation,
        now: &Now,
    ) -> Result<Outcome, FilterError> {
        self.carry(step);
        step.transport(&mut self.p);
        let rows = match self.rows(observation, now) {
            Ok(rows) => rows,
            Err(error) => {
                step.diffuse(&mut self.p);
                return Err(error);
            }
        };
        let rows = &rows[..observation.len];
        let (innovation, carried) = self.predict(rows, observation.z);
        let mut driven = [[0.0; 3]; 3];
        for (i, row) in rows.iter().enumerate() {
            let qh = step.noise_times(row);
            for (j, other) in rows.iter().enumerate() {
                driven[i][j] = other.dot(&qh);
            }
        }
        let n = self.model.len();
        let moment = Moment { rows, n, innovation, carried, driven, r: observation.r };
        let before = self.p;
        let r = strategy.before(&mut self.p, &moment);
        self.hold(&before, n);
        step.diffuse(&mut self.p);
        let outcome = self.update_rows(rows, observation.z, &r)?;
        let before = self.p;
        strategy.after(&mut self.p, &outcome);
        self.hold(&before, n);
        Ok(outcome)
    }

    fn hold(&mut self, before: &SMatrix<f64, N, N>, n: usize) {
        if let Some(cap) = &self.cap {
            cap::hold(&mut self.p, before, cap, n);
        }
    }
}

/// P := S P S with S diagonal.
fn scale_by<const N: usize>(p: &mut SMatrix<f64, N, N>, s: &[f64; N], n: usize) {
    if s[..n].iter().all(|s| *s == 1.0) {
        return;
    }
    for i in 0..n {
        for j in 0..=i {
            let value = p.data.0[i][j] * (s[i] * s[j]);
            (p.data.0[i][j], p.data.0[j][i]) = (value, value);
        }
    }
}

/// P := factor P.
fn inflate<const N: usize>(p: &mut SMatrix<f64, N, N>, factor: f64, n: usize) {
    if factor != 1.0 {
        for row in &mut p.data.0[..n] {
            row[..n].iter_mut().for_each(|p| *p *= factor);
        }
    }
}
