//! Recorded IMU logs: CSV or npy, either also gzipped, read row by row into increments along the body axes.
//!
//! Text is a table with comma, semicolon, tab or blanks between its fields, under a header or without one (the KF-GINS
//! text formats are such tables), or holds RAWIMU messages of a NovAtel receiver, see [`message`].
//!
//! A log holds columns of up to three gyros and three accelerometers, as increments (integrals over the sample interval,
//! what most instruments deliver) or as rates, in counts of a stated size and along sensor axes that a proper
//! rotation of quarter turns takes to forward-right-down. The time of a row is the end of its interval.
//!
//! What reading costs, ns a number of a log with six columns (`cargo run --release -p schuler-studies --example log_cost`, two
//! shared cores, November 2026), beside 2 to 3 ns for the Allan deviation at all octaves:
//!
//! | log | bytes a number | ns a number |
//! |---|---|---|
//! | CSV with 16 digits | 21.7 | 53 |
//! | the same, gzipped | 9.5 | 125 |
//! | CSV of whole counts | 4.4 | 21 |
//! | the same, gzipped | 1.9 | 36 |
//! | npy, float64, float32 or int32 | 8 or 4 | 6 |
//!
//! So text is ten to fifty times the deviation, and npy about twice.

mod axes;
mod beside;
mod bytes;
mod clock;
mod fault;
mod find;
#[cfg(test)]
mod format_tests;
pub mod message;
mod npy;
mod npy_header;
#[cfg(test)]
mod npy_tests;
mod number;
mod parquet_rows;
#[cfg(test)]
mod parquet_tests;
mod reader;
mod rows;
mod slots;
mod spec;
#[cfg(test)]
mod tests;
mod text;

pub use axes::{AxesError, AxisMap};
pub use beside::{Layout, Row, rows};
pub use find::{find, find_named};
pub use reader::{LogReader, LogSample, titles};
pub use spec::{ColumnRef, Columns, Content, LogSpec, Scale, TimeColumn};
