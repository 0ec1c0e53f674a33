//! The classical first-order mechanization, to show what it costs.

use schuler_frames::earth::{omega_et_t, omega_ie_t};
use schuler_frames::{Gravity, Rot, T, Vec3, wgs84};

use crate::{BodyMotion, Increments, Mechanization, Pva, Vertical};

/// Local-level navigator by Euler's rule: every derivative is taken at the start of the step.
///
/// ```text
/// v += C dv + (g - (2 omega_ie + omega_et) × v) dt,     q += q ⊗ (0, sigma - C⁻¹ omega_it dt) / 2, normalised
/// ```
///
/// and the position by the velocity of the start. First order in the step: 0.16 m in a day at rest at 100 Hz with
/// a gyro error of 0.01 deg/h, where [`LocalLevel`](crate::LocalLevel) errs by a micrometre. Not for navigation: it stands here as the
/// yardstick of older texts and tools. At rest and free of errors it is exact, so a test at rest proves nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstOrder {
    pva: Pva,
    baro_a: f64,
    gravity: Gravity,
    vertical: Vertical,
}

impl FirstOrder {
    /// A navigator that starts at `pva`.
    pub fn new(pva: &Pva, gravity: Gravity, vertical: Vertical) -> Self {
        FirstOrder { pva: *pva, baro_a: 0.0, gravity, vertical }
    }
}

impl Mechanization for FirstOrder {
    fn advance(&mut self, motion: &BodyMotion, dt: f64) {
        let Pva { position, v_t: v, c_tb } = self.pva;
        let (s, c) = libm::sincos(position.lat);
        let omega_ie = omega_ie_t(s, c).as_vec3();
        let omega_it = omega_ie + omega_et_t(v, position).as_vec3();
        let free = self.gravity.gravity_t(position) - (omega_it + omega_ie).cross(v);
        let mut change = c_tb * motion.dv + free * dt;
        let mut climb = -v[2];
        match self.vertical {
            Vertical::Free => {}
            Vertical::Held => {
                change = Vec3::new(change[0], change[1], 0.0);
                climb = 0.0;
            }
            Vertical::Damped(baro) => {
                let excess = position.h - baro.height;
                change += Vec3::<T>::new(0.0, 0.0, (excess * baro.k2 + self.baro_a) * dt);
                climb -= baro.k1 * excess;
                self.baro_a += baro.k3 * excess * dt;
            }
        }
        self.pva.v_t = v + change;
        self.pva.position.lat += v[0] / (wgs84::r_m(s) + position.h) * dt;
        self.pva.position.lon += v[1] / ((wgs84::r_n(s) + position.h) * c) * dt;
        self.pva.position.h += climb * dt;

        let [x, y, z] = (motion.sigma - c_tb.inverse() * omega_it * dt).as_array();
        let [q0, q1, q2, q3] = c_tb.as_quaternion();
        self.pva.c_tb = Rot::claim([
            q0 - 0.5 * (q1 * x + q2 * y + q3 * z),
            q1 + 0.5 * (q0 * x + q2 * z - q3 * y),
            q2 + 0.5 * (q0 * y + q3 * x - q1 * z),
            q3 + 0.5 * (q0 * z + q1 * y - q2 * x),
        ])
        .normalized();
    }

    fn pva(&self) -> Pva {
        self.pva
    }

    /// Without the rotation of the body inside the interval: the increments as they are.
    fn step(&mut self, increments: &Increments, dt: f64) {
        self.advance(&BodyMotion { sigma: increments.dtheta, dv: increments.dv }, dt);
    }
}
