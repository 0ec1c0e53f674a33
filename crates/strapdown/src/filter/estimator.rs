//! The filter itself.

use nalgebra::{SMatrix, SVector};
use schuler_imu::{Instrument, Truth};

use super::observation::{Now, Observation};
use super::scalar_update::{joseph, seen, update};
use super::small::{Ldl, nees};
use super::{FilterError, Gate, Measurement, Model, Propagation, Row};

/// An error-state Kalman filter with room for `N` states.
///
/// `x` estimates errors that have **not yet been taken out**: computed minus true of the navigator, and of each sensor
/// error what [`Filter::feedback`] has not yet moved to [`Filter::taken_out`]. Without feedback it is an open-loop filter beside a
/// navigator that is left alone; with it after every update, x is zero between updates.
///
/// A cycle is [`Filter::propagate`] by what [`Propagation::exact`] or an [`Accumulator`](super::Accumulator) gives,
/// [`Filter::update`] with what was measured, and [`Filter::feedback`].
#[derive(Clone, Debug, PartialEq)]
pub struct Filter<const N: usize> {
    pub(crate) model: Model<N>,
    /// Estimate of the errors.
    pub x: SVector<f64, N>,
    /// Its covariance, symmetric; rows and columns beyond the states in use are zero.
    pub p: SMatrix<f64, N, N>,
    /// Estimates of source states that have been moved to the sensors' correction.
    pub(crate) taken_out: SVector<f64, N>,
    /// When a measurement is refused.
    pub gate: Gate,
    /// Variances of the prior beyond which no [`Strategy`](super::strategy::Strategy) may inflate `p`: with D of these on its
    /// diagonal, D^-½ P D^-½ is kept from eigenvalues above one, or above what `p` had in that direction before. At the
    /// start the filter's own; `None` for no cap. Where the filter's prior is itself too small, fading within it cannot help, and
    /// the cap has to be one that is believed.
    pub cap: Option<[f64; N]>,
    tally: Tally,
}

/// What an update did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Number of rows.
    pub len: usize,
    /// Innovations `z - h x`, before the update.
    pub innovation: [f64; 3],
    /// Their predicted covariance `S = H P H' + R`.
    pub s: [[f64; 3]; 3],
    /// Normalized innovation squared, `nu' S⁻¹ nu`: chi-square with `len` degrees of freedom if the filter is consistent.
    pub nis: f64,
    /// Rows that the gate let pass.
    pub accepted: [bool; 3],
}

/// Sums over all updates since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Rows offered.
    pub rows: u64,
    /// Rows refused by the gate.
    pub refused: u64,
    /// Sum of the normalized innovations squared of all updates, refused ones included: chi-square with `rows` degrees of
    /// freedom if the filter is consistent.
    pub nis: f64,
}

impl<const N: usize> Filter<N> {
    /// A filter over `model` whose navigation errors start with the standard deviations `nav_sigma` (m, m/s, rad; those of
    /// errors left out are not looked at), the sources as they say.
    ///
    /// # Errors
    /// [`FilterError::Sigma`] for a deviation that is negative or not finite.
    pub fn new(model: Model<N>, nav_sigma: &[f64; 9]) -> Result<Self, FilterError> {
        let (x, p) = (model.x0(), model.p0(nav_sigma)?);
        Ok(Filter {
            model,
            x,
            p,
            taken_out: SVector::zeros(),
            gate: Gate::Off,
            cap: Some(core::array::from_fn(|k| p[(k, k)])),
            tally: Tally::default(),
        })
    }

    /// What the states are.
    pub fn model(&self) -> &Model<N> {
        &self.model
    }

    /// Standard deviation of state `k`.
    pub fn sigma(&self, k: usize) -> f64 {
        libm::sqrt(self.p[(k, k)])
    }

    /// Estimates of the source states that have been moved to the sensors' correction; other states are zero.
    pub fn taken_out(&self) -> &SVector<f64, N> {
        &self.taken_out
    }

    /// Whole estimates of the source states: taken out and not yet taken out. Navigation errors are those of `x`.
    pub fn estimate(&self) -> SVector<f64, N> {
        self.x + self.taken_out
    }

    /// Error of `instrument` along body axes by the estimates taken out, under what it has `seen` over `dt` (s): to be
    /// subtracted from what it measures.
    pub fn sensor_error(&self, instrument: Instrument, seen: &Truth, dt: f64) -> [f64; 3] {
        self.model.sensor_error(instrument, &self.taken_out, seen, dt)
    }

    /// Sums of what the updates found.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Time update: x := Phi x, P := Phi P Phi' + Q.
    pub fn propagate(&mut self, step: &Propagation<N>) {
        self.carry(step);
        step.apply(&mut self.p);
    }

    /// The part of the time update that moves the estimates: x := Phi x.
    pub(crate) fn carry(&mut self, step: &Propagation<N>) {
        step.carry(&mut self.x);
        // What was taken out goes on by itself and drives nothing.
        let nav = self.model.nav_len();
        step.carry(&mut self.taken_out);
        self.taken_out.as_mut_slice()[..nav].fill(0.0);
    }

