//! Measurements: what is compared with what the navigator has computed.
//!
//! Every row is the derivative of a non-linear prediction with respect to the errors at zero error. With
//! `C_computed = exp(-[phi ×]) C`, a body vector l computed in t is wrong by `-phi × (C l) = [(C l) ×] phi`.

mod attitude;
mod body_velocity;
mod position;
mod rate;
mod velocity;

pub use attitude::{Attitude, Heading};
pub use body_velocity::NonHolonomic;
pub use position::{Height, IntegratedVelocity, Position};
pub use rate::ZeroRate;
pub use velocity::{Velocity, ZeroVelocity};

use nalgebra::Matrix3;
use schuler_frames::{T, Vec3, wgs84};

use super::{Now, Observation};

/// Something measured that the navigator has computed too.
pub trait Measurement {
    /// Computed minus measured, what errors make of it, and its noise.
    fn observe(&self, now: &Now) -> Observation;
}

/// Axes of a measurement that are used: north, east, down, or x, y, z.
pub type Axes = [bool; 3];

/// All three axes.
pub const ALL: Axes = [true; 3];

/// North and east.
pub const HORIZONTAL: Axes = [true, true, false];

/// Change of the Earth rate in t with the position error, (rad/s)/m:
/// omega_ie = Ω (cos L, 0, -sin L), dL = dr_N / (R_M + h).
fn earth_rate_slope(now: &Now) -> Matrix3<f64> {
    let position = now.pva.position;
    let (s, c) = libm::sincos(position.lat);
    let per_metre = wgs84::OMEGA / (wgs84::r_m(s) + position.h);
    let mut slope = Matrix3::zeros();
    slope[(0, 0)] = -s * per_metre;
    slope[(2, 0)] = -c * per_metre;
    slope
}

/// omega_ie in t, rad/s.
fn earth_rate(now: &Now) -> Vec3<T> {
    let (s, c) = libm::sincos(now.pva.position.lat);
    schuler_frames::earth::omega_ie_t(s, c).as_vec3()
}
