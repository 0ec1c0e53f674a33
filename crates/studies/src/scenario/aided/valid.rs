//! `study: navigate` with a filter, as valid.

use schuler_imu::Spec;
use schuler_strapdown::filter::Form;

use super::super::valid::{Align, Mechanization, Start};
use crate::log::{ColumnRef, Layout, LogSpec};

/// A log that is navigated with measurements beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Aided {
    /// The log and how to read it.
    pub log: LogSpec,
    /// Where it begins; attitude and velocity too where no window is aligned.
    pub start: Start,
    /// The window that gives the attitude; without it that of the start holds, at the beginning of the log.
    pub align: Option<Align>,
    /// Frame t, one sample an update, vertical channel free or held.
    pub mechanization: Mechanization,
    /// How long it navigates, s; to the end of the log when absent.
    pub duration: Option<f64>,
    /// Error sources that the filter knows of.
    pub spec: Spec,
    /// Standard deviations of the nine navigation errors at the start, m, m/s, rad.
    pub sigma: [f64; 9],
    /// Form of the error dynamics.
    pub form: Form,
    /// Probability with which a good measurement is refused.
    pub gate: Option<f64>,
    /// Logs of measurements.
    pub measured: Vec<Measured>,
    /// What is known without an instrument.
    pub conditions: Vec<Condition>,
    /// What the result is compared with.
    pub reference: Option<Reference>,
}

/// What a log of measurements holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasuredKind {
    /// Position of an antenna.
    Position,
    /// Velocity of an antenna.
    Velocity,
    /// Height of an antenna.
    Height,
    /// Heading.
    Heading,
}

/// A log of measurements and how to read it.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// What it holds.
    pub kind: MeasuredKind,
    /// File name, as written.
    pub file: String,
    /// Time and what is measured: four columns, or two. Signs are in `signs`.
    pub columns: Vec<ColumnRef>,
    /// 1 or -1 for each column.
    pub signs: Vec<f64>,
    /// What else is known of its rows.
    pub layout: Layout,
    /// Columns of standard deviations, as many as [`MeasuredKind::parts`] where they are read.
    pub sigma_columns: Vec<ColumnRef>,
    /// rad per unit of an angle.
    pub angle: f64,
    /// Standard deviation north, east, down (m, m/s), or of the one component (m, rad); from the file when absent.
    pub sigma: Option<[f64; 3]>,
    /// What is added to its times, s.
    pub offset: f64,
    /// Least interval between rows used, s.
    pub every: f64,
    /// From the IMU to the antenna, body axes, m.
    pub lever_arm: [f64; 3],
    /// Begin and end of times without, s.
    pub outages: Vec<[f64; 2]>,
}

/// What is known of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConditionKind {
    /// It stands still.
    ZeroVelocity,
    /// It does not turn.
    ZeroRate,
    /// It moves only along its forward axis.
    NonHolonomic,
}

/// Something known without an instrument.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// What.
    pub kind: ConditionKind,
    /// Standard deviation, m/s or rad/s.
    pub sigma: f64,
    /// Interval, in samples of the IMU, positive.
    pub stride: u64,
    /// Begin and end of the times in which it holds, s; always when absent.
    pub windows: Option<Vec<[f64; 2]>>,
    /// How a standstill is told from the IMU, where it must show one.
    pub detect: Option<Detect>,
    /// From the IMU to the point that does not slip, body axes, m.
    pub lever_arm: [f64; 3],
}

/// How a standstill is told from the IMU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detect {
    /// Samples of the window, two at least.
    pub window: usize,
    /// Standard deviation of the noise of a sample of a gyro, rad/s.
    pub gyro: f64,
    /// Of an accelerometer, m/s².
    pub accel: f64,
    /// How many times this noise a standstill may have.
    pub threshold: f64,
    /// Speed from which on nothing is a standstill, m/s.
    pub speed: Option<f64>,
}

/// A trajectory to compare with.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// File name, as written.
    pub file: String,
    /// Time, latitude, longitude, height, velocity, roll, pitch, yaw.
    pub columns: Vec<ColumnRef>,
    /// 1 or -1 for each column.
    pub signs: Vec<f64>,
    /// What else is known of its rows.
    pub layout: Layout,
    /// rad per unit of an angle.
    pub angle: f64,
    /// What is added to its times, s.
    pub offset: f64,
}

impl MeasuredKind {
    /// The word for it in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            MeasuredKind::Position => "position",
            MeasuredKind::Velocity => "velocity",
            MeasuredKind::Height => "height",
            MeasuredKind::Heading => "heading",
        }
    }

    /// Its components.
    pub fn parts(self) -> &'static [&'static str] {
        match self {
            MeasuredKind::Position => &["position.n", "position.e", "position.d"],
            MeasuredKind::Velocity => &["velocity.n", "velocity.e", "velocity.d"],
            MeasuredKind::Height => &["height"],
            MeasuredKind::Heading => &["heading"],
        }
    }
}

impl ConditionKind {
    /// The word for it in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            ConditionKind::ZeroVelocity => "zero_velocity",
            ConditionKind::ZeroRate => "zero_rate",
            ConditionKind::NonHolonomic => "non_holonomic",
        }
    }

    /// Its components.
    pub fn parts(self) -> &'static [&'static str] {
        match self {
            ConditionKind::ZeroVelocity => &["zero_velocity.n", "zero_velocity.e", "zero_velocity.d"],
            ConditionKind::ZeroRate => &["zero_rate.x", "zero_rate.y", "zero_rate.z"],
            ConditionKind::NonHolonomic => &["non_holonomic.y", "non_holonomic.z"],
        }
    }
}
