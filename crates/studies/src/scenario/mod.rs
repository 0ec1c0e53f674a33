//! The scenario as written and as valid.
//!
//! Text becomes a `Document` (places), overrides change it, serde reads the written form (keys and words),
//! and checking it gives the valid form: SI, radians, every invariant. The only way in is [`Scenario::load`].

mod aided;
mod alignment;
mod budget;
mod check;
mod check_motion;
mod check_simulate;
mod de;
mod document;
mod example;
mod expect;
mod imu_study;
mod instrument;
mod load;
mod monte_carlo;
mod overrides;
mod quantity;
mod readout;
mod recorded;
mod schema;
mod sources;
mod start;
mod temperature;
#[cfg(test)]
mod tests;
mod valid;
mod valid_motion;
mod written;
mod written_log;
mod written_motion;

pub use aided::valid::{Aided, Condition, ConditionKind, Detect, Measured, MeasuredKind, Reference};
pub use alignment::valid::{
    AlignStudy, Coarse, FilterSettings, Knock, Method, MethodKind, Origin, Strategy, StrategyKind, Velocity,
};
pub use budget::valid::{Budget, BudgetFilter, Required, Requirement};
pub use monte_carlo::valid::{MonteCarlo, RunFigure, Threshold, Until};
pub use schema::json_schema;
pub use sources::process_example;
pub use valid::{
    Align, Damping, Drift, Expect, Formats, Frame, Imu, ImuStudy, Initial, Mechanization, Navigate, Output,
    Scenario, Start, Statistic, Study, Temperature, Vertical,
};
pub use valid_motion::{Aid, Aiding, Motion, Simulate, TrajectoryFile, Way};
