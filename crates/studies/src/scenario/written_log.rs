//! `log:` as written. Doc comments go into the schema.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    de::At,
    schema::Title,
    written::{OneOrThree, Quantity},
};

/// A recorded IMU log: CSV or a NumPy array (npy), either also gzipped.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Log {
    /// File; looked up in the data folder (`--data`, `SCHULER_DATA`), then beside the scenario.
    pub file: At<String>,
    /// Where the data come from, for whoever does not have the file.
    pub source: Option<String>,
    /// Samples a second.
    pub rate: Quantity,
    /// A format with a name; it stands for `content`, `columns` and, but for `novatel`, `scale`.
    pub format: Option<At<LogFormat>>,
    /// What a row holds: `increments` (integrals over the interval that ends at the row's time) or `rates`.
    pub content: Option<At<Content>>,
    /// Where in a row the numbers stand.
    pub columns: Option<At<Columns>>,
    /// What one count of a column is: `{ gyro: 0.1 arcsec, accel: 1 mm/s }`; one for the instrument or three.
    pub scale: Option<At<Scales>>,
    /// Sensor axis that points along body x (forward), y (right) and z (down): `[y, x, -z]`; when absent `[x, y, z]`, or
    /// what the format says.
    pub axes: Option<At<[At<String>; 3]>>,
    /// Whether the instrument stood still at `start.position` all the time, so that drift can be told; false when absent.
    pub stationary: Option<bool>,
}

/// Formats of logs of an IMU.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum LogFormat {
    /// Text of KF-GINS: second of the GNSS week, angle increments x, y, z (rad), velocity increments x, y, z (m/s), axes forward,
    /// right, down; further columns are not read.
    KfGins,
    /// RAWIMUSA or RAWIMUA messages of a NovAtel receiver, other messages between them are skipped: counts of increments
    /// along x, -y, z of an IMU with x right, y forward, z up, so that `axes` is `[y, x, -z]` when absent. `scale` is that
    /// of the IMU, from the receiver's manual: HG1700 AG58 2^-33 rad and 2^-27 ft/s (`{ gyro: 1.1641532182693481e-10 rad,
    /// accel: 2.2709415078163147e-9 m/s }`), LN-200 2^-19 rad and 2^-14 m/s.
    Novatel,
}

/// What a row of a log holds.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Content {
    /// Angle and velocity increments over the interval that ends at the row's time.
    Increments,
    /// Angular rate and specific force.
    Rates,
}

/// Columns of a log.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Columns {
    /// Time, where the log has it; it is checked for gaps and order.
    pub time: Option<Title>,
    /// Gyro x, y, z; `study: allan` also takes fewer axes, or none.
    #[schemars(length(min = 1, max = 3))]
    pub gyro: Option<At<Vec<Title>>>,
    /// Accelerometer x, y, z; `study: allan` also takes fewer axes, or none.
    #[schemars(length(min = 1, max = 3))]
    pub accel: Option<At<Vec<Title>>>,
}

/// What one count of a column is.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scales {
    /// Angle (increments) or angular rate (rates) of one count.
    pub gyro: Option<At<OneOrThree>>,
    /// Velocity (increments) or specific force (rates) of one count.
    pub accel: Option<At<OneOrThree>>,
    /// Time of one count of the time column; `1 s` when absent.
    pub time: Option<Quantity>,
}
