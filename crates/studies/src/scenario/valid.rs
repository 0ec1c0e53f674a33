//! Types of the valid scenario. Nothing downstream sees anything else.

use std::path::PathBuf;

use hifitime::Epoch;
use schuler_frames::{Euler, Geodetic, Gravity};
use schuler_imu::Spec;
use schuler_strapdown::Coning;

use super::aided::valid::Aided;
use super::alignment::valid::AlignStudy;
use super::budget::valid::Budget;
use super::monte_carlo::valid::MonteCarlo;
use super::valid_motion::{Motion, Simulate};
use crate::log::{Content, LogSpec};

/// A scenario that can be run.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// File it came from, as named by the user.
    pub file: PathBuf,
    /// Title for tables and figures.
    pub title: String,
    /// Which study, with everything it needs.
    pub study: Study,
    /// What is written, and how often.
    pub output: Output,
    /// What the result is expected to be.
    pub expect: Vec<Expect>,
    /// Master seed of every random draw.
    pub seed: u64,
    /// BLAKE3 of the canonical form, hexadecimal: comments, order of keys and units do not change it.
    pub hash: String,
}

/// The kinds of study.
#[derive(Clone, Debug, PartialEq)]
pub enum Study {
    /// Sensor errors only.
    Imu(ImuStudy),
    /// Each error source alone and all together, on a stationary base.
    Drift(Drift),
    /// A recorded log.
    Navigate(Navigate),
    /// A recorded log with measurements beside it.
    Aided(Box<Aided>),
    /// Allan deviations of a recorded log, and the error model in them.
    Allan(LogSpec),
    /// Methods of alignment side by side.
    Align(AlignStudy),
    /// Truth, logs and measurements of a motion.
    Simulate(Box<Simulate>),
    /// The share of each error source.
    Budget(Box<Budget>),
    /// Many runs of the full navigator.
    MonteCarlo(Box<MonteCarlo>),
}

impl Scenario {
    /// How the study navigates, if it does.
    pub fn mechanization(&self) -> Option<&Mechanization> {
        match &self.study {
            Study::Imu(_) | Study::Allan(_) | Study::Simulate(_) => None,
            Study::Drift(drift) => Some(&drift.mechanization),
            Study::Align(align) => Some(&align.mechanization),
            Study::Budget(budget) => Some(&budget.mechanization),
            Study::MonteCarlo(study) => Some(&study.mechanization),
            Study::Navigate(navigate) => Some(&navigate.mechanization),
            Study::Aided(aided) => Some(&aided.mechanization),
        }
    }
}

impl Scenario {
    /// The gravity model, if there is one.
    pub fn gravity(&self) -> Option<Gravity> {
        match &self.study {
            Study::Simulate(simulate) => Some(simulate.gravity),
            _ => self.mechanization().map(|mechanization| mechanization.gravity),
        }
    }
}

impl Study {
    /// The word for it in a scenario.
    pub fn name(&self) -> &'static str {
        match self {
            Study::Imu(_) => "imu",
            Study::Drift(_) => "drift",
            Study::Navigate(_) | Study::Aided(_) => "navigate",
            Study::Allan(_) => "allan",
            Study::Align(_) => "align",
            Study::Simulate(_) => "simulate",
            Study::Budget(_) => "budget",
            Study::MonteCarlo(_) => "monte_carlo",
        }
    }
}

impl Vertical {
    /// The word for it in a scenario.
    pub fn name(&self) -> &'static str {
        match self {
            Vertical::Held => "held",
            Vertical::Free => "free",
            Vertical::Damped(_) => "damped",
        }
    }
}

/// `study: imu`.
#[derive(Clone, Debug, PartialEq)]
pub struct ImuStudy {
    /// What the instrument goes through.
    pub motion: Motion,
    /// Place and attitude; every motion but zero truth has them.
    pub start: Option<Start>,
    /// Number of samples, positive.
    pub samples: u64,
    /// The instrument.
    pub imu: Imu,
    /// Whether Allan deviations are wanted; only where the input does not change.
    pub allan: bool,
}

/// `study: drift`.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// Where, when and how it stands; its velocity is zero.
    pub start: Start,
    /// Number of samples, positive: the duration is `samples / imu.rate`.
    pub samples: u64,
    /// The instrument.
    pub imu: Imu,
    /// Errors of the computed state at the start, one for each component that is not zero.
    pub initial_errors: Vec<Initial>,
    /// How it navigates.
    pub mechanization: Mechanization,
}

/// `study: navigate`.
#[derive(Clone, Debug, PartialEq)]
pub struct Navigate {
    /// The recorded log.
    pub log: LogSpec,
    /// Where and when the log begins; its attitude is found by `align`.
    pub start: Start,
    /// Levelling and heading from the log itself.
    pub align: Align,
    /// How it navigates.
    pub mechanization: Mechanization,
    /// How much of the log after the window is navigated, s; all of it when absent.
    pub duration: Option<f64>,
}

