//! `alignment:` as written. Doc comments go into the schema.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::{de::At, schema::Sources, written::Quantity};

/// Methods of alignment side by side, what they start from, and what they measure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Alignment {
    /// The methods, each with its settings.
    pub methods: At<Vec<At<Method>>>,
    /// Where methods that refine an attitude get it from; the `filter` and `gyrocompass` need it.
    pub coarse: Option<At<Coarse>>,
    /// The velocity that is known of the base: zero, with noise. Without it methods that measure it take it as exact.
    pub velocity: Option<At<Velocity>>,
    /// A jump of the attitude that the gyros miss.
    pub knock: Option<At<Knock>>,
    /// What the filters take as given, unless a method says otherwise.
    pub filter: Option<At<Filter>>,
    /// Number of runs, each with its own draws; 1 when absent.
    pub runs: Option<At<u64>>,
    /// How long each method's result is navigated afterwards, free inertial.
    pub navigate: Option<Quantity>,
    /// Of a log: length of the windows that are aligned one by one, from its beginning on.
    pub window: Option<Quantity>,
}

/// A method of alignment.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Two vectors averaged over the whole time.
    Triad(Triad),
    /// Gravity in inertial space.
    Inertial(Inertial),
    /// The classical loop, from the coarse attitude.
    Gyrocompass(Gyrocompass),
    /// A filter with zero velocity that needs no heading to begin with.
    AnyHeading(AnyHeading),
    /// An error-state Kalman filter with zero velocity, from the coarse attitude.
    Filter(Box<Filter>),
}

/// Two averaged vectors.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Triad {
    /// Name in results; `triad` with the order when absent.
    pub name: Option<String>,
    /// Which vector is trusted first; `force_first` when absent.
    pub order: Option<Order>,
}

/// Which vector is trusted first.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// Specific force: level by the accelerometers alone.
    ForceFirst,
    /// Earth rate.
    RateFirst,
    /// Neither: the inverse of the three vectors, and the rotation nearest to it.
    Inverse,
}

/// Gravity in inertial space.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Inertial {
    /// Name in results; `inertial` with the solution when absent.
    pub name: Option<String>,
    /// What is laid upon what.
    pub solution: Solution,
    /// Whether the latitude is known; `known` when absent.
    pub latitude: Option<Latitude>,
}

/// What is laid upon what.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Solution {
    /// Velocity at half time and at the end.
    Velocity,
    /// Position at half time and at the end.
    Position,
    /// All velocities, least squares.
    Optimal,
}

/// Whether the latitude is known.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Latitude {
    /// Taken from `start.position`.
    Known,
    /// Found with the attitude.
    Unknown,
}

/// The classical loop.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gyrocompass {
    /// Name in results; `gyrocompass` when absent.
    pub name: Option<String>,
    /// Time constant; the loop settles in ten of them.
    pub tau: Quantity,
}

/// A filter for any heading: velocity, tilts and Earth rate in a level frame.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnyHeading {
    /// Name in results; `any heading` when absent.
    pub name: Option<String>,
    /// Standard deviation of the tilt of the level that the first measurement interval shows.
    pub tilt: Quantity,
    /// Standard deviation of one measurement of the velocity.
    pub noise: Quantity,
    /// Angle random walk of the gyros.
    pub angle_random_walk: Quantity,
    /// Velocity random walk of the accelerometers.
    pub velocity_random_walk: Quantity,
}

/// What a filter takes as given. What a method leaves out it has from `alignment.filter`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Filter {
    /// Name in results; `filter` when absent.
    pub name: Option<String>,
    /// Error sources of the gyros that the filter knows of.
    pub gyro: Option<At<Sources>>,
    /// Error sources of the accelerometers that the filter knows of.
    pub accel: Option<At<Sources>>,
    /// Standard deviation of the tilt at the start.
    pub tilt: Option<Quantity>,
    /// Standard deviation of the heading at the start.
    pub heading: Option<Quantity>,
    /// Standard deviation of the velocity at the start.
    pub velocity: Option<Quantity>,
    /// Standard deviation of one measurement: of the velocity, or of the position.
    pub noise: Option<Quantity>,
    /// Correlated noise of the measurement that the filter knows of, with states for it; none when absent.
    pub coloured: Option<At<Coloured>>,
    /// What it measures; `velocity` when absent.
    pub measurement: Option<Measurement>,
    /// Form of its error dynamics; `phi` when absent.
    pub form: Option<Form>,
    /// Standard deviations of the attitude in the prior that caps fading, where that of the filter itself (`tilt`, `heading`, which
    /// holds when absent) is not to be believed.
    pub bound: Option<At<CoarseSigma>>,
    /// How it adapts; not at all when absent.
    pub strategy: Option<At<Strategy>>,
}

