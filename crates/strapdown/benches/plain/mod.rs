//! The same second-order local-level step with nalgebra types and the functions of the platform,
//! as one would write it first: sines, roots, divisions, a normalised `UnitQuaternion`.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use schuler_frames::wgs84;
use schuler_strapdown::{Increments, Pva};

pub struct Plain {
    pub lat: f64,
    pub lon: f64,
    pub h: f64,
    pub v: Vector3<f64>,
    pub q: UnitQuaternion<f64>,
}

impl Plain {
    pub fn new(pva: &Pva) -> Self {
        let [w, x, y, z] = pva.c_tb.as_quaternion();
        Plain {
            lat: pva.position.lat,
            lon: pva.position.lon,
            h: pva.position.h,
            v: pva.v_t.as_nalgebra(),
            q: UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)),
        }
    }

    #[inline]
    pub fn step(&mut self, increments: &Increments, dt: f64) {
        let dtheta = increments.dtheta.as_nalgebra();
        let dv = increments.dv.as_nalgebra();
        let turn = dtheta.cross(&dv);
        let dv_f = self.q * (dv + turn * 0.5 + dtheta.cross(&turn) / 6.0);

        let r_m = wgs84::r_m(self.lat.sin()) + self.h;
        let lat = self.lat + self.v.x / r_m * dt * 0.5;
        let h = self.h - self.v.z * dt * 0.5;
        let (s, c) = lat.sin_cos();
        let root = (1.0 - wgs84::E2 * s * s).sqrt();
        let r_n = wgs84::A / root + h;
        let r_m = wgs84::A * (1.0 - wgs84::E2) / (root * root * root) + h;
        let height = 1.0 - 2.0 / wgs84::A * (1.0 + wgs84::F + wgs84::M - 2.0 * wgs84::F * s * s) * h
            + 3.0 * h * h / (wgs84::A * wgs84::A);
        let g = Vector3::new(0.0, 0.0, wgs84::GAMMA_E * (1.0 + wgs84::K * s * s) / root * height);
        let omega_ie = Vector3::new(wgs84::OMEGA * c, 0.0, -wgs84::OMEGA * s);
        let transport = |v: &Vector3<f64>| Vector3::new(v.y / r_n, -v.x / r_m, -v.y * (s / c) / r_n);

        let mut v_mid = self.v;
        let mut change = dv_f;
        for _ in 0..2 {
            let omega_et = transport(&v_mid);
            let omega_it = omega_ie + omega_et;
            change =
                dv_f - omega_it.cross(&dv_f) * (0.5 * dt) + g * dt - (omega_it + omega_ie).cross(&v_mid) * dt;
            v_mid = self.v + change * 0.5;
        }
        self.v += change;
        self.lat += v_mid.x / r_m * dt;
        self.lon += v_mid.y / (r_n * c) * dt;
        self.h -= v_mid.z * dt;
        let omega_it = omega_ie + transport(&v_mid);
        let left = UnitQuaternion::from_scaled_axis(-omega_it * dt);
        let right = UnitQuaternion::from_scaled_axis(dtheta);
        self.q = UnitQuaternion::new_normalize((left * self.q * right).into_inner());
    }
}
