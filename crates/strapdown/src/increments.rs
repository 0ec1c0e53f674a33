//! What an inertial measurement unit delivers.

use schuler_frames::{B, Vec3};

/// Integrals over one sample interval, in the rotating body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increments<S = f64> {
    /// Integral of the angular rate omega_ib^b, rad (not the rotation vector: coning is not yet mended).
    pub dtheta: Vec3<B, S>,
    /// Integral of the specific force f^b, m/s.
    pub dv: Vec3<B, S>,
}
