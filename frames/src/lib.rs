//! Navigation frames as types: inertial `i`, Earth `e`, local level `t`, body `b`.
#![no_std]

mod attitude_error;
mod dcm;
pub mod earth;
#[cfg(feature = "hifitime")]
mod epoch;
mod error;
mod euler;
mod frame;
mod geodetic;
mod gravity;
mod inertial;
mod local;
mod rate;
mod real;
mod rot;
mod rotation_vector;
mod vec3;
pub mod wgs84;

pub use attitude_error::{phi_between, with_phi};
pub use dcm::Dcm;
#[cfg(feature = "hifitime")]
pub use epoch::earth_rotation_angle_at;
pub use error::RotationError;
pub use euler::Euler;
pub use frame::{B, E, Enu, Frame, I, T};
pub use geodetic::Geodetic;
pub use gravity::{Gravity, somigliana};
pub use inertial::{c_ie, earth_rotation_angle, velocity_e, velocity_i};
pub use local::{C_ENU_T, position_error, with_position_error};
pub use rate::Rate;
pub use real::Real;
pub use rot::Rot;
pub use vec3::Vec3;
