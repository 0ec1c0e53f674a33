//! The block `monte_carlo` as written. Doc comments go into the schema.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::{
    de::At,
    written::{InitialErrors, Quantity},
};

/// How many runs there are, what is drawn at their start, and what is asked of them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MonteCarlo {
    /// Number of runs; with `until`, the most.
    pub runs: At<u64>,
    /// Standard deviations of the errors of the computed state at t = 0, independent of each other.
    pub initial_sigmas: Option<At<InitialErrors>>,
    /// Limits of which it is counted how many runs are beyond.
    #[serde(default)]
    pub thresholds: Vec<At<Threshold>>,
    /// Ends the runs early, once a figure is known well enough.
    pub until: Option<At<Until>>,
}

/// A limit with a name.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Threshold {
    /// What it is called in `exceedance.csv`.
    pub name: At<String>,
    /// An error, `dn_m`, `horizontal_m`.
    pub quantity: At<String>,
    /// A run whose error is larger in magnitude is beyond, `1 nmi`.
    pub limit: Quantity,
}

/// When the runs may end: looked at after 128, 192, 256, 384, 512, … runs.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Until {
    /// An error, `dn_m`, `horizontal_m`.
    pub quantity: At<String>,
    /// Which figure of it: `sd`, `rms`, `q50`, `q90`, `q95`, `q99`.
    pub way: At<String>,
    /// When, `1 h`: a time of a row.
    pub at: Quantity,
    /// Half the width of its 99 % confidence interval, as a ratio, `5 %`.
    pub relative: Quantity,
}
