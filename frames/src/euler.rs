//! Euler angles yaw, pitch, roll (ZYX).

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::{Frame, Rot};

/// Euler angles in the aerospace order ZYX, rad: from frame `To`, turn by yaw about z (down), then by
/// pitch about the new y, then by roll about the new x; the result is frame `From` of a
/// [`Rot<To, From>`](Rot), so C_b^t = R_z(yaw) R_y(pitch) R_x(roll). Yaw of `c_tb` is heading, clockwise from north.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Euler {
    /// About the forward axis, right wing down positive, rad.
    pub roll: f64,
    /// About the right axis, nose up positive, rad.
    pub pitch: f64,
    /// About the down axis, clockwise from north seen from above, rad.
    pub yaw: f64,
}

impl Euler {
    /// From roll, pitch and yaw, rad.
    pub const fn new(roll: f64, pitch: f64, yaw: f64) -> Self {
        Euler { roll, pitch, yaw }
    }
}

impl<To: Frame, From: Frame> Rot<To, From> {
    /// From Euler angles of any size.
    pub fn from_euler(angles: Euler) -> Self {
        let (sr, cr) = libm::sincos(0.5 * angles.roll);
        let (sp, cp) = libm::sincos(0.5 * angles.pitch);
        let (sy, cy) = libm::sincos(0.5 * angles.yaw);
        Self::claim([
            cy * cp * cr + sy * sp * sr,
            cy * cp * sr - sy * sp * cr,
            cy * sp * cr + sy * cp * sr,
            sy * cp * cr - cy * sp * sr,
        ])
    }

    /// Euler angles with roll and yaw within ±π and pitch within ±π/2.
    ///
    /// Gimbal lock: at pitch ±π/2 only yaw ∓ roll is defined. There (within rounding, 1e-15 rad) roll is
    /// given as 0 and yaw takes all. Near it roll and yaw are each ill-conditioned (errors of
    /// 1e-16 / cos pitch), while [`Rot::from_euler`] of the three still returns the rotation to rounding.
    pub fn as_euler(self) -> Euler {
        let [w, x, y, z] = self.as_quaternion();
        // (w - y, x + z) is √2 sin(π/4 - pitch/2) times cosine and sine of (yaw + roll) / 2;
        // (w + y, z - x) is √2 cos(π/4 - pitch/2) times those of (yaw - roll) / 2.
        // So pitch has its full precision also near ±π/2, which an arc sine of c_31 has not.
        let (up, down) = (libm::hypot(w - y, x + z), libm::hypot(w + y, z - x));
        let half_sum = libm::atan2(x + z, w - y);
        let half_difference = libm::atan2(z - x, w + y);
        const LOCK: f64 = 4.0 * f64::EPSILON;
        let (half_sum, half_difference) = if up < LOCK {
            (half_difference, half_difference)
        } else if down < LOCK {
            (half_sum, half_sum)
        } else {
            (half_sum, half_difference)
        };
        Euler {
            roll: wrap(half_sum - half_difference),
            pitch: FRAC_PI_2 - 2.0 * libm::atan2(up, down),
            yaw: wrap(half_sum + half_difference),
        }
    }
}

/// An angle within ±2π brought to within ±π.
fn wrap(angle: f64) -> f64 {
    if angle > PI {
        angle - TAU
    } else if angle < -PI {
        angle + TAU
    } else {
        angle
    }
}
