//! Strapdown-navigation error propagation: IMU error sources, mechanization, drift.
//!
//! This crate gathers the others under short names; the command line `schuler` is built on the same.

pub use schuler_frames as frames;
pub use schuler_imu as imu;
pub use schuler_strapdown as strapdown;
pub use schuler_studies as studies;
