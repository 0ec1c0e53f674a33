//! What really happens to the IMU over a sample interval, and what a term sees of it.

use crate::Instrument;
use crate::random::STEPS;

/// True motion and environment over one sample interval, along sensor axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Rate and specific force.
    pub motion: Motion,
    /// Angular acceleration, mean over the interval, rad/s². Only lever-arm effects need it.
    pub omega_dot: [f64; 3],
    /// Temperature, mean over the interval, K.
    pub temperature: f64,
    /// Rate of the temperature, K/s.
    pub temperature_rate: f64,
    /// Mean square of the vibration that the mean specific force does not show, per axis, (m/s²)².
    pub vibration: [f64; 3],
}

/// Motion over one sample interval, as means or as increments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Means over the interval: angular rate (rad/s) and specific force (m/s²).
    Rates {
        /// Mean angular rate with respect to inertial space, rad/s.
        omega: [f64; 3],
        /// Mean specific force, m/s².
        f: [f64; 3],
    },
    /// Integrals over the interval: of angular rate (rad) and of specific force (m/s).
    Increments {
        /// Integral of the angular rate, rad.
        dtheta: [f64; 3],
        /// Integral of the specific force along the turning sensor axes, m/s.
        dv: [f64; 3],
    },
}

impl Truth {
    /// Temperature of a `Truth` that states none: 20 °C.
    pub const TEMPERATURE: f64 = 293.15;

    /// From the means over the interval of angular rate (rad/s) and specific force (m/s²).
    pub const fn rates(omega: [f64; 3], f: [f64; 3]) -> Truth {
        Truth::of(Motion::Rates { omega, f })
    }

    /// From the integrals over the interval of angular rate (rad) and of specific force (m/s).
    pub const fn increments(dtheta: [f64; 3], dv: [f64; 3]) -> Truth {
        Truth::of(Motion::Increments { dtheta, dv })
    }

    const fn of(motion: Motion) -> Truth {
        Truth {
            motion,
            omega_dot: [0.0; 3],
            temperature: Truth::TEMPERATURE,
            temperature_rate: 0.0,
            vibration: [0.0; 3],
        }
    }

    /// Means over an interval of `dt` seconds of angular rate (rad/s) and specific force (m/s²).
    #[inline(always)]
    fn means(&self, dt: f64) -> ([f64; 3], [f64; 3]) {
        match self.motion {
            Motion::Rates { omega, f } => (omega, f),
            Motion::Increments { dtheta, dv } => (dtheta.map(|d| d / dt), dv.map(|d| d / dt)),
        }
    }

    /// The same at `temperature` (K) that changes by `rate` (K/s).
    pub const fn with_temperature(mut self, temperature: f64, rate: f64) -> Truth {
        self.temperature = temperature;
        self.temperature_rate = rate;
        self
    }

    /// The same with angular acceleration `omega_dot`, rad/s².
    pub const fn with_omega_dot(mut self, omega_dot: [f64; 3]) -> Truth {
        self.omega_dot = omega_dot;
        self
    }

    /// The same with vibration of mean square `vibration` per axis, (m/s²)².
    pub const fn with_vibration(mut self, vibration: [f64; 3]) -> Truth {
        self.vibration = vibration;
        self
    }
}

/// What a term may depend on: means over the sample interval, along sensor axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// The instrument's own input: `omega` for gyroscopes, `f` for accelerometers.
    pub u: [f64; 3],
    /// Angular rate with respect to inertial space, rad/s.
    pub omega: [f64; 3],
    /// Specific force, m/s².
    pub f: [f64; 3],
    /// Angular acceleration, rad/s².
    pub omega_dot: [f64; 3],
    /// Temperature minus calibration temperature, K.
    pub delta_t: f64,
    /// Rate of the temperature, K/s.
    pub temperature_rate: f64,
    /// Mean square of vibration per axis, (m/s²)².
    pub vibration: [f64; 3],
}

impl Input {
    /// What `instrument`, calibrated at `calibration` (K), sees of `truth` over an interval of `dt` seconds.
    pub fn new(instrument: Instrument, truth: &Truth, dt: f64, calibration: f64) -> Input {
        let (omega, f) = truth.means(dt);
        Input {
            u: match instrument {
                Instrument::Gyro => omega,
                Instrument::Accel => f,
            },
            omega,
            f,
            omega_dot: truth.omega_dot,
            delta_t: truth.temperature - calibration,
            temperature_rate: truth.temperature_rate,
            vibration: truth.vibration,
        }
    }
}

