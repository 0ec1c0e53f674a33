//! Rates against the rotations they are the rates of; velocities against the positions they move; Earth rotation.

use core::f64::consts::TAU;

use proptest::prelude::*;
use schuler_frames::{
    B, E, Euler, Frame, Geodetic, I, Rate, Rot, T, Vec3, c_ie, earth, earth_rotation_angle, velocity_e,
    velocity_i, wgs84,
};

use crate::vectors;

/// A vehicle at constant geodetic rates that turns at a constant body rate.
struct Motion {
    start: Geodetic,
    v_t: Vec3<T>,
    omega_tb_b: Vec3<B>,
}

impl Motion {
    fn position(&self, t: f64) -> Geodetic {
        let (s, c) = self.start.lat.sin_cos();
        let [n, e, d] = self.v_t.as_array();
        let Geodetic { lat, lon, h } = self.start;
        Geodetic::new(lat + t * n / (wgs84::r_m(s) + h), lon + t * e / ((wgs84::r_n(s) + h) * c), h - t * d)
    }
    fn c_ie(&self, t: f64) -> Rot<I, E> {
        c_ie(0.7 + wgs84::OMEGA * t)
    }
    fn c_tb(&self, t: f64) -> Rot<T, B> {
        Rot::from_euler(Euler::new(0.3, -0.4, 2.0)) * Rot::<B, B>::from_rotation_vector(self.omega_tb_b * t)
    }
    fn r_i(&self, t: f64) -> Vec3<I> {
        self.c_ie(t) * self.position(t).as_ecef()
    }
}

/// Rate of `From` with respect to `To` in `From`, from C' = C [omega ×] by a central difference.
fn rate<To: Frame, From: Frame>(c: impl Fn(f64) -> Rot<To, From>, dt: f64) -> Rate<From, To, From> {
    let turned: Rot<From, From> = c(-dt).inverse() * c(dt);
    Rate::claim(turned.as_rotation_vector() * (0.5 / dt))
}

proptest! {
    #![proptest_config(crate::laws())]

    #[test]
    fn rates_are_derivatives_of_rotations(
        lat in -1.3..1.3f64, lon in -3.0..3.0f64, h in 0.0..1e4,
        v_t in vectors::<T>(300.0), omega_tb_b in vectors::<B>(1e-3),
    ) {
        let m = Motion { start: Geodetic::new(lat, lon, h), v_t, omega_tb_b };
        // Rounding 1e-15 / dt and the cube of a step's turn, (1e-3 rad)² of 1e-3 rad/s.
        let (dt, tolerance) = (1.0, 2e-9);
        let (s, c) = lat.sin_cos();

        let omega_et_t: Rate<T, E, T> = earth::omega_et_t(v_t, m.start);
        let numeric = rate(|t| m.position(t).c_et(), dt);
        prop_assert!((omega_et_t.as_vec3() - numeric.as_vec3()).norm() < tolerance);

        let numeric = rate(|t| m.c_ie(t), dt);
        prop_assert!((earth::OMEGA_IE_E.as_vec3() - numeric.as_vec3()).norm() < 1e-14);
        let turned: Rate<E, I, T> = m.start.c_et().inverse() * earth::OMEGA_IE_E;
        prop_assert!((turned.as_vec3() - earth::omega_ie_t(s, c).as_vec3()).norm() < 1e-18);
        let turned: Rate<E, I, I> = m.c_ie(0.0) * earth::OMEGA_IE_E;
        prop_assert!((turned.as_vec3() - earth::OMEGA_IE_I.as_vec3()).norm() < 1e-18);

        // omega_ib^b = omega_tb^b + C_t^b (omega_et^t + omega_ie^t): what a gyro senses.
        let omega_tb = Rate::<B, T, B>::claim(omega_tb_b);
        let omega_it_t: Rate<T, I, T> = omega_et_t + earth::omega_ie_t(s, c);
        let omega_ib_b: Rate<B, I, B> = omega_tb + m.c_tb(0.0).inverse() * omega_it_t;
        let numeric = rate(|t| m.c_ie(t) * m.position(t).c_et() * m.c_tb(t), dt);
        prop_assert!((omega_ib_b.as_vec3() - numeric.as_vec3()).norm() < tolerance);

        // And back: what is common is taken away, what is turned round changes its sign.
        let back: Rate<B, T, B> = omega_ib_b - m.c_tb(0.0).as_dcm().transpose() * omega_it_t;
        prop_assert!((back.as_vec3() - omega_tb_b).norm() < 1e-17);
        let reverse: Rate<T, B, B> = -back;
        prop_assert!((reverse.as_vec3() + omega_tb_b).norm() < 1e-17);
    }

    #[test]
    fn velocities_are_derivatives_of_positions(lat in -1.3..1.3f64, lon in -3.0..3.0f64, h in 0.0..1e4, v_t in vectors::<T>(300.0)) {
        let m = Motion { start: Geodetic::new(lat, lon, h), v_t, omega_tb_b: Vec3::ZERO };
        let (r_e, v_e) = (m.start.as_ecef(), m.start.c_et() * v_t);
        let v_i = velocity_i(m.c_ie(0.0), r_e, v_e);
        let dt = 0.1;
        // Rounding of positions 4e-9 m / dt; third derivative (500 m/s)³ tan² L / R² dt² / 6.
        let numeric = (m.r_i(dt) - m.r_i(-dt)) * (0.5 / dt);
        prop_assert!((v_i - numeric).norm() < 4e-7, "{v_i:?} {numeric:?}");
        let back = velocity_e(m.c_ie(0.0), m.r_i(0.0), v_i);
        prop_assert!((back - v_e).norm() < 1e-12);
    }

    #[test]
    fn the_angle_of_the_earth_does_not_depend_on_the_split(day in 2440000..2480000u32, part in 0.0..1.0f64) {
        let whole = earth_rotation_angle(day as f64, part);
        let shifted = earth_rotation_angle(day as f64 - 1000.0, part + 1000.0);
        let difference = (whole - shifted).abs();
        // A thousand days in the second part cost it ten bits.
        prop_assert!(difference.min(TAU - difference) < 2e-12);
        prop_assert!((0.0..=TAU).contains(&whole));
    }
}

/// The test value that SOFA's library prints for `era00` at MJD 54388.0.
#[test]
fn earth_rotation_angle_of_sofa() {
    assert!((earth_rotation_angle(2400000.5, 54388.0) - 0.4022837240028158102).abs() < 1e-12);
}

#[cfg(feature = "hifitime")]
#[test]
fn epochs_of_any_scale() {
    use hifitime::Epoch;
    use schuler_frames::earth_rotation_angle_at;
    let utc = Epoch::from_gregorian_utc(2007, 10, 15, 0, 0, 0, 0);
    assert!((earth_rotation_angle_at(utc) - 0.4022837240028158102).abs() < 1e-12);
    // 2007: GPS time is 14 s ahead of UTC (leap second table of the IERS).
    let gps = Epoch::from_gregorian(2007, 10, 15, 0, 0, 14, 0, hifitime::TimeScale::GPST);
    assert_eq!(earth_rotation_angle_at(gps), earth_rotation_angle_at(utc));
    // A nanosecond is 7.3e-14 rad: it is not lost.
    let later = Epoch::from_gregorian_utc(2007, 10, 15, 0, 0, 0, 1000);
    let turned = earth_rotation_angle_at(later) - earth_rotation_angle_at(utc);
    assert!((turned - 7.292115e-11).abs() < 1e-14, "{turned}");
}
