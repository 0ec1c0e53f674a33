//! `study: budget` of the valid scenario.

use super::super::{
    valid::{Imu, Initial, Mechanization, Start},
    valid_motion::Motion,
};

/// `study: budget`.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// What the instrument goes through; neither zero truth nor recorded in a file.
    pub motion: Motion,
    /// Where, when and how it begins.
    pub start: Start,
    /// Number of samples, positive.
    pub samples: u64,
    /// The instrument; it has no readout.
    pub imu: Imu,
    /// Standard deviations of the initial errors, one for each component that is not zero.
    pub initial_sigmas: Vec<Initial>,
    /// How it navigates; a damped vertical channel is of second order.
    pub mechanization: Mechanization,
    /// What it must reach.
    pub requirement: Option<Requirement>,
    /// Monte Carlo runs, zero for none; where there are some, no source has a fixed value.
    pub runs: u64,
}

/// A horizontal position error that must be kept with a probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirement {
    /// Radius, m, positive.
    pub horizontal: f64,
    /// Time, s: that of a row.
    pub at: f64,
    /// Probability, between zero and one.
    pub probability: f64,
}
