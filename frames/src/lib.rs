//! Navigation frames as types: inertial `i`, Earth `e`, local level `t`, body `b`.
#![no_std]

mod dcm;
pub mod earth;
mod frame;
mod geodetic;
mod gravity;
mod rate;
mod real;
mod rot;
mod vec3;
pub mod wgs84;

pub use dcm::Dcm;
pub use frame::{B, E, Frame, I, T};
pub use geodetic::Geodetic;
pub use gravity::{Gravity, somigliana};
pub use rate::Rate;
pub use real::Real;
pub use rot::Rot;
pub use vec3::Vec3;
