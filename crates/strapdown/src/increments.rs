//! What an inertial measurement unit delivers.

use schuler_frames::{B, Real, Vec3};

/// Integrals over one sample interval, in the rotating body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increments<S = f64> {
    /// Integral of the angular rate omega_ib^b, rad (not the rotation vector: coning is not yet mended).
    pub dtheta: Vec3<B, S>,
    /// Integral of the specific force f^b, m/s.
    pub dv: Vec3<B, S>,
}

impl<S: Real> Increments<S> {
    /// Velocity increment turned back to the body axes at the start of the interval: `dv` plus the
    /// rotation term `dtheta × dv / 2` and the next one of the series, `dtheta × (dtheta × dv) / 6`,
    /// exact to third order where rate and force are constant over the interval.
    #[inline(always)]
    pub(crate) fn dv_at_start(&self) -> Vec3<B, S> {
        let turn = self.dtheta.cross(self.dv);
        let second = self.dtheta.cross(turn);
        self.dv + turn.scaled(0.5) + second.scaled(1.0 / 6.0)
    }
}
