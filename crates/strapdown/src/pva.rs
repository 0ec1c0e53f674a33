//! Position, velocity and attitude.

use schuler_frames::{B, Geodetic, Rot, T, Vec3, phi_between, position_error};

/// Position, velocity and attitude at one time: what a navigator knows and what is true.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pva {
    /// Geodetic latitude, longitude (rad) and ellipsoidal height (m).
    pub position: Geodetic,
    /// Velocity relative to the Earth, resolved in t, m/s.
    pub v_t: Vec3<T>,
    /// Attitude, body to local level.
    pub c_tb: Rot<T, B>,
}

/// Navigation errors, computed minus true.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NavError {
    /// Position error north, east, down, m, by the radii at the true position.
    pub dr: Vec3<T>,
    /// Velocity error north, east, down, m/s.
    pub dv: Vec3<T>,
    /// Attitude error phi, rad: `C_computed = exp(-[phi ×]) C_true`.
    pub phi: Vec3<T>,
}

impl NavError {
    /// The error of `computed` against `truth`.
    pub fn between(computed: &Pva, truth: &Pva) -> Self {
        NavError {
            dr: position_error(computed.position, truth.position),
            dv: computed.v_t - truth.v_t,
            phi: phi_between(computed.c_tb, truth.c_tb),
        }
    }

    /// The nine errors in the order dr, dv, phi.
    pub fn as_array(&self) -> [f64; 9] {
        let ([a, b, c], [d, e, f]) = (self.dr.as_array(), self.dv.as_array());
        let [g, h, i] = self.phi.as_array();
        [a, b, c, d, e, f, g, h, i]
    }
}