/// Inputs of eight steps, of each number its values in the steps; both instruments see the same.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Inputs {
    omega: [[f64; STEPS]; 3],
    f: [[f64; STEPS]; 3],
    omega_dot: [[f64; STEPS]; 3],
    delta_t: [f64; STEPS],
    temperature_rate: [f64; STEPS],
    vibration: [[f64; STEPS]; 3],
}

/// Eight consecutive intervals as the terms take them: made once for all instruments that go through them, see
/// [`Imu::octets`](crate::Imu::octets).
#[derive(Clone, Debug)]
pub struct Octet {
    truths: [Truth; STEPS],
    pub(crate) dt: f64,
    pub(crate) calibration: f64,
    pub(crate) inputs: Inputs,
    /// Of the rate and of the force, the increments of each axis; none where a motion is given as rates.
    pub(crate) increments: Option<[[[f64; STEPS]; 3]; 2]>,
}

impl Octet {
    /// The intervals `truths`, all of `dt` seconds, for instruments calibrated at `calibration` (K).
    pub fn new(truths: [Truth; STEPS], dt: f64, calibration: f64) -> Octet {
        let mut inputs = Inputs::NONE;
        let mut all = [[[0.0; STEPS]; 3]; 2];
        let mut increments = true;
        for (row, truth) in truths.iter().enumerate() {
            inputs.set(row, truth, dt, calibration);
            match truth.motion {
                Motion::Rates { .. } => increments = false,
                Motion::Increments { dtheta, dv } => {
                    for i in 0..3 {
                        (all[0][i][row], all[1][i][row]) = (dtheta[i], dv[i]);
                    }
                }
            }
        }
        Octet { truths, dt, calibration, inputs, increments: increments.then_some(all) }
    }

    /// What it was made of.
    pub fn truths(&self) -> &[Truth; STEPS] {
        &self.truths
    }
}

/// What one instrument sees in eight steps.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    u: &'a [[f64; STEPS]; 3],
    all: &'a Inputs,
}

impl Inputs {
    pub const NONE: Inputs = Inputs {
        omega: [[0.0; STEPS]; 3],
        f: [[0.0; STEPS]; 3],
        omega_dot: [[0.0; STEPS]; 3],
        delta_t: [0.0; STEPS],
        temperature_rate: [0.0; STEPS],
        vibration: [[0.0; STEPS]; 3],
    };

    /// Puts what happens in `truth` in row `row`: see [`Input::new`].
    #[inline]
    pub fn set(&mut self, row: usize, truth: &Truth, dt: f64, calibration: f64) {
        let (omega, f) = truth.means(dt);
        for i in 0..3 {
            self.omega[i][row] = omega[i];
            self.f[i][row] = f[i];
            self.omega_dot[i][row] = truth.omega_dot[i];
            self.vibration[i][row] = truth.vibration[i];
        }
        self.delta_t[row] = truth.temperature - calibration;
        self.temperature_rate[row] = truth.temperature_rate;
    }

    /// Takes row `row` from `other`.
    #[inline]
    pub fn copy_row(&mut self, row: usize, other: &Inputs) {
        for i in 0..3 {
            self.omega[i][row] = other.omega[i][row];
            self.f[i][row] = other.f[i][row];
            self.omega_dot[i][row] = other.omega_dot[i][row];
            self.vibration[i][row] = other.vibration[i][row];
        }
        self.delta_t[row] = other.delta_t[row];
        self.temperature_rate[row] = other.temperature_rate[row];
    }

    /// What `instrument` sees.
    #[inline]
    pub fn seen_by(&self, instrument: Instrument) -> Seen<'_> {
        let u = match instrument {
            Instrument::Gyro => &self.omega,
            Instrument::Accel => &self.f,
        };
        Seen { u, all: self }
    }
}

impl Seen<'_> {
    /// The instrument's own input in row `row`.
    #[inline(always)]
    pub(crate) fn u(&self, row: usize) -> [f64; 3] {
        [self.u[0][row], self.u[1][row], self.u[2][row]]
    }

    /// The input of row `row`.
    #[inline(always)]
    pub fn at(&self, row: usize) -> Input {
        let at = |v: &[[f64; STEPS]; 3]| [v[0][row], v[1][row], v[2][row]];
        Input {
            u: at(self.u),
            omega: at(&self.all.omega),
            f: at(&self.all.f),
            omega_dot: at(&self.all.omega_dot),
            delta_t: self.all.delta_t[row],
            temperature_rate: self.all.temperature_rate[row],
            vibration: at(&self.all.vibration),
        }
    }
}
