//! The one error type of the crate: bad input with its place, and what files and folders refuse.

use std::path::PathBuf;

use crate::diagnostic::Diagnostic;

/// What can go wrong between a scenario file and the files of a finished study.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Input that people can mend: a scenario key, a unit, a row of a log. Says where and how.
    #[error("{0}")]
    Input(Box<Diagnostic>),
    /// A file could not be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file or folder of the results could not be written. Nothing half-written is left behind.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A figure could not be drawn.
    #[error("cannot draw {figure}: {reason}")]
    Figure {
        /// File name of the figure.
        figure: String,
        /// What the drawing library said.
        reason: String,
    },
    /// A run left the range of its equations: errors beyond all sense, or a path over a pole.
    #[error(
        "the {way} run of {source_name} gives no numbers from {time} s on: the error is too large for the navigator, or its path meets a pole; expected a source that keeps the navigator on the Earth (0.01 deg/h, 100 ug)"
    )]
    Diverged {
        /// The error source.
        source_name: String,
        /// The way of the run.
        way: &'static str,
        /// Time of the first row without numbers, s.
        time: f64,
    },
    /// The filter of a budget meets numbers that make no sense.
    #[error(
        "the filter of the budget fails: {fault}; expected standard deviations and measurements that fit each other"
    )]
    Filter {
        /// What the filter said.
        fault: schuler_strapdown::filter::FilterError,
    },
    /// A run whose alignment finds no attitude.
    #[error(
        "the alignment of a run finds no attitude: {0}; expected sensor errors far below gravity and Earth rate"
    )]
    NoAttitude(#[from] schuler_strapdown::align::TriadError),
    /// The IMU model refused its list of error sources.
    #[error("imu: {0}")]
    Imu(#[from] schuler_imu::Error),
    /// A valid scenario that this version cannot run yet.
    #[error("{what} is not available in this version")]
    Unsupported {
        /// The part of the scenario.
        what: String,
    },
}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Self {
        Error::Input(Box::new(diagnostic))
    }
}
