//! Scenarios, the studies that run them, and the records they leave.

pub mod align;
pub mod allan_study;
pub mod budget;
mod channel;
mod course;
mod diagnostic;
pub mod drift;
mod error;
pub mod figure;
pub mod imu_study;
pub mod log;
pub mod monte_carlo;
pub mod navigate;
mod navigator;
mod progress;
pub mod record;
#[cfg(test)]
#[path = "../../../tests/recorded.rs"]
mod recorded;
mod run;
pub mod scenario;
mod similar;
pub mod simulate;
pub mod trajectory;
pub mod units;

pub use diagnostic::{Diagnostic, Excerpt, Place};
pub use error::Error;
pub use progress::{Context, Progress, Silent};
pub use record::Record;
pub use run::run;
pub use scenario::Scenario;
