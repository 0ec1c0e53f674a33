//! The scenario as valid: SI and radians, every invariant holds. The only way in is [`Scenario::load`].

mod valid;

pub use valid::{
    Align, Damping, Drift, Expect, Formats, Frame, Imu, ImuStudy, Initial, Mechanization, Motion, Navigate,
    Output, RateTable, Scenario, Start, Statistic, Study, Vertical,
};
