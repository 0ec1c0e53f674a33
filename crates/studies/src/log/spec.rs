//! What a scenario says about a log, valid and in SI.

use std::fmt;

use schuler_imu::Instrument;

use super::AxisMap;

/// A recorded log and how to read it.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSpec {
    /// File name, as written: looked up by [`super::find`].
    pub file: String,
    /// Where the data come from, for whoever does not have the file; may be empty.
    pub source: String,
    /// Samples a second, Hz, positive. Every sample covers an interval of 1/rate.
    pub rate: f64,
    /// What a row holds.
    pub content: Content,
    /// Where in a row it stands.
    pub columns: Columns,
    /// What one count is.
    pub scale: Scale,
    /// From sensor axes to body axes.
    pub axes: AxisMap,
    /// The instrument stood still for the whole log: drift can be told from the known point.
    pub stationary: bool,
}

/// What a row of IMU data holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Angle and velocity increments over the interval that ends at the row's time.
    Increments,
    /// Mean angular rate and mean specific force over that interval.
    Rates,
}

impl Content {
    /// The word for it in a scenario.
    pub fn name(&self) -> &'static str {
        match self {
            Content::Increments => "increments",
            Content::Rates => "rates",
        }
    }
}

/// Where the numbers of a row stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Time of the row, where the log has it: it is checked for order and gaps.
    pub time: Option<TimeColumn>,
    /// Gyros along sensor x, y, z: three, or for `study: allan` also fewer, the first axes.
    pub gyro: Vec<ColumnRef>,
    /// Accelerometers along sensor x, y, z, in the same way.
    pub accel: Vec<ColumnRef>,
}

impl Columns {
    /// Those of an instrument.
    pub fn of(&self, instrument: Instrument) -> &[ColumnRef] {
        match instrument {
            Instrument::Gyro => &self.gyro,
            Instrument::Accel => &self.accel,
        }
    }
}

/// A time column and its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeColumn {
    /// Where it stands.
    pub column: ColumnRef,
    /// Seconds per count, positive.
    pub scale: f64,
    /// Whether these are seconds of a GNSS week, which begin anew at its end.
    pub week: bool,
}

/// A column by its name in the header, or by its number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ColumnRef {
    /// Name in the header, white space around it left out.
    Name(String),
    /// Number from 1. A log whose columns all go by number needs no header.
    Number(usize),
}

impl fmt::Display for ColumnRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ColumnRef::Name(name) => f.write_str(name),
            ColumnRef::Number(number) => write!(f, "column {number}"),
        }
    }
}

/// What one count of a column is, sensor x, y, z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// rad (increments) or rad/s (rates).
    pub gyro: [f64; 3],
    /// m/s (increments) or m/s² (rates).
    pub accel: [f64; 3],
}

impl Scale {
    /// That of an instrument.
    pub fn of(&self, instrument: Instrument) -> [f64; 3] {
        match instrument {
            Instrument::Gyro => self.gyro,
            Instrument::Accel => self.accel,
        }
    }
}