    /// Measurement update, one row after the other in Joseph form; correlated rows are decorrelated first.
    ///
    /// # Errors
    /// As [`Filter::update_with`].
    pub fn update(&mut self, measurement: &dyn Measurement, now: &Now) -> Result<Outcome, FilterError> {
        self.update_with(&measurement.observe(now), now)
    }

    /// Measurement update with an observation that is at hand.
    ///
    /// # Errors
    /// [`FilterError::NotFinite`], [`FilterError::Noise`] or [`FilterError::NoState`] for an observation that makes no sense,
    /// [`FilterError::Covariance`] if the filter's own covariance does not. The filter is then as it was.
    pub fn update_with(&mut self, observation: &Observation, now: &Now) -> Result<Outcome, FilterError> {
        let rows = self.rows(observation, now)?;
        self.update_rows(&rows[..observation.len], observation.z, &observation.r)
    }

    pub(crate) fn rows(&self, observation: &Observation, now: &Now) -> Result<[Row<N>; 3], FilterError> {
        let n = self.model.len();
        match observation.extra.iter().flatten().find(|(state, _)| *state >= n) {
            Some(&(state, _)) => Err(FilterError::NoState { state, n }),
            None => Ok(observation.rows(&self.model, now)),
        }
    }

    /// Innovations of `rows` and their predicted covariance without R.
    pub(crate) fn predict(&self, rows: &[Row<N>], z: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let (mut innovation, mut hph) = ([0.0; 3], [[0.0; 3]; 3]);
        for (i, row) in rows.iter().enumerate() {
            innovation[i] = z[i] - row.dot(self.x.as_slice());
            let (b, _) = seen(&self.p, row, self.model.len());
            for (j, other) in rows.iter().enumerate() {
                hph[i][j] = other.dot(&b);
            }
        }
        (innovation, hph)
    }

    /// Update with at most three rows at hand, `z = rows x + v`, v of covariance `r`.
    ///
    /// # Errors
    /// As [`Filter::update_with`].
    pub fn update_rows(
        &mut self,
        rows: &[Row<N>],
        z: [f64; 3],
        r: &[[f64; 3]; 3],
    ) -> Result<Outcome, FilterError> {
        let rows = &rows[..rows.len().min(3)];
        let len = rows.len();
        let finite = |i: usize| {
            z[i].is_finite()
                && rows[i].pairs().all(|(_, h)| h.is_finite())
                && r[i][..len].iter().all(|r| r.is_finite())
        };
        if let Some(row) = (0..len).find(|&i| !finite(i)) {
            return Err(FilterError::NotFinite { row });
        }
        let noise = Ldl::new(r, len).map_err(|(row, pivot)| FilterError::Noise { row, pivot })?;
        let (innovation, mut s) = self.predict(rows, z);
        for i in 0..len {
            for j in 0..len {
                s[i][j] += r[i][j];
            }
        }
        let factored = Ldl::new(&s, len).map_err(|(_, variance)| FilterError::Covariance { variance })?;
        let nis = factored.quadratic(innovation, len);
        let accepted = self.gate.judge(innovation, &s, nis, len);
        let refused = accepted[..len].iter().filter(|a| !**a).count();
        self.tally.rows += len as u64;
        self.tally.refused += refused as u64;
        self.tally.nis += nis;

        if refused < len {
            if noise.is_diagonal(len) || refused > 0 {
                // A scalar gate refuses rows only where they are independent.
                for i in (0..len).filter(|&i| accepted[i]) {
                    self.update_scalar(&rows[i], z[i], r[i][i])?;
                }
            } else {
                // R = L D L': the rows of L⁻¹ z are independent.
                let mut free: [Row<N>; 3] = [Row::default(); 3];
                let mut free_z = z;
                for i in 0..len {
                    free[i] = rows[i];
                    for j in 0..i {
                        let l = noise.l[i][j];
                        let earlier = free[j];
                        free[i].add_row(-l, &earlier);
                        free_z[i] -= l * free_z[j];
                    }
                    self.update_scalar(&free[i], free_z[i], noise.d[i])?;
                }
            }
        }
        Ok(Outcome { len, innovation, s, nis, accepted })
    }

    /// One scalar measurement `z = row x + v`, v of variance `r`, in Joseph form, without gate: its innovation and the
    /// predicted variance of that.
    ///
    /// # Errors
    /// [`FilterError::Covariance`] where that variance is not positive; the filter is then as it was.
    pub fn update_scalar(&mut self, row: &Row<N>, z: f64, r: f64) -> Result<(f64, f64), FilterError> {
        let n = self.model.len();
        update(&mut self.x, &mut self.p, row, z, r, n)
    }

    /// Update of the covariance alone by a scalar measurement with any gain: Joseph form.
    pub fn joseph(&mut self, row: &Row<N>, gain: &[f64; N], r: f64) {
        let n = self.model.len();
        let (b, variance) = seen(&self.p, row, n);
        joseph(&mut self.p, gain, &b, variance, r, n);
    }

    /// Normalized estimation error squared of the states `states` against their `truth` (true value of what `x` estimates,
    /// in that order): chi-square with as many degrees of freedom if the filter is consistent. `None` where their covariance
    /// is singular.
    pub fn nees(&self, states: &[usize], truth: &[f64]) -> Option<f64> {
        nees(&self.x, &self.p, states, truth)
    }
}
