//! Attitude and heading.

use core::f64::consts::{PI, TAU};

use nalgebra::Matrix3;
use schuler_frames::{B, Rot, T, phi_between};

use super::{ALL, Axes, Measurement};
use crate::filter::{Now, Observation};

/// The whole attitude: `z = phi` of the computed attitude against the measured one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude {
    /// What was measured.
    pub c_tb: Rot<T, B>,
    /// Standard deviation of its noise about north, east and down, rad.
    pub sigma: [f64; 3],
    /// Axes that are used.
    pub axes: Axes,
}

impl Attitude {
    /// All three axes.
    pub const fn new(c_tb: Rot<T, B>, sigma: [f64; 3]) -> Self {
        Attitude { c_tb, sigma, axes: ALL }
    }
}

impl Measurement for Attitude {
    fn observe(&self, now: &Now) -> Observation {
        Observation::new(3, phi_between(now.pva.c_tb, self.c_tb).as_array(), self.sigma)
            .with_block(6, Matrix3::identity())
            .select(self.axes)
    }
}

/// Heading, clockwise from north. With yaw y and pitch p,
///
/// ```text
/// z = dy = -phi_D - tan p (cos y phi_N + sin y phi_E)
/// ```
///
/// Not for a nose near the vertical, where heading means nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading {
    /// What was measured, rad.
    pub yaw: f64,
    /// Standard deviation of its noise, rad.
    pub sigma: f64,
}

impl Measurement for Heading {
    fn observe(&self, now: &Now) -> Observation {
        let [row_n, row_e, row_d] = now.pva.c_tb.as_dcm().as_rows();
        // The x axis of the body in t is (cos p cos y, cos p sin y, -sin p).
        let (north, east, down) = (row_n[0], row_e[0], row_d[0]);
        let level = north * north + east * east;
        let turn = libm::atan2(east, north) - self.yaw;
        let z = turn - TAU * libm::floor((turn + PI) / TAU);
        let mut h = Matrix3::zeros();
        // tan p cos y = -down north / level, tan p sin y = -down east / level
        h[(0, 0)] = down * north / level;
        h[(0, 1)] = down * east / level;
        h[(0, 2)] = -1.0;
        Observation::new(1, [z, 0.0, 0.0], [self.sigma; 3]).with_block(6, h)
    }
}
