//! At rest on the Earth.

use schuler_frames::{Euler, Geodetic, Rot};

use super::{Kinematics, Place, Stance, Trajectory};

/// At rest on the Earth.
#[derive(Clone, Debug, PartialEq)]
pub struct Still(Kinematics);

impl Still {
    /// At `position` with the attitude `attitude`.
    pub fn new(position: Geodetic, attitude: Euler) -> Self {
        Still(Kinematics::new(Place::still(position), Stance::still(Rot::from_euler(attitude))))
    }
}

impl Trajectory for Still {
    fn at(&self, _: f64) -> Kinematics {
        self.0
    }

    fn fastest(&self, _: f64) -> f64 {
        0.0
    }
}
