//! Recorded IMU logs: CSV or npy, either also gzipped, read row by row into increments along the body axes.
//!
//! A log holds columns of up to three gyros and three accelerometers, as increments (integrals over the sample interval,
//! what most instruments deliver) or as rates, in counts of a stated size and along sensor axes that a proper
//! rotation of quarter turns takes to forward-right-down. The time of a row is the end of its interval.

mod axes;
mod bytes;
mod clock;
mod fault;
mod find;
mod npy;
mod npy_header;
#[cfg(test)]
mod npy_tests;
mod number;
mod reader;
mod rows;
mod slots;
mod spec;
#[cfg(test)]
mod tests;
mod text;

pub use axes::{AxesError, AxisMap};
pub use find::find;
pub use reader::{LogReader, LogSample, titles};
pub use spec::{ColumnRef, Columns, Content, LogSpec, Scale, TimeColumn};
