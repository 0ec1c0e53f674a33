//! Attitude at the start, from the sensors themselves: coarse methods, the gyrocompass loop, and what limits them all.
//!
//! | method | needs | base |
//! |---|---|---|
//! | [`triad`], [`Vectors`] | mean specific force and angular rate | at rest |
//! | [`InertialFrame`] | increments over some minutes; latitude or none | at rest, rocking |
//! | [`Gyrocompass`] | a coarse attitude, increments, latitude | at rest, rocking a little |
//! | [`AnyHeading`] | increments, latitude | at rest, rocking a little |
//! | [`filter`](crate::filter) with zero velocity | a coarse attitude, increments, latitude | at rest, rocking |
//!
//! Whatever the method, constant sensor errors turn the attitude by [`Limits::bias`], and noise leaves at least the
//! other laws of [`Limits`].

mod any_heading;
mod closest;
mod gyrocompass;
mod inertial;
mod limits;
mod triad;

pub use any_heading::{AnyHeading, AnyHeadingNoise};
pub use closest::closest_rotation;
pub use gyrocompass::Gyrocompass;
pub use inertial::{InertialError, InertialFrame, Solution};
pub use limits::Limits;
pub use triad::{TriadError, Vectors, triad};
