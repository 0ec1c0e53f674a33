//! The scenario as written: keys and words are right, quantities are text. Doc comments go into the schema.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    aided::written::AidedFilter,
    alignment::written::Alignment,
    budget::written::Budget,
    de::At,
    monte_carlo::written::MonteCarlo,
    schema::{Scalar, Sources},
    written_motion::{Aiding, Motion},
};

pub use super::written_log::{Content, Log, LogFormat};

/// A quantity with its unit, `0.01 deg/h`; a number alone where it has no dimension.
pub type Quantity = At<Scalar>;

/// A scenario of Schuler: what is simulated or read, how it navigates, what is written.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Version of the format: 1.
    pub schuler: At<u64>,
    /// Which study.
    pub study: At<StudyKind>,
    /// Title of tables and figures.
    pub title: String,
    /// Place, time, attitude and velocity at t = 0.
    pub start: Option<At<Start>>,
    /// What the instrument goes through.
    pub motion: Option<At<Motion>>,
    /// Duration, `24 h`.
    pub duration: Option<Quantity>,
    /// The instrument and its errors.
    pub imu: Option<At<Imu>>,
    /// Errors of the computed state at t = 0, computed minus true.
    pub initial_errors: Option<At<InitialErrors>>,
    /// Field in which the motion happens; where the study navigates, `mechanization` has it.
    pub gravity: Option<At<Gravity>>,
    /// Measurements beside the IMU.
    pub aiding: Option<At<Aiding>>,
    /// How it navigates.
    pub mechanization: Option<At<Mechanization>>,
    /// The recorded log.
    pub log: Option<At<Log>>,
    /// How the initial attitude is found from the log.
    pub align: Option<At<Align>>,
    /// Measurements beside the log, and the filter that takes them.
    pub filter: Option<At<AidedFilter>>,
    /// Methods of alignment and what they work with.
    pub alignment: Option<At<Alignment>>,
    /// What an error budget asks.
    pub budget: Option<At<Budget>>,
    /// How many runs there are, and what is asked of them.
    pub monte_carlo: Option<At<MonteCarlo>>,
    /// What is written, and how often.
    pub output: Option<At<Output>>,
    /// What the result is expected to be; checked by `run`.
    #[serde(default)]
    pub expect: Vec<At<Expect>>,
    /// Master seed of every random draw; 1 when absent.
    pub seed: Option<At<u64>>,
}

/// The kinds of study.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum StudyKind {
    /// Sensor errors only.
    Imu,
    /// Each error source alone and all together, at rest, beside closed forms.
    Drift,
    /// A recorded log.
    Navigate,
    /// Allan deviations of a recorded log, and the error model in them.
    Allan,
    /// Methods of alignment side by side, beside their analytic limits.
    Align,
    /// A motion: its truth, ideal and corrupted IMU log, and aiding measurements.
    Simulate,
    /// The share of each error source in the errors of the navigator, several ways side by side.
    Budget,
    /// Many runs of the full navigator, each with its own draws, beside the covariance.
    MonteCarlo,
}

/// Place, time, attitude and velocity at t = 0.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// Date and time with time scale, `2026-01-01T00:00:00 UTC`.
    pub epoch: Option<At<String>>,
    /// Geodetic `{ lat, lon, h }` or Earth-fixed `{ x, y, z }`.
    pub position: At<Position>,
    /// Level and to the north when absent.
    pub attitude: Option<At<Attitude>>,
    /// At rest when absent.
    pub velocity: Option<At<Velocity>>,
}

/// WGS 84 position, geodetic (`lat`, `lon`, `h`) or Earth-fixed (`x`, `y`, `z`).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Position {
    /// Geodetic latitude, north positive.
    pub lat: Option<Quantity>,
    /// Longitude, east positive.
    pub lon: Option<Quantity>,
    /// Height above the ellipsoid.
    pub h: Option<Quantity>,
    /// Earth-fixed x, towards latitude 0, longitude 0.
    pub x: Option<Quantity>,
    /// Earth-fixed y.
    pub y: Option<Quantity>,
    /// Earth-fixed z, towards the north pole.
    pub z: Option<Quantity>,
}

/// Euler angles of the yaw-pitch-roll sequence, local level north-east-down to forward-right-down.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attitude {
    /// About the forward axis, right side down positive.
    pub roll: Quantity,
    /// Nose up positive, within ±90 deg.
    pub pitch: Quantity,
    /// Clockwise from north.
    pub yaw: Quantity,
}

