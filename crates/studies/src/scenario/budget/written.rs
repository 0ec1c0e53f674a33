//! The block `budget` as written. Doc comments go into the schema.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::{
    de::At,
    written::{InitialErrors, Quantity},
};

/// What an error budget asks beside the error sources.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Standard deviations of the errors of the computed state at t = 0, independent of each other.
    pub initial_sigmas: Option<At<InitialErrors>>,
    /// What the navigator must reach.
    pub requirement: Option<At<Requirement>>,
    /// Monte Carlo runs of the non-linear system for each source and for all together; none when absent.
    pub runs: Option<At<u64>>,
}

/// A horizontal position error that must be kept with a probability.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    /// Radius that the horizontal position error must not leave, `1 nmi`.
    pub horizontal: Quantity,
    /// When, `1 h`: a time of a row.
    pub at: Quantity,
    /// Probability to be inside, `95 %`.
    pub probability: Quantity,
}
