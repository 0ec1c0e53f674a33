#![doc = include_str!("../../../README.md")]
pub use schuler_frames as frames;
pub use schuler_imu as imu;
pub use schuler_strapdown as strapdown;
pub use schuler_studies as studies;
