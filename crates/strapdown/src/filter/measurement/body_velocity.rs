//! A body that moves only along its own forward axis.

use schuler_frames::{B, Vec3};

use super::{Measurement, earth_rate, earth_rate_slope};
use crate::filter::{Now, Observation};

/// A wheeled vehicle neither slips sideways nor jumps: velocity of the point `lever` relative to the Earth has no part
/// along y and z of the body. With `v_b = C' v + (omega_ib - C' omega_ie) × l`,
///
/// ```text
/// z = rows y, z of  C' dv + (-C' [v ×] - [l ×] C' [omega_ie ×]) phi + [l ×] C' (d omega_ie/dr) dr - [l ×] eps
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NonHolonomic {
    /// Standard deviation of the velocity along y and z, m/s.
    pub sigma: [f64; 2],
    /// Where in the body the point is that does not slip (amid the rear axle), m.
    pub lever: Vec3<B>,
}

impl Measurement for NonHolonomic {
    fn observe(&self, now: &Now) -> Observation {
        let c_bt = now.pva.c_tb.inverse().as_dcm();
        let omega_ie = earth_rate(now);
        let omega_eb = now.omega_ib_b() - c_bt * omega_ie;
        let v_b = c_bt * now.pva.v_t + omega_eb.cross(self.lever);
        let (c_bt, lever) = (c_bt.as_nalgebra(), self.lever.skew());
        let [y, z] = self.sigma;
        Observation::new(3, v_b.as_array(), [0.0, y, z])
            .with_block(0, lever * c_bt * earth_rate_slope(now))
            .with_block(3, c_bt)
            .with_block(6, -c_bt * now.pva.v_t.skew() - lever * c_bt * omega_ie.skew())
            .with_gyro(-lever)
            .select([false, true, true])
    }
}
