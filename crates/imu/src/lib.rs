//! Errors of inertial sensors: terms of the measurement equation times processes in time.
//!
//! Everything is along sensor axes and in SI units with angles in radians; temperatures are in
//! kelvin. An error is measured minus true.
//!
//! A [`Source`] is a [`Term`] (how coefficients become an output error, given the input) on an
//! [`Instrument`], whose coefficients follow a [`Process`] (how they evolve in time). A [`Spec`]
//! lists sources, an [`Imu`] steps them.
//!
//! How it is checked: every term with every process, taken from the registries, is simulated at three step
//! lengths and compared in mean, variance and Allan variance at ten averaging times with what both promise.
//! Of these 69 536 comparisons a few must lie beyond 4 sigma of their estimate: their number must be the expected
//! one within 4 sigma, and none may lie beyond 5.5 sigma.
//!
//! An interval mean takes one normal for each part of a process, exactly for any step: see
//! [`process::Innovation`]. Eight steps are prepared together in the widest lanes that the machine has, without
//! a bit of difference to one step at a time in narrow ones.
//!
//! ```
//! use schuler_imu::{Imu, Instrument::Gyro, Source, Spec, Stream, Truth};
//!
//! let spec = Spec::from_sources([
//!     Source::named(Gyro, "bias", "white", &[("density", 1e-4.into())])?,
//!     Source::named(Gyro, "scale_factor", "constant", &[("sigma", 1e-4.into())])?,
//! ])?;
//! let mut imu = Imu::new(&spec, Stream { seed: 1, run: 0 })?;
//! let sample = imu.step(0.01, &Truth::rates([0.1, 0.0, 0.0], [0.0, 0.0, -9.81]));
//! assert!((sample.omega()[0] - 0.1).abs() < 1e-4 + 5.0 * 1e-4 / 0.01_f64.sqrt());
//! # Ok::<(), schuler_imu::Error>(())
//! ```
#![no_std]

mod bank;
mod error;
mod imu;
mod instrument;
mod moving;
pub mod preset;
pub mod process;
pub mod random;
pub mod readout;
mod sample;
mod source;
mod spec;
mod state;
mod sums;
mod temperature;
pub mod term;
mod truth;
mod unit;

pub use error::{Error, Names, Text};
pub use imu::Imu;
pub use instrument::Instrument;
pub use process::{Evolution, PROCESSES, Process, ProcessKind, Value, process_kind};
pub use random::Stream;
pub use readout::Readout;
pub use sample::Sample;
pub use source::{Component, Source};
pub use spec::{MAX_SOURCES, Spec};
pub use state::State;
pub use temperature::Temperature;
pub use term::{TERMS, Term, term};
pub use truth::{Input, Motion, Octet, Seen, Truth};
pub use unit::Unit;
