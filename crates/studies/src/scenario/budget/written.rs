//! The block `budget` as written. Doc comments go into the schema.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::{
    de::At,
    schema::Sources,
    written::{InitialErrors, OneOrThree, Quantity},
};

/// What an error budget asks beside the error sources.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Standard deviations of the errors of the computed state at t = 0, independent of each other.
    pub initial_sigmas: Option<At<InitialErrors>>,
    /// An alignment at rest before t = 0 by the same sensors: tilt and heading belong to what caused them.
    pub alignment: Option<At<Alignment>>,
    /// A filter that takes the measurements of `aiding`; its model may be another than what is true.
    pub filter: Option<At<BudgetFilter>>,
    /// What the navigator must reach.
    pub requirement: Option<At<Requirement>>,
    /// Monte Carlo runs of the non-linear system for each source and for all together; none when absent.
    pub runs: Option<At<u64>>,
    /// Of what there are runs; `each` when absent.
    pub runs_of: Option<RunsOf>,
}

/// Of what there are runs.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RunsOf {
    /// Of each source alone and of all together.
    Each,
    /// Of all together.
    Total,
}

/// A static alignment: level by the mean specific force, north by the mean angular rate (TRIAD, specific force first).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Alignment {
    /// How long it lasts; it ends at t = 0.
    pub window: Quantity,
}

/// What the filter believes. What it does not say is what is true.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BudgetFilter {
    /// Error sources of the gyros that it knows of; those of `imu` when absent.
    pub gyro: Option<At<Sources>>,
    /// Error sources of the accelerometers that it knows of; those of `imu` when absent.
    pub accel: Option<At<Sources>>,
    /// Standard deviation of the position at the start, one for all axes or three (north, east, down).
    pub position: Option<At<OneOrThree>>,
    /// Standard deviation of the velocity at the start.
    pub velocity: Option<At<OneOrThree>>,
    /// Standard deviation of the tilt at the start.
    pub tilt: Option<Quantity>,
    /// Standard deviation of the heading at the start.
    pub heading: Option<Quantity>,
    /// Standard deviations that it takes the measurements to have.
    pub noise: Option<At<Noise>>,
}

/// Standard deviations of measurements, one for all axes or three (north, east, down).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Of the position.
    pub position: Option<At<OneOrThree>>,
    /// Of the velocity.
    pub velocity: Option<At<OneOrThree>>,
    /// Of the height.
    pub height: Option<Quantity>,
    /// Of the heading.
    pub heading: Option<Quantity>,
}

/// Errors that must be kept with a probability at some time; each limit is a requirement of its own.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// Radius that the horizontal position error must not leave, `1 nmi`.
    pub horizontal: Option<Quantity>,
    /// Largest error of the height, `30 m`; not where the vertical channel is held.
    pub down: Option<Quantity>,
    /// Largest error of the horizontal velocity, `1 m/s`.
    pub velocity: Option<Quantity>,
    /// Largest tilt, `20 arcsec`.
    pub tilt: Option<Quantity>,
    /// Largest error of the heading, `5 arcmin`.
    pub heading: Option<Quantity>,
    /// When, `1 h`: a time of a row.
    pub at: Quantity,
    /// Probability to be inside, `95 %`.
    pub probability: Quantity,
}