/// Place, time, attitude and velocity at t = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Epoch of t = 0, any time scale, if one was given.
    pub epoch: Option<Epoch>,
    /// WGS 84 geodetic position.
    pub position: Geodetic,
    /// Attitude C_b^t.
    pub attitude: Euler,
    /// North, east, down velocity, m/s.
    pub velocity: [f64; 3],
}

/// An instrument: three gyros and three accelerometers along x, y, z of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct Imu {
    /// Sample rate, Hz, positive.
    pub rate: f64,
    /// Its error sources, its readout and the temperature of its calibration.
    pub spec: Spec,
    /// Temperature of the run; that of a [`schuler_imu::Truth`] that states none when absent.
    pub temperature: Option<Temperature>,
}

/// Temperature of a run as a function of time; temperatures in K, times in s.
#[derive(Clone, Debug, PartialEq)]
pub enum Temperature {
    /// Always the same.
    Constant(f64),
    /// `start + rate t`.
    Ramp {
        /// Temperature at t = 0, K.
        start: f64,
        /// Rate, K/s.
        rate: f64,
    },
    /// `end + (start - end) exp(-t/tau)`.
    WarmUp {
        /// Temperature at t = 0, K.
        start: f64,
        /// Temperature at last, K.
        end: f64,
        /// Time constant, s.
        tau: f64,
    },
    /// Points (time, temperature), times increasing.
    Table(Vec<(f64, f64)>),
}

impl Temperature {
    /// The same as the error model takes it.
    pub fn profile(&self) -> schuler_imu::Temperature<'_> {
        match *self {
            Temperature::Constant(value) => schuler_imu::Temperature::Constant(value),
            Temperature::Ramp { start, rate } => schuler_imu::Temperature::Ramp { start, rate },
            Temperature::WarmUp { start, end, tau } => schuler_imu::Temperature::WarmUp { start, end, tau },
            Temperature::Table(ref points) => schuler_imu::Temperature::Table(points),
        }
    }
}

/// One component of the initial error of the computed state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Initial {
    /// Name of the source, `initial.tilt.n`.
    pub name: &'static str,
    /// Position error north, east, down, m.
    pub position: [f64; 3],
    /// Velocity error north, east, down, m/s.
    pub velocity: [f64; 3],
    /// Attitude error phi north, east, down, rad: C_computed = exp(-[phi ×]) C_true.
    pub phi: [f64; 3],
}

/// How the navigator computes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mechanization {
    /// Frame of the computation.
    pub frame: Frame,
    /// What becomes of the vertical channel.
    pub vertical: Vertical,
    /// Gravity model.
    pub gravity: Gravity,
    /// How updates are made of samples.
    pub coning: Coning,
}

/// Frame of the computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Frame {
    /// Local level, north-east-down.
    T,
    /// Local level without a north: wander azimuth.
    Wander,
    /// Earth-fixed.
    E,
    /// Inertial.
    I,
    /// Local level by the classical first-order update.
    Euler,
}

/// The vertical channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Vertical {
    /// Height and vertical velocity keep their initial values.
    Held,
    /// Unaided: errors grow by e every 570 s.
    Free,
    /// Slaved to the reference height.
    Damped(Damping),
}

/// The baro loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping {
    /// 2 or 3.
    pub order: u8,
    /// Time constant, s, positive.
    pub tau: f64,
}

/// Levelling and heading from specific force and Earth rate averaged over a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Align {
    /// Begin and end of the window, s from the first sample.
    pub window: [f64; 2],
}

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    /// Interval of the rows, s; every sample when absent.
    pub every: Option<f64>,
    /// Kinds of files.
    pub formats: Formats,
    /// Form of `imu.csv`.
    pub imu: Content,
    /// Whether logs are written in the text formats of KF-GINS too.
    pub kf_gins: bool,
}

/// Kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formats {
    /// Tables as CSV.
    pub csv: bool,
    /// Figures as PNG.
    pub png: bool,
    /// Figures as SVG.
    pub svg: bool,
}

/// One expected number.
#[derive(Clone, Debug, PartialEq)]
pub struct Expect {
    /// Column of an output table, `dn_m`.
    pub quantity: String,
    /// Row filter on `source`, where the table has it.
    pub source: Option<String>,
    /// Row filter on `way`, where the table has it.
    pub way: Option<String>,
    /// Which number of the column.
    pub at: Statistic,
    /// Expected value, SI.
    pub value: f64,
    /// Tolerance, SI, not negative.
    pub tolerance: f64,
}

/// Which number of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Statistic {
    /// The row at this time, s.
    Time(f64),
    /// The last row.
    Final,
    /// The largest magnitude.
    Largest,
    /// The root of the mean square.
    Rms,
    /// The mean.
    Mean,
    /// The standard deviation about the mean (n - 1).
    Deviation,
}