/// Velocity over ground.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Velocity {
    /// North.
    pub n: Quantity,
    /// East.
    pub e: Quantity,
    /// Down.
    pub d: Quantity,
}

/// Three gyros and three accelerometers along x, y, z of the body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Imu {
    /// Samples a second, `100 Hz`.
    pub rate: Quantity,
    /// A device or grade whose error sources come before those below; `schuler presets` lists them.
    pub preset: Option<At<String>>,
    /// Error sources of the gyros.
    #[serde(default)]
    pub gyro: Sources,
    /// Error sources of the accelerometers.
    #[serde(default)]
    pub accel: Sources,
    /// Temperature of the run; 20 degC when absent.
    pub temperature: Option<At<Temperature>>,
    /// Temperature at which the thermal terms vanish; 20 degC when absent.
    pub calibration_temperature: Option<Quantity>,
    /// What happens to the sum of input and errors before it is a sample; nothing when absent.
    pub readout: Option<At<Readout>>,
}

/// Temperature as a function of time. Temperatures are absolute, `35 degC` or `308.15 K`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Temperature {
    /// Always the same.
    Constant(Quantity),
    /// From `start` on at a constant rate.
    Ramp(Ramp),
    /// Exponentially from `start` to `end`.
    WarmUp(WarmUp),
    /// Points `[time, temperature]` with straight lines between them, constant outside of them.
    Table(At<Vec<At<[Quantity; 2]>>>),
}

/// A temperature that changes at a constant rate.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// Temperature at t = 0.
    pub start: Quantity,
    /// Rate, `1 K/min`.
    pub rate: Quantity,
}

/// An exponential warm-up.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WarmUp {
    /// Temperature at t = 0.
    pub start: Quantity,
    /// Temperature at last.
    pub end: Quantity,
    /// Time constant.
    pub tau: Quantity,
}

/// Readout of both instruments.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Readout {
    /// Of the gyros.
    pub gyro: Option<At<Channel>>,
    /// Of the accelerometers.
    pub accel: Option<At<Channel>>,
}

/// Readout of one instrument, in this order: bandwidth, time of sampling, range, least significant bit, faults.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Channel {
    /// Second-order low pass; unlimited when absent.
    pub bandwidth: Option<At<Bandwidth>>,
    /// Whether a sample is the mean over its interval or, with a bandwidth, the value at its end; `mean` when absent.
    pub sampling: Option<At<Sampling>>,
    /// When a sample is taken, against the time that it claims. Different delays make the instruments asynchronous.
    pub timing: Option<At<Timing>>,
    /// Largest input that is measured, `400 deg/s`, one for all axes or three; beyond it samples are clamped and flagged.
    pub range: Option<At<OneOrThree>>,
    /// Smallest input that is measured; minus the largest when absent.
    pub range_low: Option<At<OneOrThree>>,
    /// Rounding to a least significant bit.
    pub lsb: Option<At<Lsb>>,
    /// What the device puts out, and so what is rounded; `increments` when absent.
    pub output: Option<At<Content>>,
    /// Samples that get lost on the way.
    pub faults: Option<At<Faults>>,
}

/// A second-order low pass.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bandwidth {
    /// Undamped natural frequency.
    pub natural_frequency: Quantity,
    /// Damping ratio; 0.7071 puts the -3 dB point at the natural frequency.
    pub damping: Quantity,
}

/// What of its interval a sample is.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Sampling {
    /// Mean over the interval.
    Mean,
    /// Value of the low pass at its end.
    Point,
}

/// When a sample is taken.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// A sample of time t covers the interval that ended this much before; 0 s when absent.
    pub delay: Option<Quantity>,
    /// Standard deviation of the delay from sample to sample; 0 s when absent.
    pub jitter: Option<Quantity>,
}

/// Rounding to a least significant bit.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lsb {
    /// Size, one for all axes or three: an angle and a velocity of increments, a rate and a specific force of rates.
    pub size: At<OneOrThree>,
    /// Whether the remainder is carried to the next sample; false when absent.
    pub carry: Option<bool>,
}

