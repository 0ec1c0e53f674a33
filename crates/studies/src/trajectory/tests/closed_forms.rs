//! Numbers known without any quadrature.

use std::f64::consts::TAU;

use schuler_frames::{B, Euler, Gravity, Rot, Vec3, earth::omega_ie_t, phi_between};

use super::kinds::{ATTITUDE, PLACE, mooring, rate_table, two_positions};
use crate::trajectory::{Coning, Pose, Positions, Sculling, Still, Trajectory, Truth};

/// At rest the IMU senses gravity and Earth rate; an interval late in the day is as exact as the first.
#[test]
fn at_rest() {
    let truth = Truth::new(Still::new(PLACE, ATTITUDE), Gravity::Normal);
    let c_bt = Rot::from_euler(ATTITUDE).inverse();
    let omega = c_bt * omega_ie_t(PLACE.lat.sin(), PLACE.lat.cos()).as_vec3();
    let f = c_bt * -Gravity::Normal.gravity_t(PLACE);
    for t in [0.0, 86_399.123] {
        let increments = truth.increments(t, 1e-3);
        // A simulated accelerometer rounds by less than 1e-12 m/s² at 1 kHz.
        assert!((increments.dv * 1e3 - f).norm() < 1e-14, "{t}");
        assert!((increments.dtheta * 1e3 - omega).norm() < 1e-19, "{t}");
    }
}

/// Rounding of a shaken accelerometer: at 1 kHz, the mean force over two halves is that over the whole, within 1e-12 m/s².
#[test]
fn rounding_of_an_accelerometer_at_1_khz() {
    let truth = Truth::new(mooring(), Gravity::Normal);
    for k in 0..2000 {
        let (t, dt) = (f64::from(k) * 1e-3, 1e-3);
        let halves = truth.increments(t, 0.5 * dt).dv + truth.increments(t + 0.5 * dt, 0.5 * dt).dv;
        let error = (truth.increments(t, dt).dv - halves).norm() / dt;
        assert!(error < 1e-12, "{t}: {error:e}");
    }
}

/// Increments of coning: (-2 w T sin²(a/2), -2 sin a sin(wT/2) sin(w tm), 2 sin a sin(wT/2) cos(w tm)), tm the middle,
/// and the Earth's rate beside, whose mean direction in the coning body is close to that in its middle.
#[test]
fn coning_increments() {
    let (a, frequency) = (0.05, 20.0);
    let truth = Truth::new(Coning::new(PLACE, ATTITUDE, a, frequency), Gravity::Normal);
    let (w, dt) = (TAU * frequency, 0.005);
    let omega_ie = omega_ie_t(PLACE.lat.sin(), PLACE.lat.cos()).as_vec3();
    for k in 0..40 {
        let t = f64::from(k) * dt;
        let (s, c) = (w * (t + 0.5 * dt)).sin_cos();
        let swing = 2.0 * a.sin() * (0.5 * w * dt).sin();
        let expected = Vec3::<B>::new(-2.0 * w * dt * (0.5 * a).sin().powi(2), -swing * s, swing * c);
        // Simpson's rule over ten parts for the Earth's share, which is 7e-5 of anything.
        let earth = |t: f64| truth.moment(t).pva.c_tb.inverse() * omega_ie;
        let mut share = Vec3::<B>::ZERO;
        for part in 0..10 {
            let (h, begin) = (0.1 * dt, t + 0.1 * dt * f64::from(part));
            share += (earth(begin) + earth(begin + 0.5 * h) * 4.0 + earth(begin + h)) * (h / 6.0);
        }
        let error = (truth.increments(t, dt).dtheta - share - expected).norm();
        assert!(error < 2e-16, "{k}: {error:e}");
    }
}

/// The first Bessel function of the first kind, by its series.
fn j1(x: f64) -> f64 {
    let (mut term, mut sum) = (0.5 * x, 0.0);
    for k in 1..20 {
        sum += term;
        term *= -0.25 * x * x / (f64::from(k) * f64::from(k + 1));
    }
    sum
}

