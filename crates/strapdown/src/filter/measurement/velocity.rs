//! Velocity relative to the Earth.

use nalgebra::Matrix3;
use schuler_frames::{B, T, Vec3};

use super::{ALL, Axes, Measurement, earth_rate, earth_rate_slope};
use crate::filter::{Now, Observation};

/// Velocity of a point of the body relative to the Earth, resolved in t.
///
/// The navigator computes it as `v + C (omega_ib × l) - omega_ie × (C l)`, so that
///
/// ```text
/// z = dv + ([(C (omega_ib × l)) ×] - [omega_ie ×] [(C l) ×]) phi + [(C l) ×] (d omega_ie/dr) dr - C [l ×] eps
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Velocity {
    /// What was measured, m/s.
    pub v_t: Vec3<T>,
    /// Standard deviation of its noise per axis, m/s.
    pub sigma: [f64; 3],
    /// Where in the body the point is, m.
    pub lever: Vec3<B>,
    /// Axes that are used.
    pub axes: Axes,
}

impl Measurement for Velocity {
    fn observe(&self, now: &Now) -> Observation {
        let c_tb = now.pva.c_tb.as_dcm();
        let (lever, omega_ie) = (c_tb * self.lever, earth_rate(now));
        let swing = c_tb * now.omega_ib_b().cross(self.lever);
        let computed = now.pva.v_t + swing - omega_ie.cross(lever);
        Observation::new(3, (computed - self.v_t).as_array(), self.sigma)
            .with_block(0, lever.skew() * earth_rate_slope(now))
            .with_block(3, Matrix3::identity())
            .with_block(6, swing.skew() - omega_ie.skew() * lever.skew())
            .with_gyro(-c_tb.as_nalgebra() * self.lever.skew())
            .select(self.axes)
    }
}

/// The body stands still: velocity relative to the Earth is zero, `z = v = dv`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroVelocity {
    /// Standard deviation of the true velocity about zero per axis, m/s.
    pub sigma: f64,
    /// Axes that are used.
    pub axes: Axes,
}

impl ZeroVelocity {
    /// All three axes, with the same `sigma` (m/s).
    pub const fn new(sigma: f64) -> Self {
        ZeroVelocity { sigma, axes: ALL }
    }
}

impl Measurement for ZeroVelocity {
    fn observe(&self, now: &Now) -> Observation {
        let still = Velocity { v_t: Vec3::ZERO, sigma: [self.sigma; 3], lever: Vec3::ZERO, axes: self.axes };
        still.observe(now)
    }
}
