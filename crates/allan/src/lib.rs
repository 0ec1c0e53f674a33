//! Allan variance of inertial sensor logs.
mod edf;
mod error;
mod estimator;
mod grid;
mod interval;
mod kernel;
mod noise_id;
mod phase;
mod pyramid;
mod times;

pub use edf::{NoiseType, edf, pyramid_edf};
pub use error::AllanError;
pub use estimator::{Curve, Estimator, Point};
pub use grid::Grid;
pub use interval::{quantile, variance_factors};
pub use noise_id::identify;
pub use phase::Phase;
pub use pyramid::Pyramid;
pub use times::{STEP_TOLERANCE, sample_interval, split_at_gaps};
