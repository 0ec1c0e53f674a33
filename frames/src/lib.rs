//! Navigation frames as types: inertial `i`, Earth `e`, local level `t`, body `b`.
#![no_std]

mod dcm;
mod frame;
mod rate;
mod real;
mod rot;
mod vec3;

pub use dcm::Dcm;
pub use frame::{B, E, Frame, I, T};
pub use rate::Rate;
pub use real::Real;
pub use rot::Rot;
pub use vec3::Vec3;
