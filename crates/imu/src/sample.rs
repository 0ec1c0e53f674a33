use crate::readout::Status;

/// One output of the IMU, along sensor axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Length of the interval, s. The sample belongs to its end.
    pub dt: f64,
    /// Measured increment of angle: integral of the rate over the interval, rad.
    pub dtheta: [f64; 3],
    /// Measured increment of velocity: integral of the specific force over the interval, m/s.
    pub dv: [f64; 3],
    /// Measured minus true angular rate, mean over the interval, rad/s.
    pub omega_error: [f64; 3],
    /// Measured minus true specific force, mean over the interval, m/s².
    pub f_error: [f64; 3],
    /// What the readout did to the gyroscopes' sample.
    pub gyro: Status,
    /// What the readout did to the accelerometers' sample.
    pub accel: Status,
}

impl Sample {
    /// Measured angular rate, mean over the interval, rad/s.
    pub fn omega(&self) -> [f64; 3] {
        self.dtheta.map(|d| d / self.dt)
    }

    /// Measured specific force, mean over the interval, m/s².
    pub fn f(&self) -> [f64; 3] {
        self.dv.map(|d| d / self.dt)
    }
}
