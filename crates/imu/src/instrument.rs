//! The two instruments of an IMU.

use core::fmt;

use crate::Unit;

/// A triad of three sensors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Instrument {
    /// Gyroscopes: measure angular rate, rad/s.
    Gyro,
    /// Accelerometers: measure specific force, m/s².
    Accel,
}

impl Instrument {
    /// Both instruments, gyroscopes first.
    pub const ALL: [Instrument; 2] = [Instrument::Gyro, Instrument::Accel];

    /// `gyro` or `accel`.
    pub const fn name(self) -> &'static str {
        match self {
            Instrument::Gyro => "gyro",
            Instrument::Accel => "accel",
        }
    }

    /// Unit of the measured quantity: rad/s or m/s².
    pub const fn unit(self) -> Unit {
        match self {
            Instrument::Gyro => Unit::RATE,
            Instrument::Accel => Unit::FORCE,
        }
    }
}

impl fmt::Display for Instrument {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}
