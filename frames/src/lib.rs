//! Navigation frames as types: inertial `i`, Earth `e`, local level `t`, body `b`.
//!
//! A vector knows the frame it is resolved in, a rotation the two frames it joins, a rate what turns
//! against what. Products that mix them up do not compile, and the types cost nothing at run time. With
//! them come the Earth (WGS 84, radii, rates), its gravity in two models, attitude in every
//! representation, and the transforms between the frames.
//!
//! ```
//! use schuler_frames::{B, Euler, Geodetic, Gravity, Rate, Rot, T, Vec3, I, earth};
//!
//! // A vehicle at rest: where it is and how it stands.
//! let place = Geodetic::new(45f64.to_radians(), 0.0, 0.0);
//! let c_tb: Rot<T, B> = Rot::from_euler(Euler::new(0.0, 0.1, 1.0));
//!
//! // What its accelerometers and gyros sense.
//! let f_b: Vec3<B> = c_tb.inverse() * -Gravity::Somigliana.gravity_t(place);
//! let omega_ie_t = earth::omega_ie_t(place.lat.sin(), place.lat.cos());
//! let omega_it_t: Rate<T, I, T> = earth::omega_et_t(Vec3::ZERO, place) + omega_ie_t;
//! let omega_ib_b: Rate<B, I, B> = Rate::<B, T, B>::claim(Vec3::ZERO) + c_tb.inverse() * omega_it_t;
//!
//! assert!((f_b[0] - 9.80619777 * 0.1f64.sin()).abs() < 1e-8); // nose up: the forward axis feels it
//! assert!((omega_ib_b.as_vec3().norm() - 7.292115e-5).abs() < 1e-18);
//! ```
//!
//! A wrong frame stops the compiler:
//!
//! ```compile_fail,E0277
//! use schuler_frames::{B, Rot, T, Vec3};
//! let c_tb: Rot<T, B> = Rot::IDENTITY;
//! let f_t: Vec3<T> = Vec3::new(0.0, 0.0, -9.8);
//! let wrong = c_tb * f_t; // c_tb takes vectors of b
//! ```
//!
//! Signs, orders, units and constants are those of the page [`conventions`].
//!
//! # From untyped to typed
//!
//! `claim` is the one door ([`Vec3::claim`], [`Rot::claim`], [`Dcm::claim`], [`Rate::claim`]): search for
//! it, and you see every place where a person vouches for a frame. [`Vec3::new`] is the same door with the components
//! spelt out. `as_array`, `as_rows`, `as_quaternion` and `as_nalgebra` lead back. Numbers from outside
//! enter checked through [`Rot::from_quaternion`] and [`Dcm::from_rows`].
//!
//! # What the types do not protect you from
//!
//! - **Units and quantities.** A `Vec3<T>` is a velocity, a force or a position error as you say; metres
//!   and feet add up. Position, velocity and acceleration share one type on purpose: kernels stay readable.
//! - **Relative to what.** `Vec3<E>` may be the velocity relative to e or that relative to i, resolved in
//!   e. Only rates carry their reference; [`velocity_i`] and [`velocity_e`] name theirs.
//! - **Time.** `c_tb` now and `c_tb` a step ago have one type, and so have the local level frames of two
//!   places. Whoever subtracts their vectors must know that the frames are the same.
//! - **Origin.** Frames here are axes. `c_ie * r_e` is right because i and e share an origin; `c_tb * r_b` is a
//!   difference of positions, not a position.
//! - **A wrong claim.** What is claimed to be a unit quaternion in b is believed.
//!
//! # Features
//!
//! `no_std`, without an allocator, by default and always; `hifitime` adds `earth_rotation_angle_at` for
//! epochs, and needs std.
#![no_std]

mod attitude_error;
pub mod conventions;
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
