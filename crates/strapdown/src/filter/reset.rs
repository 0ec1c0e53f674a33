//! Closing the loop: estimated errors are taken out of the navigator and the sensors.

use nalgebra::{Matrix3, SMatrix};
use schuler_frames::{Rot, T, Vec3, position_error, with_position_error};

use super::{Filter, Form};
use crate::{NavError, Pva};

/// Left Jacobian of the rotations at `phi` (rad): J = I + (1 - cos a)/a² [phi ×] + (a - sin a)/a³ [phi ×]², a = |phi|.
///
/// An attitude error phi + delta out of which phi is taken leaves, to first order in delta, the error J delta.
pub fn attitude_reset(phi: Vec3<T>) -> Matrix3<f64> {
    let square = phi.norm_squared();
    let (first, second) = if square < 1e-4 {
        // What is left out is below 1e-17.
        (
            0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)),
            1.0 / 6.0 - square / 120.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)),
        )
    } else {
        let a = libm::sqrt(square);
        let (s, c) = libm::sincos(a);
        ((1.0 - c) / square, (a - s) / (square * a))
    };
    let skew = phi.skew();
    Matrix3::identity() + skew * first + skew * skew * second
}

/// `computed` with the error `error` taken out: the state whose error it is.
///
/// ```text
/// C := exp([phi ×]) C,   v := v - dv,   position so that that of `computed` is dr away by the radii there
/// ```
pub fn corrected(computed: &Pva, error: &NavError) -> Pva {
    // The radii of the definition are those of the result: found in three rounds, each better by dr/R.
    let mut position = computed.position;
    for _ in 0..3 {
        let left = error.dr - position_error(computed.position, position);
        position = with_position_error(position, -left);
    }
    Pva {
        position,
        v_t: computed.v_t - error.dv,
        c_tb: (Rot::<T, T>::from_rotation_vector(error.phi) * computed.c_tb).normalized(),
    }
}

impl<const N: usize> Filter<N> {
    /// The estimated navigation errors in phi form, those left out as zero, for a navigator at `pva`.
    pub fn nav_error(&self, pva: &Pva) -> NavError {
        let mut x = nalgebra::SVector::<f64, 9>::zeros();
        for (k, &full) in self.model.full().iter().enumerate() {
            x[full] = self.x[k];
        }
        let x = self.model.form().to_phi(pva) * x;
        NavError {
            dr: Vec3::new(x[0], x[1], x[2]),
            dv: Vec3::new(x[3], x[4], x[5]),
            phi: Vec3::new(x[6], x[7], x[8]),
        }
    }

    /// Closes the loop: returns `pva` with the estimated errors taken out, with which the navigator goes on, and moves
    /// the estimates of the sources to [`Filter::taken_out`], by which the sensors are corrected from now on
    /// ([`Filter::sensor_error`]). The x of all these is zero then.
    ///
    /// The covariance is carried to the errors that are left: attitude by [`attitude_reset`] at the estimate, to all
    /// orders in it; velocity and sources do not change. That a position error is counted by the radii of another
    /// place then (dr/R of it) is left out.
    pub fn feedback(&mut self, pva: &Pva) -> Pva {
        let error = self.nav_error(pva);
        let out = corrected(pva, &error);
        let mut jacobian = SMatrix::<f64, 9, 9>::identity();
        jacobian.fixed_view_mut::<3, 3>(6, 6).copy_from(&attitude_reset(error.phi));
        if self.model.form() == Form::Psi {
            jacobian = Form::Psi.from_phi(&out) * jacobian * Form::Psi.to_phi(pva);
        }
        self.turn(&jacobian);
        let nav = self.model.nav_len();
        self.x.as_mut_slice()[..nav].fill(0.0);
        for block in self.model.blocks().filter(|b| b.instrument().is_some()) {
            for state in block.states() {
                self.taken_out[state] += self.x[state];
                self.x[state] = 0.0;
            }
        }
        out
    }

    /// P := G P G' with `jacobian` for the navigation errors and the identity for all other states.
    fn turn(&mut self, jacobian: &SMatrix<f64, 9, 9>) {
        let (n, full) = (self.model.len(), self.model.full());
        let m = full.len();
        let old = self.p.data.0;
        let p = &mut self.p.data.0;
        let mut w = [[0.0; N]; 9];
        for i in 0..m {
            for k in 0..m {
                let g = jacobian[(full[i], full[k])];
                for j in 0..n {
                    w[i][j] += g * old[k][j];
                }
            }
        }
        for i in 0..m {
            for j in 0..=i {
                let value = (0..m).map(|k| w[i][k] * jacobian[(full[j], full[k])]).sum();
                (p[i][j], p[j][i]) = (value, value);
            }
            for j in m..n {
                (p[i][j], p[j][i]) = (w[i][j], w[i][j]);
            }
        }
    }
}
