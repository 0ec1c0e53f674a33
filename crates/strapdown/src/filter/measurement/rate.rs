//! A body that does not turn.

use nalgebra::Matrix3;

use super::{ALL, Axes, Measurement, earth_rate, earth_rate_slope};
use crate::filter::{Now, Observation};

/// The body does not turn against the Earth: the gyros see the Earth rate alone. Along body axes, with
/// `z = omega_ib - C' omega_ie`,
///
/// ```text
/// z = C' [omega_ie ×] phi - C' (d omega_ie/dr) dr + eps
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroRate {
    /// Standard deviation of noise and of what turning there is, per axis, rad/s.
    pub sigma: f64,
    /// Axes that are used.
    pub axes: Axes,
}

impl ZeroRate {
    /// All three axes.
    pub const fn new(sigma: f64) -> Self {
        ZeroRate { sigma, axes: ALL }
    }
}

impl Measurement for ZeroRate {
    fn observe(&self, now: &Now) -> Observation {
        let c_bt = now.pva.c_tb.inverse().as_dcm();
        let omega_ie = earth_rate(now);
        let z = now.omega_ib_b() - c_bt * omega_ie;
        let c_bt = c_bt.as_nalgebra();
        Observation::new(3, z.as_array(), [self.sigma; 3])
            .with_block(0, -c_bt * earth_rate_slope(now))
            .with_block(6, c_bt * omega_ie.skew())
            .with_gyro(Matrix3::identity())
            .select(self.axes)
    }
}
