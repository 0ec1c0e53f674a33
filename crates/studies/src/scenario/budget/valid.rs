//! `study: budget` of the valid scenario.

use schuler_imu::Spec;

use super::super::{
    valid::{Imu, Initial, Mechanization, Start},
    valid_motion::{Aiding, Motion},
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
    /// Samples of a static alignment that ends at t = 0, zero for none; where there is one, the body stands at the start.
    pub alignment: u64,
    /// The filter and its measurements.
    pub filter: Option<BudgetFilter>,
    /// How it navigates; a damped vertical channel is of second order.
    pub mechanization: Mechanization,
    /// What it must reach.
    pub requirement: Option<Requirement>,
    /// Monte Carlo runs, zero for none; where there are some, no source has a fixed value.
    pub runs: u64,
    /// Whether each source has runs of its own, beside all together.
    pub runs_of_each: bool,
}

/// A filter that takes measurements; the mechanization is in frame t, one sample an update, vertical channel free or held.
#[derive(Clone, Debug, PartialEq)]
pub struct BudgetFilter {
    /// Error sources that it knows of.
    pub spec: Spec,
    /// Standard deviations of the nine navigation errors at the start as it takes them, m, m/s, rad.
    pub sigma: [f64; 9],
    /// What is measured, and how well in truth.
    pub aiding: Aiding,
    /// How well as it takes it: the same with its standard deviations, all positive.
    pub believed: Aiding,
}

/// Errors that must be kept with a probability.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// What is limited, and its limit, m, m/s or rad, positive; at least one.
    pub limits: Vec<(Required, f64)>,
    /// Time, s: that of a row.
    pub at: f64,
    /// Probability, between zero and one.
    pub probability: f64,
}

/// An error in the plane or along a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Required {
    /// Position, north and east.
    Horizontal,
    /// Position down.
    Down,
    /// Velocity, north and east.
    Velocity,
    /// Attitude about north and east.
    Tilt,
    /// Attitude about down.
    Heading,
}

impl Required {
    /// The word in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            Required::Horizontal => "horizontal",
            Required::Down => "down",
            Required::Velocity => "velocity",
            Required::Tilt => "tilt",
            Required::Heading => "heading",
        }
    }
}
