//! Every term against values worked out by hand.
//!
//! Input: omega = (0.1, -0.2, 0.3) rad/s, f = (1, -2, 4) m/s², angular acceleration
//! (0.01, 0.02, -0.03) rad/s², T - T_cal = 10 K, rate 0.5 K/s, mean square of vibration (1, 4, 9).

use schuler_imu::term::{Coefficients, mounting_coefficients};
use schuler_imu::{Input, Instrument, TERMS, Truth, Unit, term};

use Instrument::{Accel, Gyro};

fn input(instrument: Instrument) -> Input {
    let truth = Truth::rates([0.1, -0.2, 0.3], [1.0, -2.0, 4.0])
        .with_omega_dot([0.01, 0.02, -0.03])
        .with_temperature(303.15, 0.5)
        .with_vibration([1.0, 4.0, 9.0]);
    Input::new(instrument, &truth, 0.01, 293.15)
}

fn coefficients(c: &[f64]) -> Coefficients {
    let mut all = Coefficients::default();
    all[..c.len()].copy_from_slice(c);
    all
}

/// Term, instrument, coefficients, output by hand, unit of the coefficients as text.
type Case = (&'static str, Instrument, &'static [f64], [f64; 3], &'static str);

#[rustfmt::skip]
const CASES: &[Case] = &[
    ("bias", Gyro, &[1.0, 2.0, 3.0], [1.0, 2.0, 3.0], "rad/s"),
    ("bias", Accel, &[1.0, 2.0, 3.0], [1.0, 2.0, 3.0], "m/s^2"),
    ("scale_factor", Gyro, &[1.0, 2.0, 3.0], [0.1, -0.4, 0.9], "1"),
    ("scale_factor", Accel, &[1.0, 2.0, 3.0], [1.0, -4.0, 12.0], "1"),
    ("asymmetry", Accel, &[1.0, 2.0, 3.0], [1.0, 4.0, 12.0], "1"),
    ("quadratic", Accel, &[1.0, 2.0, 3.0], [1.0, 8.0, 48.0], "s^2/m"),
    ("quadratic", Gyro, &[1.0, 1.0, 1.0], [0.01, 0.04, 0.09], "s/rad"),
    ("cubic", Accel, &[1.0, 2.0, 3.0], [1.0, -16.0, 192.0], "s^4/m^2"),
    // xy: part of y on x, and so on: (-2 a + 4 b, 1 c + 4 d, 1 e - 2 f).
    ("misalignment", Accel, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [6.0, 19.0, -7.0], "1"),
    ("non_orthogonality", Accel, &[1.0, 2.0, 3.0], [0.0, 1.0, -4.0], "1"),
    ("mounting", Accel, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0], [1.0, -2.0, 3.0], "1"),
    ("thermal", Accel, &[1.0, 2.0, 3.0], [10.0, 20.0, 30.0], "m/s^2/K"),
    ("thermal_2", Gyro, &[1.0, 2.0, 3.0], [100.0, 200.0, 300.0], "rad/s/K^2"),
    ("thermal_3", Gyro, &[1.0, 2.0, 3.0], [1000.0, 2000.0, 3000.0], "rad/s/K^3"),
    ("thermal_rate", Gyro, &[1.0, 2.0, 3.0], [0.5, 1.0, 1.5], "rad/K"),
    ("thermal_scale_factor", Accel, &[1.0, 2.0, 3.0], [10.0, -40.0, 120.0], "1/K"),
    ("g_sensitivity", Gyro, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0], [9.0, 18.0, 27.0], "rad*s/m"),
    // squares (1, 4, 16)
    ("g_squared", Gyro, &[1.0, 2.0, 3.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], [57.0, 4.0, 16.0], "rad*s^3/m^2"),
    // products yz, zx, xy: (-8, 4, -2)
    ("anisoelastic", Gyro, &[1.0, 2.0, 3.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], [-6.0, 4.0, -2.0], "rad*s^3/m^2"),
    // products of rates: (-0.06, 0.03, -0.02)
    ("anisoinertia", Gyro, &[1.0, 2.0, 3.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], [-0.06, 0.03, -0.02], "s/rad"),
    // x: io = f_x f_z = 4, po = f_y f_z = -8; y: f_y f_x = -2, f_z f_x = 4; z: f_z f_y = -8, f_x f_y = -2
    ("cross_coupling", Accel, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [-12.0, 10.0, -52.0], "s^2/m"),
    ("vibropendulous", Accel, &[1.0, 2.0, 3.0], [-2.0, -16.0, 12.0], "s^2/m"),
    // r = (1, 0, 0): w x (w x r) = (w.r) w - w² r = 0.1 w - 0.14 r = (-0.13, -0.02, 0.03);
    // dw x r = (0, -0.03, -0.02)
    ("lever_arm", Accel, &[1.0, 0.0, 0.0], [-0.13, -0.05, 0.01], "m"),
    // each accelerometer 2 m along its own axis: 2 (w_i² - w²)
    ("size_effect", Accel, &[2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0], [-0.26, -0.20, -0.10], "m"),
    ("vibration_rectification", Accel, &[1.0, 2.0, 3.0], [1.0, 8.0, 27.0], "s^2/m"),
    ("vibration_rectification", Gyro, &[1.0, 2.0, 3.0], [1.0, 8.0, 27.0], "rad*s^3/m^2"),
];