/// What a filter measures.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Measurement {
    /// Velocity, which is zero.
    Velocity,
    /// Position, which stays where it is.
    Position,
}

/// Form of the error dynamics.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// Errors against the true local level frame.
    Phi,
    /// Errors against the frame of the computed place.
    Psi,
}

/// How a filter adapts to what its innovations show. Windows hold thirty innovations.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Strategy {
    /// A constant factor on the covariance (Sorenson and Sacks 1971).
    Fading(Fading),
    /// One factor from the windowed innovations.
    SingleFactor(Windowed),
    /// One factor a channel from the windowed innovations (Geng and Wang 2008; Gao and Miao 2011).
    MultipleFading(Windowed),
    /// Strong tracking (Zhou and Frank 1996).
    StrongTracking(StrongTracking),
    /// Variable forgetting with bounded information (Fortescue, Kershenbaum and Ydstie 1981).
    Forgetting(Forgetting),
    /// Measurement noise from the windowed residuals (Mehra 1972).
    ResidualNoise,
    /// Measurement noise from sums of residuals, which see its colour (Fishman 1978).
    BatchNoise(BatchNoise),
    /// Measurement noise by recursion over all innovations (Sage and Husa 1969).
    SageHusa(SageHusa),
}

/// A constant factor.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fading {
    /// Factor on the covariance a measurement, a little above 1.
    pub factor: Quantity,
    /// Whether fading is capped by the prior (and `bound`); true when absent.
    pub cap: Option<bool>,
}

/// Batches of residuals.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BatchNoise {
    /// Measurements in a batch, about half as many as the noise is correlated over; 5 when absent.
    pub length: Option<At<u64>>,
}

/// Factors from a window of innovations.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Windowed {
    /// Probability with which a consistent filter would be taken for a wrong one; `0.1 %` when absent.
    pub gate: Option<Quantity>,
    /// Whether fading is capped by the prior (and `bound`); true when absent.
    pub cap: Option<bool>,
}

/// Strong tracking.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StrongTracking {
    /// Softening factor, 1 or more.
    pub beta: Quantity,
    /// Whether fading is capped by the prior (and `bound`); true when absent.
    pub cap: Option<bool>,
}

/// Variable forgetting.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Forgetting {
    /// Number of measurements that are remembered.
    pub memory: Quantity,
    /// Whether no variance grows above that of the start; true when absent.
    pub cap: Option<bool>,
}

/// Measurement noise by recursion.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SageHusa {
    /// Forgetting factor, `0.95` to `0.99` by custom.
    pub forgetting: Quantity,
}

/// Where a coarse attitude comes from.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Coarse {
    /// The truth with these errors.
    Value(CoarseValue),
    /// The truth with errors drawn in each run.
    Sigma(CoarseSigma),
    /// TRIAD, specific force first, over the first part of the time.
    Triad(CoarseWindow),
    /// Gravity in inertial space over the first part of the time.
    Inertial(CoarseWindow),
}

/// Errors of a coarse attitude.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoarseValue {
    /// About north and about east.
    pub tilt: At<[Quantity; 2]>,
    /// About down.
    pub heading: Quantity,
}

/// Standard deviations of an attitude.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoarseSigma {
    /// About north and about east.
    pub tilt: Quantity,
    /// About down.
    pub heading: Quantity,
}

/// How long a coarse method takes.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoarseWindow {
    /// From the beginning on.
    pub window: Quantity,
}

/// The velocity that is known of the base.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Velocity {
    /// Interval of the measurements.
    pub every: Quantity,
    /// Standard deviation of one measurement, white.
    pub noise: Option<Quantity>,
    /// Noise that is correlated in time, beside the white.
    pub coloured: Option<At<Coloured>>,
    /// A time in which all noise is larger.
    pub burst: Option<At<Burst>>,
}

/// First-order Gauss-Markov noise.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coloured {
    /// Standard deviation.
    pub sigma: Quantity,
    /// Correlation time.
    pub tau: Quantity,
}

/// A time in which noise is larger.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Burst {
    /// Begin and end.
    pub window: At<[Quantity; 2]>,
    /// By how much.
    pub factor: Quantity,
}

/// A jump of the attitude that the gyros miss: a shock beyond their range, a mounting that gives way.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Knock {
    /// When.
    pub at: Quantity,
    /// About north and about east.
    pub tilt: At<[Quantity; 2]>,
    /// About down.
    pub heading: Quantity,
}
