//! Navigation frames as types: inertial `i`, Earth `e`, local level `t`, body `b`.
#![no_std]

mod attitude_error;
mod dcm;
pub mod earth;
mod error;
mod euler;
mod frame;
mod geodetic;
mod gravity;
mod rate;
mod real;
mod rot;
mod rotation_vector;
mod vec3;
pub mod wgs84;

pub use attitude_error::{phi_between, with_phi};
pub use dcm::Dcm;
pub use error::RotationError;
pub use euler::Euler;
pub use frame::{B, E, Frame, I, T};
pub use geodetic::Geodetic;
pub use gravity::{Gravity, somigliana};
pub use rate::Rate;
pub use real::Real;
pub use rot::Rot;
pub use vec3::Vec3;