#[test]
fn outputs_are_those_worked_out_by_hand() {
    for (name, instrument, c, expected, unit) in CASES {
        let t = term(name).unwrap_or_else(|| panic!("no term {name}"));
        let output = t.output(&input(*instrument), &coefficients(c));
        for i in 0..3 {
            let (found, expected) = (output[i], expected[i]);
            assert!((found - expected).abs() <= 1e-12 * (1.0 + expected.abs()), "{name}: {output:?}");
        }
        assert_eq!(t.unit(*instrument).to_string(), *unit, "{name}");
    }
}

#[test]
fn every_term_has_a_case() {
    for t in TERMS {
        assert!(CASES.iter().any(|c| c.0 == t.name()), "{} has no value worked out by hand", t.name());
        assert_ne!(t.unit(t.instruments()[0]), Unit::SECOND);
    }
}

/// Linear in the coefficients, by the regressor.
#[test]
fn the_regressor_is_the_derivative_of_the_output() {
    for t in TERMS {
        for instrument in t.instruments() {
            let input = input(*instrument);
            let c: Coefficients =
                std::array::from_fn(|j| if j < t.len() { 0.3 + 0.1 * j as f64 } else { 0.0 });
            let (regressor, output) = (t.regressor(&input), t.output(&input, &c));
            for i in 0..3 {
                let sum: f64 = regressor.columns().iter().zip(c).map(|(g, c)| g[i] * c).sum();
                assert!((sum - output[i]).abs() < 1e-12 * (1.0 + sum.abs()), "{}", t.name());
            }
        }
    }
}

/// Without motion, temperature change and vibration only the bias is left.
#[test]
fn at_rest_in_free_fall_only_the_bias_speaks() {
    let still = Truth::rates([0.0; 3], [0.0; 3]);
    for t in TERMS.iter().filter(|t| t.name() != "bias") {
        for instrument in t.instruments() {
            let input = Input::new(*instrument, &still, 0.01, Truth::TEMPERATURE);
            assert_eq!(t.output(&input, &[1.0; 9]).map(f64::abs), [0.0; 3], "{}", t.name());
        }
    }
}

/// Mounting turned by 90 degrees of yaw: the sensor's x axis is the body's y axis.
#[test]
fn mounting_is_exact_for_large_angles() {
    let c = mounting_coefficients(0.0, 0.0, std::f64::consts::FRAC_PI_2);
    let input = input(Accel);
    let e = term("mounting").unwrap().output(&input, &c);
    for (found, expected) in input.u.iter().zip(e).map(|(u, e)| u + e).zip([-2.0, -1.0, 4.0]) {
        assert!((found - expected).abs() < 1e-12);
    }
    // A rotation keeps the length: the entries of C = 1 + c are orthonormal.
    let c = mounting_coefficients(0.3, -0.4, 2.0);
    let m: [[f64; 3]; 3] = std::array::from_fn(|i| std::array::from_fn(|j| c[3 * i + j] + f64::from(i == j)));
    for i in 0..3 {
        for j in 0..3 {
            let dot: f64 = (0..3).map(|k| m[i][k] * m[j][k]).sum();
            assert!((dot - f64::from(i == j)).abs() < 1e-14);
        }
    }
}
