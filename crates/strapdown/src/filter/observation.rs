//! What one measurement says, before any filter has seen it.

use nalgebra::Matrix3;
use schuler_frames::{B, Vec3};
use schuler_imu::{Input, Instrument, Truth};

use super::{FilterError, Form, Model, Row};
use crate::Pva;

/// Most states beside navigation errors and sensor errors that a measurement may depend on.
pub const MAX_EXTRA: usize = 6;

/// Where the navigator is when a measurement is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Now {
    /// What the navigator has computed.
    pub pva: Pva,
    /// What the sensors see, freed of what is known of their errors; lever arms need the rate.
    pub seen: Truth,
    /// Length of the interval of `seen` (s), where that holds increments.
    pub dt: f64,
}

impl Now {
    /// From angular rate omega_ib^b (rad/s) and specific force (m/s²).
    pub fn new(pva: &Pva, omega_ib_b: Vec3<B>, f_b: Vec3<B>) -> Self {
        Now { pva: *pva, seen: Truth::rates(omega_ib_b.as_array(), f_b.as_array()), dt: 1.0 }
    }

    /// Where no sensor is asked.
    pub fn at(pva: &Pva) -> Self {
        Now::new(pva, Vec3::ZERO, Vec3::ZERO)
    }

    /// Angular rate omega_ib^b, rad/s.
    pub fn omega_ib_b(&self) -> Vec3<B> {
        Vec3::claim(Input::new(Instrument::Gyro, &self.seen, self.dt, Truth::TEMPERATURE).omega)
    }
}

/// A measurement as a filter takes it, up to three rows: `z = computed - measured`, which is, to first order,
///
/// ```text
/// z = h_nav x + h_gyro eps_b + extra + v,   v of covariance r
/// ```
///
/// x are the nine navigation errors in **phi form** (the filter maps them to its own), eps_b is the error of the gyro
/// along body axes (rad/s), both computed or measured minus true.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Number of rows in use.
    pub len: usize,
    /// Computed minus measured.
    pub z: [f64; 3],
    /// Sensitivity to the nine navigation errors.
    pub h_nav: [[f64; 9]; 3],
    /// Sensitivity to the gyro error along body axes, per rad/s.
    pub h_gyro: [[f64; 3]; 3],
    /// Sensitivity to further states of the filter: their number and the column.
    pub extra: [Option<(usize, [f64; 3])>; MAX_EXTRA],
    /// Covariance of the noise.
    pub r: [[f64; 3]; 3],
}

impl Observation {
    /// `len` rows (at most three), `z`, and independent noise of standard deviation `sigma`.
    pub fn new(len: usize, z: [f64; 3], sigma: [f64; 3]) -> Self {
        let mut r = [[0.0; 3]; 3];
        for k in 0..3 {
            r[k][k] = sigma[k] * sigma[k];
        }
        Observation {
            len: len.min(3),
            z,
            h_nav: [[0.0; 9]; 3],
            h_gyro: [[0.0; 3]; 3],
            extra: [None; MAX_EXTRA],
            r,
        }
    }

    /// With the 3 × 3 block `h` as sensitivity to the errors that begin at number `first` (0 position, 3 velocity,
    /// 6 attitude).
    pub fn with_block(mut self, first: usize, h: Matrix3<f64>) -> Self {
        for row in 0..3 {
            for column in 0..3 {
                self.h_nav[row][first + column] = h[(row, column)];
            }
        }
        self
    }

    /// With the sensitivity `h` to the gyro error along body axes.
    pub fn with_gyro(mut self, h: Matrix3<f64>) -> Self {
        for row in 0..3 {
            for column in 0..3 {
                self.h_gyro[row][column] = h[(row, column)];
            }
        }
        self
    }

    /// With the sensitivity `column` to state number `state` of the filter, one that [`Model::add_extra`] made.
    ///
    /// # Errors
    /// [`FilterError::Capacity`] with more than [`MAX_EXTRA`] of them.
    pub fn with_extra(mut self, state: usize, column: [f64; 3]) -> Result<Self, FilterError> {
        let slot = self
            .extra
            .iter_mut()
            .find(|slot| slot.is_none())
            .ok_or(FilterError::Capacity { need: MAX_EXTRA + 1, capacity: MAX_EXTRA })?;
        *slot = Some((state, column));
        Ok(self)
    }

    /// Only the rows that `wanted` says.
    pub fn select(&self, wanted: [bool; 3]) -> Self {
        let mut out = *self;
        out.len = 0;
        let mut kept = [0; 3];
        for row in (0..self.len).filter(|&row| wanted[row]) {
            kept[out.len] = row;
            out.len += 1;
        }
        for (to, &from) in kept[..out.len].iter().enumerate() {
            out.z[to] = self.z[from];
            out.h_nav[to] = self.h_nav[from];
            out.h_gyro[to] = self.h_gyro[from];
            for (extra, old) in out.extra.iter_mut().zip(&self.extra) {
                if let (Some((_, column)), Some((_, old))) = (extra, old) {
                    column[to] = old[from];
                }
            }
            for (to_column, &from_column) in kept[..out.len].iter().enumerate() {
                out.r[to][to_column] = self.r[from][from_column];
            }
        }
        out
    }

    /// The rows in the states of `model`.
    pub fn rows<const N: usize>(&self, model: &Model<N>, now: &Now) -> [Row<N>; 3] {
        let to_phi = match model.form() {
            Form::Phi => None,
            Form::Psi => Some(Form::Psi.to_phi(&now.pva)),
        };
        let inputs = model.inputs(&now.seen, now.dt);
        core::array::from_fn(|i| {
            let mut row = Row::default();
            if i >= self.len {
                return row;
            }
            for (k, &full) in model.full().iter().enumerate() {
                let h = match &to_phi {
                    None => self.h_nav[i][full],
                    Some(map) => (0..9).map(|j| self.h_nav[i][j] * map[(j, full)]).sum(),
                };
                row.add(k, h);
            }
            if self.h_gyro[i] != [0.0; 3] {
                let gyro = |b: &&super::block::Block| b.instrument() == Some(Instrument::Gyro) && b.len > 0;
                for block in model.blocks().filter(gyro) {
                    let column = block.column(&inputs);
                    let h: f64 = self.h_gyro[i].iter().zip(column).map(|(h, c)| h * c).sum();
                    for (state, c) in block.states().zip(block.c) {
                        row.add(state, h * c);
                    }
                }
            }
            for (state, column) in self.extra.iter().flatten() {
                row.add(*state, column[i]);
            }
            row
        })
    }
}
