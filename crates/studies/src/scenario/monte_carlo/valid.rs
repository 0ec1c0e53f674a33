//! `study: monte_carlo` of the valid scenario.

use super::super::{
    valid::{Imu, Initial, Mechanization, Start},
    valid_motion::Motion,
};

/// `study: monte_carlo`.
#[derive(Clone, Debug, PartialEq)]
pub struct MonteCarlo {
    /// What the instrument goes through; neither zero truth nor recorded in a file.
    pub motion: Motion,
    /// Where, when and how it begins.
    pub start: Start,
    /// Number of samples, positive.
    pub samples: u64,
    /// The instrument.
    pub imu: Imu,
    /// Standard deviations of the initial errors, one for each component that is not zero.
    pub initial_sigmas: Vec<Initial>,
    /// How it navigates.
    pub mechanization: Mechanization,
    /// Number of runs, two or more; the most where there is an `until`.
    pub runs: u64,
    /// Limits of which it is counted how many runs are beyond; their names differ.
    pub thresholds: Vec<Threshold>,
    /// When the runs may end early.
    pub until: Option<Until>,
}

/// A limit with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Threshold {
    /// Its name.
    pub name: String,
    /// Number of the error among the nine of [`schuler_strapdown::NavError::as_array`], or 9 for the horizontal distance.
    pub quantity: usize,
    /// SI, positive.
    pub limit: f64,
}

/// When the runs may end early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until {
    /// As of [`Threshold`].
    pub quantity: usize,
    /// Which figure of it.
    pub figure: RunFigure,
    /// Time, s: that of a row.
    pub at: f64,
    /// Half the width of the 99 % confidence interval over the figure, positive.
    pub relative: f64,
}

/// A figure of the errors of all runs at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RunFigure {
    /// Standard deviation about the mean of the runs.
    Deviation,
    /// Root of the mean square.
    Rms,
    /// The magnitude that this share of the runs does not exceed.
    Quantile(f64),
}

impl RunFigure {
    /// All there are, by their words in a scenario and in `monte_carlo.csv`.
    pub const ALL: [(&'static str, RunFigure); 6] = [
        ("sd", RunFigure::Deviation),
        ("rms", RunFigure::Rms),
        ("q50", RunFigure::Quantile(0.5)),
        ("q90", RunFigure::Quantile(0.9)),
        ("q95", RunFigure::Quantile(0.95)),
        ("q99", RunFigure::Quantile(0.99)),
    ];
}