/// Samples that get lost; probabilities are per sample and 0 when absent.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Faults {
    /// Probability that a sample is lost: its increments are zero.
    pub drop: Option<Quantity>,
    /// Probability that the sample before comes once more instead.
    pub repeat: Option<Quantity>,
    /// Probability that the output gets stuck at the sample before.
    pub stick: Option<Quantity>,
    /// For how many samples it then is stuck.
    pub stuck_samples: Option<At<u64>>,
}

/// Errors of the computed state at t = 0, computed minus true.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialErrors {
    /// Tilt about north and about east.
    pub tilt: Option<At<[Quantity; 2]>>,
    /// Rotation about down.
    pub heading: Option<Quantity>,
    /// North, east, down.
    pub velocity: Option<At<[Quantity; 3]>>,
    /// North, east, down, in metres.
    pub position: Option<At<[Quantity; 3]>>,
}

/// How it navigates.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mechanization {
    /// Frame of the computation: `t`, `wander`, `e`, `i`, or `euler`.
    pub frame: At<Frame>,
    /// The vertical channel: `held`, `free`, or `{ damped: { order: 3, tau: 100 s } }`.
    pub vertical: At<Vertical>,
    /// Gravity model.
    pub gravity: At<Gravity>,
    /// How updates are made of samples, against coning and sculling; `one` when absent.
    pub coning: Option<At<Coning>>,
}

/// How many samples make an update.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Coning {
    /// Each sample is an update.
    One,
    /// Each sample is an update that knows the sample before.
    Previous,
    /// Two samples.
    Two,
    /// Three samples.
    Three,
    /// Four samples.
    Four,
}

/// Frame of the computation.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Frame {
    /// Local level, north-east-down; not over the poles.
    T,
    /// Local level that does not follow north (wander azimuth): over the poles too.
    Wander,
    /// Earth-fixed.
    E,
    /// Inertial.
    I,
    /// Local level by the classical first-order update, to show what it costs.
    Euler,
}

/// The vertical channel.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Vertical {
    /// Height and vertical velocity keep their initial values.
    Held,
    /// Unaided: errors grow by e every 570 s.
    Free,
    /// Slaved to the reference height.
    Damped(Damping),
}

/// The loop that slaves the vertical channel to the reference height.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// 2 or 3.
    pub order: At<u64>,
    /// Time constant, `100 s`.
    pub tau: Quantity,
}

/// Gravity model.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Gravity {
    /// The exact field of the level ellipsoid.
    Normal,
    /// Somigliana's formula, straight down, second order in height.
    Somigliana,
}

/// One quantity for all axes, or a list of three.
pub type OneOrThree = super::schema::OneOrMore;

/// How the initial attitude is found from the log.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Align {
    /// The method.
    pub method: At<Method>,
    /// Begin and end of the window from the first sample, `[0 s, 300 s]`.
    pub window: At<[Quantity; 2]>,
}

/// Alignment methods.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Averages of specific force (trusted first) and angular rate.
    Triad,
}

/// What is written, and how often.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Interval of the rows, `60 s`; every sample when absent.
    pub every: Option<Quantity>,
    /// `csv`, `png`, `svg`; `[csv, png]` when absent.
    pub formats: Option<At<Vec<At<Format>>>>,
    /// Form of `imu.csv`; `rates` when absent.
    pub imu: Option<Content>,
    /// Whether the study `imu` draws Allan deviations of its errors beside those of theory; false when absent.
    pub allan: Option<At<bool>>,
    /// Formats in which the study `simulate` writes its logs once more: `[kf_gins]`; none when absent.
    pub logs: Option<At<Vec<At<TextLogs>>>>,
}

/// Text formats of other programs.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TextLogs {
    /// `imu.txt`, `gnss.txt` (where a position is measured) and `truth.nav` for KF-GINS.
    KfGins,
}

/// Kinds of files.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Format {
    /// Tables.
    Csv,
    /// Figures as pictures.
    Png,
    /// Figures as drawings.
    Svg,
}

/// One expected number.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// A column of the output, `dn_m`.
    pub quantity: At<String>,
    /// Which rows, by their `source`.
    pub source: Option<String>,
    /// Which rows, by their `way`.
    pub way: Option<At<String>>,
    /// A time, or `final`, `largest` (magnitude), `rms`, `mean`, `sd`.
    pub at: At<String>,
    /// Expected value.
    pub value: Quantity,
    /// Tolerance in the unit of the value, or relative: `0.1 %`.
    pub tolerance: Quantity,
}
