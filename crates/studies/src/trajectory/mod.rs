//! True motion: trajectories as exact functions of time, and what a perfect IMU delivers along them.
//!
//! A [`Trajectory`] says where a body is, how it moves and how it turns against the Earth at any time. [`Truth`] joins it with
//! a gravity field: specific force and angular rate against inertial space follow ([`Moment`]), and their
//! integrals over any interval ([`Truth::increments`]), by quadrature to rounding and never by differences of samples.
//!
//! ```
//! use schuler_frames::{Euler, Geodetic, Gravity};
//! use schuler_studies::trajectory::{Sine, Sway, SwayAxes, Truth};
//!
//! // A ship at its moorings rolls by 2 deg with a period of 8 s.
//! let roll = Sine { amplitude: 2f64.to_radians(), omega: std::f64::consts::TAU / 8.0, phase: 0.0 };
//! let place = Geodetic::new(45f64.to_radians(), 0.0, 0.0);
//! let axes = SwayAxes { roll: vec![roll], ..SwayAxes::default() };
//! let ship = Truth::new(Sway::new(place, Euler::default(), axes), Gravity::Normal);
//!
//! let increments = ship.increments(2.0, 0.01); // from 2 s to 2.01 s
//! assert!((increments.dv.norm() / 0.01 - 9.806).abs() < 1e-3);
//! let moment = ship.moment(2.0); // a quarter of the period: rolled by 2 deg
//! assert!((moment.pva.c_tb.as_euler().roll - 2f64.to_radians()).abs() < 1e-15);
//! ```

mod coning;
mod constant_velocity;
mod great_circle;
mod impossible;
mod jet;
mod kinematics;
mod positions;
mod quadrature;
mod rate_table;
mod rates;
mod recorded;
mod route;
mod segments;
mod shaken;
mod smooth;
mod spline;
mod still;
mod sway;
#[cfg(test)]
mod tests;
mod track;
mod truth;
mod waypoints;

pub use coning::{Coning, Sculling};
pub use constant_velocity::ConstantVelocity;
pub use great_circle::GreatCircle;
pub use impossible::Impossible;
pub use jet::Jet;
pub use kinematics::{Kinematics, Place, Stance};
pub use positions::{Pose, Positions};
pub use rate_table::{RateTable, TableTurns};
pub use rates::increments_of_rates;
pub use recorded::{Recorded, Residual, Row};
pub use segments::{Course, Segment, Segments, Sharpness, Turn};
pub use shaken::Shaken;
pub use still::Still;
pub use sway::{Sine, Sway, SwayAxes};
pub use track::Track;
pub use truth::{Moment, Truth};
pub use waypoints::{Passage, Waypoint, Waypoints};

/// A motion as a function of time.
///
/// Pure: the same time gives the same bits. Smooth between the [`joints`](Trajectory::joints), and to be asked a
/// little before t = 0 too (algorithms that use the sample before the first).
pub trait Trajectory: std::fmt::Debug + Send + Sync {
    /// Pose and its derivatives at the time `t` (s).
    fn at(&self, t: f64) -> Kinematics;

    /// Times (s, increasing) at which a derivative jumps. Quadrature is split there.
    fn joints(&self) -> &[f64] {
        &[]
    }

    /// End of the motion, s, if it has one of its own.
    fn duration(&self) -> Option<f64> {
        None
    }

    /// The largest angular frequency in pose and velocity from the joint before the time `t` (s) to the next, rad/s; 0 for what does
    /// not move. From it follows how finely an interval has to be cut for quadrature to rounding.
    fn fastest(&self, t: f64) -> f64;

    /// Mean square of the vibration along x, y, z of the body that the motion itself leaves out, (m/s²)².
    fn vibration(&self) -> [f64; 3] {
        [0.0; 3]
    }
}
