//! `filter:` of `study: navigate` as written. Doc comments go into the schema.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::{
    alignment::written::Form,
    de::At,
    schema::{Sources, Title},
    written::{OneOrThree, Quantity},
};

/// An error-state filter beside the navigator, closed after every measurement.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AidedFilter {
    /// Error sources of the gyros that the filter knows of.
    pub gyro: At<Sources>,
    /// Error sources of the accelerometers that the filter knows of.
    pub accel: At<Sources>,
    /// Standard deviation of the position at the start, one for all axes or three (north, east, down).
    pub position: At<OneOrThree>,
    /// Standard deviation of the velocity at the start.
    pub velocity: At<OneOrThree>,
    /// Standard deviation of the tilt at the start.
    pub tilt: Quantity,
    /// Standard deviation of the heading at the start.
    pub heading: Quantity,
    /// Form of its error dynamics; `phi` when absent.
    pub form: Option<Form>,
    /// Probability with which a good measurement is refused as an outlier, `0.1 %`; none is refused when absent.
    pub gate: Option<Quantity>,
    /// What is measured.
    pub measurements: At<Measurements>,
    /// A trajectory that the result is compared with, at the times that both have.
    pub reference: Option<At<Reference>>,
}

/// What is measured: logs beside the IMU, and what is known of the vehicle.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Measurements {
    /// Position of an antenna: time, latitude, longitude, height.
    pub position: Option<At<Measured>>,
    /// Velocity of an antenna: time, north, east, down.
    pub velocity: Option<At<Measured>>,
    /// Height of an antenna above the ellipsoid: time, height.
    pub height: Option<At<Measured>>,
    /// Heading: time, yaw.
    pub heading: Option<At<Measured>>,
    /// The vehicle stands still.
    pub zero_velocity: Option<At<Condition>>,
    /// The vehicle does not turn.
    pub zero_rate: Option<At<Condition>>,
    /// The vehicle moves only along its forward axis.
    pub non_holonomic: Option<At<Condition>>,
}

/// A log of measurements: CSV or a NumPy array (npy), either also gzipped.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// File; looked up in the data folder (`--data`, `SCHULER_DATA`), then beside the scenario.
    pub file: At<String>,
    /// A format with a name, of a position or a height; it stands for `columns` and `angle`.
    pub format: Option<At<AidFormat>>,
    /// Columns of time (s) and of what is measured, by name or number, `-` before a name turns the sign; those that
    /// `study: simulate` writes when absent.
    pub columns: Option<At<Vec<Title>>>,
    /// What 1 is in a column of angles, `1 deg`; `1 rad` when absent.
    pub angle: Option<Quantity>,
    /// Standard deviation of the noise, one for all axes or three (north, east, down); that of the file's own columns,
    /// named as `study: simulate` names them, when absent.
    pub sigma: Option<At<OneOrThree>>,
    /// Time of the log of the IMU minus time of this log; 0 s when absent.
    pub offset: Option<Quantity>,
    /// Least interval between rows that are used; every row when absent.
    pub every: Option<Quantity>,
    /// From the IMU to the antenna along body x, y, z; zero when absent.
    pub lever_arm: Option<At<[Quantity; 3]>>,
    /// Times in which nothing is used, in the time of the IMU log: `[[100 s, 160 s]]`.
    pub outages: Option<At<Vec<At<[Quantity; 2]>>>>,
}

/// Formats of logs beside that of the IMU.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum AidFormat {
    /// Text of KF-GINS. Measurements have seven columns: second of the GNSS week, latitude and longitude (deg), height (m),
    /// standard deviations north, east, down (m). References have eleven: GNSS week, second, latitude, longitude (deg), height (m),
    /// velocity north, east, down (m/s), roll, pitch, yaw (deg).
    KfGins,
}

/// Something known of the vehicle without an instrument.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// How far the vehicle departs from it, a standard deviation: a velocity, or a rate for `zero_rate`.
    pub sigma: Quantity,
    /// Interval at which it is used; `1 s` when absent.
    pub every: Option<Quantity>,
    /// Times in which it holds, in the time of the IMU log; always when absent.
    pub windows: Option<At<Vec<At<[Quantity; 2]>>>>,
    /// `zero_velocity`, `zero_rate`: it holds when the IMU shows a standstill; always when absent.
    pub detect: Option<At<Detect>>,
    /// `non_holonomic`: from the IMU to the point that does not slip; zero when absent.
    pub lever_arm: Option<At<[Quantity; 3]>>,
}

/// How a standstill is told from the IMU: over the window, the generalized likelihood ratio of Skog, Händel, Nilsson and
/// Rantakokko (IEEE Trans. Biomed. Eng. 57, 2010), divided by six, its mean where the noise is as stated.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Detect {
    /// Length of the window that ends at the sample, of two samples or more.
    pub window: Quantity,
    /// Standard deviation of the noise of a sample of a gyro at a standstill, engine and wind included.
    pub gyro: Quantity,
    /// Standard deviation of the noise of a sample of an accelerometer at a standstill.
    pub accel: Quantity,
    /// How many times the noise as stated a standstill may have; 2 when absent.
    pub threshold: Option<Quantity>,
    /// Speed of the navigator from which on nothing is a standstill: driving straight on a smooth road looks like one to an
    /// IMU. Any speed when absent.
    pub speed: Option<Quantity>,
}

/// A trajectory to compare with: text or a NumPy array (npy), either also gzipped.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// File; looked up in the data folder (`--data`, `SCHULER_DATA`), then beside the scenario.
    pub file: At<String>,
    /// A format with a name; it stands for `columns` and `angle`.
    pub format: Option<At<AidFormat>>,
    /// Columns of time (s), latitude, longitude, height, velocity north, east, down, roll, pitch and yaw, `-` before a
    /// name turns the sign; those of `truth.csv` when absent.
    pub columns: Option<At<Vec<Title>>>,
    /// What 1 is in a column of angles, `1 deg`; `1 rad` when absent.
    pub angle: Option<Quantity>,
    /// Time of the log of the IMU minus time of this log; 0 s when absent.
    pub offset: Option<Quantity>,
}
