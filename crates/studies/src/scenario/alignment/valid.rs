//! `study: align` as valid.

use schuler_imu::Spec;
use schuler_strapdown::align::{AnyHeadingNoise, Solution, Vectors};
use schuler_strapdown::filter::Form;

use super::super::valid::{Imu, Mechanization, Start};
use super::super::valid_motion::Motion;
use crate::log::LogSpec;

/// `study: align`.
#[derive(Clone, Debug, PartialEq)]
pub struct AlignStudy {
    /// Where it stands; of a simulation also how.
    pub start: Start,
    /// Where the samples come from.
    pub origin: Origin,
    /// Gravity and vertical channel of methods that navigate, and of what is navigated afterwards.
    pub mechanization: Mechanization,
    /// Methods side by side.
    pub methods: Vec<Method>,
    /// Where methods that refine an attitude get it from.
    pub coarse: Option<Coarse>,
    /// What is known of the velocity of the base.
    pub velocity: Velocity,
    /// A jump of the attitude that the gyros miss.
    pub knock: Option<Knock>,
    /// Number of runs, positive.
    pub runs: u64,
    /// Samples that are navigated afterwards.
    pub navigate: u64,
}

/// Where the samples come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A simulated instrument on a simulated base.
    Simulated {
        /// What the base does.
        motion: Motion,
        /// The instrument with its true errors.
        imu: Box<Imu>,
        /// Samples of the alignment.
        samples: u64,
    },
    /// A recorded log, cut into windows of so many samples.
    Log {
        /// The log.
        log: LogSpec,
        /// Samples of a window.
        window: u64,
    },
}

impl AlignStudy {
    /// Samples a second.
    pub fn rate(&self) -> f64 {
        match &self.origin {
            Origin::Simulated { imu, .. } => imu.rate,
            Origin::Log { log, .. } => log.rate,
        }
    }

    /// Samples of one alignment.
    pub fn samples(&self) -> u64 {
        match &self.origin {
            Origin::Simulated { samples, .. } => *samples,
            Origin::Log { window, .. } => *window,
        }
    }
}

/// A method with its name in results.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    /// Unique among the methods.
    pub name: String,
    /// What is done.
    pub kind: MethodKind,
}

/// What a method does.
#[derive(Clone, Debug, PartialEq)]
pub enum MethodKind {
    /// Two averaged vectors.
    Triad(Vectors),
    /// Gravity in inertial space, with the latitude known or not.
    Inertial {
        /// What is laid upon what.
        solution: Solution,
        /// Whether the latitude is taken from the start.
        latitude_known: bool,
    },
    /// The classical loop with this time constant, s.
    Gyrocompass(f64),
    /// A filter for any heading.
    AnyHeading(AnyHeadingNoise),
    /// An error-state Kalman filter.
    Filter(Box<FilterSettings>),
}

/// What a filter takes as given.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterSettings {
    /// Error sources that it knows of.
    pub spec: Spec,
    /// Standard deviations at the start: tilt and heading, rad; velocity, m/s.
    pub tilt: f64,
    /// Heading, rad.
    pub heading: f64,
    /// Velocity, m/s.
    pub velocity: f64,
    /// Of one measurement, m/s or m.
    pub noise: f64,
    /// Standard deviation and correlation time (s) of correlated noise that it has states for.
    pub coloured: Option<(f64, f64)>,
    /// Whether it measures the position in place of the velocity.
    pub position: bool,
    /// Tilt and heading (rad) of the prior that caps fading; those of the start when absent.
    pub bound: Option<[f64; 2]>,
    /// Form of its error dynamics.
    pub form: Form,
    /// How it adapts.
    pub strategy: Strategy,
}

/// How a filter adapts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strategy {
    /// What is adapted.
    pub kind: StrategyKind,
    /// Whether fading is capped by the prior.
    pub cap: bool,
}

/// What a filter adapts, and by what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StrategyKind {
    /// Nothing.
    Plain,
    /// Its covariance by a constant factor.
    Fading(f64),
    /// Its covariance by one factor; with the probability of a false alarm.
    SingleFactor(f64),
    /// Its covariance by one factor a channel; with the probability of a false alarm.
    MultipleFading(f64),
    /// Its covariance by strong tracking; with the softening factor.
    StrongTracking(f64),
    /// Its covariance by variable forgetting; with the number of measurements remembered.
    Forgetting(f64),
    /// The measurement noise by residuals.
    ResidualNoise,
    /// The measurement noise by sums of residuals; with the updates of a batch.
    BatchNoise(usize),
    /// The measurement noise by recursion; with the forgetting factor.
    SageHusa(f64),
}

/// Where a coarse attitude comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coarse {
    /// The truth with the error phi, rad.
    Value([f64; 3]),
    /// The truth with errors of these standard deviations, rad: tilt, heading.
    Sigma([f64; 2]),
    /// TRIAD over so many samples.
    Triad(u64),
    /// Alignment in inertial space over so many samples.
    Inertial(u64),
}

/// What is known of the velocity of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Velocity {
    /// Samples between measurements.
    pub every: u64,
    /// White, m/s.
    pub noise: f64,
    /// Standard deviation (m/s) and correlation time (s) of first-order Gauss-Markov noise.
    pub coloured: Option<(f64, f64)>,
    /// Begin and end (s) and factor of a time in which noise is larger.
    pub burst: Option<([f64; 2], f64)>,
}

/// A jump of the attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knock {
    /// Samples before it.
    pub at: u64,
    /// Rotation vector, rad, resolved in t.
    pub phi: [f64; 3],
}
