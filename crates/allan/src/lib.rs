//! Allan variance of inertial sensor logs: estimate, confidence, and a fit that gives error sources.
//!
//! - **Estimate**: [`Curve::estimate`] on a [`Phase`] (from rates, increments or the integral), five deviations on any
//!   [`Grid`]; [`Pyramid`] for streams larger than memory.
//! - **Confidence**: [`edf`] by noise type, [`variance_factors`] by chi-square, [`identify`] for the noise type.
//! - **Fit**: [`fit`] gives quantization Q, random walk N, bias instability B, rate random walk K, ramp R (IEEE Std
//!   952) and, where the curve shows them, a Markov process and a sinusoid; each with standard error, 95 % interval,
//!   Cramér-Rao bound and a [`Verdict`]. [`to_yaml`] writes them as sources of a scenario. [`sun_eq3`] is the method of
//!   the paper this project started from, for comparison.
//!
//! Units are SI: rates in rad/s or m/s², times in s. Spectra are two-sided, so that white noise of density N has the
//! variance N²/tau, flicker B² 2 ln 2/π, random walk K² tau/3.
//!
//! ```
//! use schuler_allan::{Curve, Estimator, Grid, Phase, Term, fit};
//!
//! // A white enough series: 4096 numbers of the Lehmer generator, 100 Hz.
//! let mut n: u64 = 1_234_567_890;
//! let rate: Vec<f64> = (0..4096)
//!     .map(|_| {
//!         n = n * 16807 % 2_147_483_647;
//!         n as f64 / 2_147_483_647.0 - 0.5
//!     })
//!     .collect();
//! let phase = Phase::from_rate(&rate, 0.01)?;
//! let curve = Curve::estimate(&phase, Estimator::Overlapping, &Grid::PerOctave(2))?;
//! let model = fit(&curve)?;
//! // Uniform numbers have the variance 1/12, white noise at 100 Hz the density sqrt(variance × 0.01 s).
//! let n = model.parameter(Term::White).expect("always reported");
//! assert!(n.interval.0 < (0.01f64 / 12.0).sqrt() && (0.01f64 / 12.0).sqrt() < n.interval.1);
//! # Ok::<(), schuler_allan::AllanError>(())
//! ```
//!
//! How well known noise is recovered: `recovery.md` beside the manifest, made by
//! `cargo run --release -p schuler-allan --example recovery`.
mod covariance;
mod crb;
mod edf;
mod error;
mod estimator;
mod fit;
mod gls;
mod grid;
mod interval;
mod kernel;
mod noise_id;
mod phase;
mod pyramid;
mod select;
mod sources;
mod subset;
mod sun_eq3;
mod term;
mod times;

pub use crb::cramer_rao;
pub use edf::{NoiseType, edf, pyramid_edf};
pub use error::AllanError;
pub use estimator::{Curve, Estimator, Point};
pub use fit::{Fit, Fitter, Parameter, Verdict, fit};
pub use grid::Grid;
pub use interval::{quantile, variance_factors};
pub use noise_id::identify;
pub use phase::Phase;
pub use pyramid::Pyramid;
pub use sources::{to_sources, to_yaml, unit};
pub use sun_eq3::{SunEq3, sun_eq3};
pub use term::Term;
pub use times::{STEP_TOLERANCE, sample_interval, split_at_gaps};
