//! A base that stays where it is and rocks, and what a strapdown instrument on it senses.

use schuler_frames::{B, Euler, Geodetic, Gravity, Rot, T, Vec3, earth};
use schuler_strapdown::BodyMotion;

/// One arc minute, rad.
pub const ARCMIN: f64 = std::f64::consts::PI / 10_800.0;
/// 1 deg/h, rad/s.
pub const DEG_PER_H: f64 = std::f64::consts::PI / 648_000.0;
/// 1 µg, m/s².
pub const UG: f64 = 9.80665e-6;

pub const GRAVITY: Gravity = Gravity::Somigliana;

/// A place, a mean attitude, and sines in roll, pitch and yaw (amplitude rad, period s).
pub struct Base {
    pub position: Geodetic,
    pub mean: Euler,
    pub sway: [(f64, f64); 3],
    /// Constant sensor errors along body axes, rad/s and m/s².
    pub eps_b: Vec3<B>,
    pub nabla_b: Vec3<B>,
}

impl Base {
    pub fn at_rest(lat: f64) -> Base {
        Base {
            position: Geodetic::new(lat, 0.4, 80.0),
            mean: Euler::new(0.02, -0.03, 0.7),
            sway: [(0.0, 1.0); 3],
            eps_b: Vec3::ZERO,
            nabla_b: Vec3::ZERO,
        }
    }

    pub fn attitude(&self, t: f64) -> Rot<T, B> {
        let sine = |(amplitude, period): (f64, f64)| amplitude * (std::f64::consts::TAU * t / period).sin();
        let [roll, pitch, yaw] = self.sway.map(sine);
        Rot::from_euler(Euler::new(self.mean.roll + roll, self.mean.pitch + pitch, self.mean.yaw + yaw))
    }

    /// Motion from t to t + dt: rotation vector between the attitudes at both ends, turned on by the Earth, and specific force
    /// by Simpson's rule.
    pub fn motion(&self, t: f64, dt: f64) -> BodyMotion {
        let (s, c) = self.position.lat.sin_cos();
        let omega = earth::omega_ie_t(s, c).as_vec3();
        let start = self.attitude(t).inverse();
        let f_t = -GRAVITY.gravity_t(self.position);
        // C_b(t + tau)^b(t), with the local level turning by the Earth rate.
        let turned = |tau: f64| {
            let level = Rot::<T, T>::from_rotation_vector(omega * tau);
            start * (level * self.attitude(t + tau))
        };
        let force = |tau: f64| turned(tau) * (self.attitude(t + tau).inverse() * f_t + self.nabla_b);
        let dv = (force(0.0) + force(0.5 * dt) * 4.0 + force(dt)) * (dt / 6.0);
        BodyMotion { sigma: turned(dt).as_rotation_vector() + self.eps_b * dt, dv }
    }

    /// Feeds `duration` (s) in steps of `dt` (s).
    pub fn run(&self, duration: f64, dt: f64, mut feed: impl FnMut(&BodyMotion, f64)) {
        for k in 0..(duration / dt).round() as u64 {
            feed(&self.motion(k as f64 * dt, dt), dt);
        }
    }
}
