//! The stationary truth of a drift study and everything that is computed from it once.

use schuler_frames::{B, Gravity, Rot, T, Vec3, earth::omega_ie_t};
use schuler_imu::{Input, Instrument, Truth};
use schuler_strapdown::static_base::Site;
use schuler_strapdown::{Pva, Vertical};

use crate::channel;
use crate::scenario::{Drift, Mechanization};

/// A base at rest on the Earth with an IMU on it.
pub struct Scene {
    /// True position, velocity (zero) and attitude.
    pub truth: Pva,
    /// What the closed forms need of the place.
    pub site: Site,
    /// Gravity model of the navigator, which is that of the truth.
    pub gravity: Gravity,
    /// How the navigator computes.
    pub mechanization: Mechanization,
    /// The vertical channel of the navigator.
    pub vertical: Vertical,
    /// True angular rate omega_ib^b, rad/s.
    pub omega_b: [f64; 3],
    /// True specific force f^b, m/s².
    pub f_b: [f64; 3],
    /// Temperature of the run, K.
    pub temperature: f64,
    /// Temperature of the calibration, K.
    pub calibration: f64,
    /// IMU sample interval, s.
    pub dt: f64,
    /// Numbers of IMU steps at which a row is recorded, beginning with 0.
    pub rows: Vec<u64>,
}

impl Scene {
    pub fn new(drift: &Drift, every: Option<f64>) -> Scene {
        let position = drift.start.position;
        let c_tb: Rot<T, B> = Rot::from_euler(drift.start.attitude);
        let gravity = drift.mechanization.gravity;
        let (s, c) = position.lat.sin_cos();
        let g_t = gravity.gravity_t(position);
        let vertical = channel::vertical(&drift.mechanization, position);
        let dt = 1.0 / drift.imu.rate;
        let steps = drift.samples;
        let stride = every.map_or(1, |every| (every / dt).round().max(1.0) as u64);
        let mut rows: Vec<u64> = (0..=steps / stride).map(|k| k * stride).collect();
        if !steps.is_multiple_of(stride) {
            rows.push(steps);
        }
        Scene {
            truth: Pva { position, v_t: Vec3::ZERO, c_tb },
            site: Site::new(position, gravity),
            gravity,
            mechanization: drift.mechanization,
            vertical,
            omega_b: (c_tb.inverse() * omega_ie_t(s, c)).as_vec3().as_array(),
            f_b: (c_tb.inverse() * -g_t).as_array(),
            temperature: drift.imu.temperature.as_ref().map_or(Truth::TEMPERATURE, |t| t.profile().at(0.0)),
            calibration: drift.imu.spec.calibration_temperature,
            dt,
            rows,
        }
    }

    /// Time of a step, s.
    pub fn time(&self, step: u64) -> f64 {
        step as f64 * self.dt
    }

    /// True motion as the injector takes it.
    pub fn motion(&self) -> Truth {
        Truth::rates(self.omega_b, self.f_b).with_temperature(self.temperature, 0.0)
    }

    /// What the terms of `instrument` see.
    pub fn input(&self, instrument: Instrument) -> Input {
        Input::new(instrument, &self.motion(), self.dt, self.calibration)
    }
}