/// Over whole periods the body's z senses -B J1(alpha) more than gravity alone would give it, which is
/// -g_z J0(alpha) in the mean.
#[test]
fn sculling_mean() {
    let (angle, b, frequency) = (0.3, 2.0, 5.0);
    let level = Euler::new(0.0, 0.0, 0.7);
    let (with, without) = (
        Truth::new(Sculling::new(PLACE, level, angle, b, frequency), Gravity::Normal),
        Truth::new(Sculling::new(PLACE, level, angle, 0.0, frequency), Gravity::Normal),
    );
    let mean = |truth: &Truth| truth.increments(0.0, 2.0).dv[2] / 2.0;
    let found = mean(&with) - mean(&without);
    // Coriolis and the change of gravity over 2 mm are left out of the closed form.
    assert!((found + b * j1(angle)).abs() < 1e-6, "{found} {}", -b * j1(angle));
}

/// A rocking base comes back after the common period of its sines, and starts at the place and attitude of its middle where
/// all phases are zero.
#[test]
fn turns_end_in_the_next_position() {
    let test = two_positions();
    let yaw = |t: f64| test.at(t).c_tb.as_euler().yaw;
    assert!((yaw(19.9) - 0.3).abs() < 1e-15);
    // 20 s, then half a turn at 0.2 rad/s at most: 15/8 pi / 0.2 s.
    let turned = 20.0 + 1.875 * 0.5 * TAU / 0.2;
    assert!((yaw(turned + 1.0) - (0.3 - 0.5 * TAU)).abs() < 1e-14);
    assert!(
        (test.duration().expect("an end") - (turned + 40.0 + 1.875 * (0.5 * TAU - 0.7) / 0.2)).abs() < 0.1
    );
    // The fastest it turns.
    let fastest = test.at(0.5 * (20.0 + turned)).omega_eb_b.norm();
    assert!((fastest - 0.2).abs() < 1e-15, "{fastest}");
    // Nothing to turn: no turn.
    let pose = Pose { attitude: ATTITUDE, dwell: 5.0 };
    let still = Positions::new(PLACE, &[pose, pose], 0.1);
    assert_eq!((still.joints().len(), still.duration()), (0, Some(10.0)));
}

/// The rate table: each body axis in turn points along the leaning axis, turns by whole and part turns and comes back.
#[test]
fn a_table_turns_each_axis_both_ways() {
    let table = rate_table(0.5);
    for axis in 0..3 {
        let begin = 0.01 * (axis as u64 * 2 * 6100 / 6) as f64;
        let middle = 0.01 * ((axis as u64 * 2 + 1) * 6100 / 6) as f64;
        let end = 0.01 * ((axis as u64 * 2 + 2) * 6100 / 6) as f64;
        let at = |t: f64| table.at(t);
        for (t, rate) in [(begin + 3.0, 0.5), (middle + 3.0, -0.5)] {
            let omega = at(t).omega_eb_b;
            for k in 0..3 {
                assert!(
                    (omega[k] - if k == axis { rate } else { 0.0 }).abs() < 1e-15,
                    "{axis} {t} {omega:?}"
                );
            }
        }
        // The table's axis leans by 0.4 rad: its lower end to the south.
        let mut unit = [0.0; 3];
        unit[axis] = 1.0;
        let down = at(begin + 4.0).c_tb * Vec3::<B>::claim(unit);
        assert!((down[0] + 0.4f64.sin()).abs() < 1e-15 && (down[2] - 0.4f64.cos()).abs() < 1e-15);
        // Back where it began, but for segments of unequal length by one sample.
        let apart = phi_between(at(begin).c_tb, at(end - 1e-9).c_tb).norm();
        assert!(apart < 0.5 * 0.0101, "{axis}: {apart}");
    }
}
