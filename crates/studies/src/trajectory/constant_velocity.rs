//! Always the same velocity north, east and down.

use schuler_frames::{Euler, Geodetic, Rot, T, Vec3};

use super::{Impossible, Kinematics, Place, Stance, Track, Trajectory};

/// A flight with constant velocity north, east and down and constant attitude: along a rhumb line.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantVelocity {
    track: Track,
    v_t: Vec3<T>,
    stance: Stance,
}

impl ConstantVelocity {
    /// From `position` with `attitude` at `v_t` (m/s), for `duration` (s) or a little longer.
    ///
    /// # Errors
    /// Faster than anything, or it comes to a pole.
    pub fn new(position: Geodetic, attitude: Euler, v_t: Vec3<T>, duration: f64) -> Result<Self, Impossible> {
        Impossible::speed(v_t.norm())?;
        let track = Track::new(position, &[0.0, duration], |_| v_t)?;
        Ok(ConstantVelocity { track, v_t, stance: Stance::still(Rot::from_euler(attitude)) })
    }
}

impl Trajectory for ConstantVelocity {
    fn at(&self, t: f64) -> Kinematics {
        Kinematics::new(Place::from_velocity(self.track.at(t), self.v_t, Vec3::ZERO), self.stance)
    }

    fn fastest(&self, _: f64) -> f64 {
        // The local level turns by 2e-3 rad/s at most, at escape velocity.
        self.v_t.norm() * 2e-7
    }
}
