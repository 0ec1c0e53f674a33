//! Rows of all measurements against differences of their non-linear predictions, and resets.

use schuler_frames::{B, Euler, Geodetic, Rot, Vec3, earth, position_error, with_phi, with_position_error};
use schuler_imu::Spec;
use schuler_strapdown::filter::{
    Attitude, Filter, Form, Heading, Height, IntegratedVelocity, Measurement, Model, NavStates, NonHolonomic,
    Now, Observation, Position, Velocity, ZeroRate, ZeroVelocity, attitude_reset, corrected, measurement,
};
use schuler_strapdown::{NavError, Pva};

/// Somewhere, moving and turning: nothing is zero.
fn somewhere() -> (Pva, Vec3<B>) {
    let pva = Pva {
        position: Geodetic::new(0.7, -1.2, 800.0),
        v_t: Vec3::new(60.0, -40.0, 3.0),
        c_tb: Rot::from_euler(Euler::new(0.2, -0.4, 2.3)),
    };
    (pva, Vec3::new(0.3, -0.5, 0.8))
}

const LEVER: Vec3<B> = Vec3::new(1.5, -0.7, 2.2);

/// The navigator of which `truth` is true, with the errors `e`.
fn with_errors(truth: &Pva, e: &[f64; 9]) -> Pva {
    Pva {
        position: with_position_error(truth.position, Vec3::new(e[0], e[1], e[2])),
        v_t: truth.v_t + Vec3::new(e[3], e[4], e[5]),
        c_tb: with_phi(truth.c_tb, Vec3::new(e[6], e[7], e[8])),
    }
}

fn true_measurements(truth: &Pva, omega: Vec3<B>) -> Vec<(&'static str, Box<dyn Measurement>)> {
    let c = truth.c_tb;
    let (s, cos) = truth.position.lat.sin_cos();
    let omega_ie = earth::omega_ie_t(s, cos).as_vec3();
    let omega_eb = omega - c.inverse() * omega_ie;
    let at_lever = truth.v_t + c * omega_eb.cross(LEVER);
    let antenna = with_position_error(truth.position, c * LEVER);
    let yaw = c.as_euler().yaw;
    let axes = measurement::ALL;
    vec![
        ("velocity", Box::new(Velocity { v_t: at_lever, sigma: [0.1; 3], lever: LEVER, axes })),
        ("position", Box::new(Position { position: antenna, sigma: [1.0; 3], lever: LEVER, axes })),
        ("height", Box::new(Height { h: antenna.h, sigma: 1.0, lever: LEVER })),
        ("attitude", Box::new(Attitude::new(c, [1e-3; 3]))),
        ("heading", Box::new(Heading { yaw, sigma: 1e-3 })),
        // What does not hold of this motion has a prediction all the same.
        ("zero velocity", Box::new(ZeroVelocity::new(0.1))),
        ("zero rate", Box::new(ZeroRate::new(1e-5))),
        ("non-holonomic", Box::new(NonHolonomic { sigma: [0.1, 0.2], lever: LEVER })),
    ]
}

/// Steps at which the differences are taken, per kind of error: their third powers are small, and rounding (a latitude is
/// known to 1e-9 m) is smaller.
const STEP: [f64; 3] = [1.0, 1e-2, 5e-4];

#[test]
fn rows_are_the_derivatives_of_the_predictions() {
    let (truth, omega) = somewhere();
    let f = Vec3::new(0.5, -1.0, -9.6);
    for (name, m) in true_measurements(&truth, omega) {
        let zero = m.observe(&Now::new(&truth, omega, f));
        let predicted = !matches!(name, "zero velocity" | "zero rate" | "non-holonomic");
        for row in 0..zero.len {
            // An error-free navigator has computed what is measured.
            assert!(!predicted || zero.z[row].abs() < 2e-9, "{name}: {}", zero.z[row]);
        }
        let scale = |row: usize| zero.h_nav[row].iter().fold(0.0f64, |a, h| a.max(h.abs()));
        for k in 0..9 {
            let h = STEP[k / 3];
            let z = [h, -h].map(|h| {
                let mut e = [0.0; 9];
                e[k] = h;
                m.observe(&Now::new(&with_errors(&truth, &e), omega, f)).z
            });
            for row in 0..zero.len {
                let slope = (z[0][row] - z[1][row]) / (2.0 * h);
                let off = (slope - zero.h_nav[row][k]).abs();
                // Metres and metres per second are known to 1e-9 in these quotients; a position error counts by the radii
                // of a place a lever arm away.
                let rounding = match (k, name) {
                    (..3, "position" | "height") => 1e-6,
                    (..3, _) => 2e-9,
                    _ => 1e-6 * scale(row),
                };
                assert!(
                    off < rounding.max(1e-8 * slope.abs()),
                    "{name} row {row}, error {k}: {slope} {off:e}"
                );
            }
        }
        for k in 0..3 {
            let h = 1e-3;
            let z = [h, -h].map(|h| {
                let mut e = [0.0; 3];
                e[k] = h;
                m.observe(&Now::new(&truth, omega + Vec3::claim(e), f)).z
            });
            for row in 0..zero.len {
                let slope = (z[0][row] - z[1][row]) / (2.0 * h);
                let off = (slope - zero.h_gyro[row][k]).abs();
                assert!(off < 1e-9 * (1.0 + slope.abs()), "{name} row {row}, gyro {k}: {slope} {off:e}");
            }
        }
    }
}

#[test]
fn earth_rate_and_its_change_with_latitude_are_in_the_rows() {
    // The parts of the size of the Earth rate, which the differences above see through rounding only, by themselves:
    // a rate of zero leaves nothing else, and a lever of 1e5 m makes them large.
    let (truth, _) = somewhere();
    let lever = Vec3::<B>::new(4e4, -7e4, 5e4);
    let still = Pva { v_t: Vec3::ZERO, ..truth };
    let cases: [Box<dyn Measurement>; 3] = [
        Box::new(Velocity { v_t: Vec3::ZERO, sigma: [1.0; 3], lever, axes: measurement::ALL }),
        Box::new(NonHolonomic { sigma: [1.0; 2], lever }),
        Box::new(ZeroRate::new(1.0)),
    ];
    for (number, m) in cases.iter().enumerate() {
        let zero = m.observe(&Now::at(&still));
        let size = if number == 2 { 7e-5 } else { 7.0 };
        for k in [0, 1, 2, 6, 7, 8] {
            let h = if k < 3 { 1000.0 } else { 1e-4 };
            let z = [h, -h].map(|h| {
                let mut e = [0.0; 9];
                e[k] = h;
                m.observe(&Now::at(&with_errors(&still, &e))).z
            });
            for row in 0..zero.len {
                let slope = (z[0][row] - z[1][row]) / (2.0 * h);
                let off = (slope - zero.h_nav[row][k]).abs();
                let unit = if k < 3 { 6.4e6 } else { 1.0 };
                assert!(off * unit < 1e-6 * size, "{number} row {row}, error {k}: {slope:e} {off:e}");
            }
        }
    }
}

#[test]
fn integrated_velocity_is_the_position_error() {
    let m = IntegratedVelocity::new(Vec3::new(1.0, 2.0, 3.0), 0.1);
    let observation = m.observe(&Now::at(&somewhere().0));
    assert_eq!(observation.z, [1.0, 2.0, 3.0]);
    for row in 0..3 {
        for k in 0..9 {
            assert_eq!(observation.h_nav[row][k], f64::from(u8::from(row == k)));
        }
    }
}

/// Taking the estimate out of what a navigator with known errors has computed leaves the difference of error and
/// estimate, through the reset's Jacobian: to first order in the difference, at a large estimate.
#[test]
fn reset_leaves_what_its_jacobian_says() {
    let (truth, _) = somewhere();
    let estimate = NavError {
        dr: Vec3::new(30.0, -20.0, 10.0),
        dv: Vec3::new(0.5, -0.4, 0.3),
        phi: Vec3::new(0.05, -0.12, 0.2),
    };
    let left = |delta: [f64; 9]| {
        let mut e = estimate.as_array();
        for k in 0..9 {
            e[k] += delta[k];
        }
        let computed = with_errors(&truth, &e);
        NavError::between(&corrected(&computed, &estimate), &truth).as_array()
    };
    let nothing = left([0.0; 9]);
    for k in 0..9 {
        assert!(nothing[k].abs() < [1e-7, 1e-13, 1e-15][k / 3], "error {k}: {:e}", nothing[k]);
    }
    let jacobian = attitude_reset(estimate.phi);
    for k in 0..9 {
        let h = [1.0, 1e-2, 1e-5][k / 3];
        let [plus, minus] = [h, -h].map(|h| {
            let mut delta = [0.0; 9];
            delta[k] = h;
            left(delta)
        });
        for row in 0..9 {
            let slope = (plus[row] - minus[row]) / (2.0 * h);
            let expected =
                if row >= 6 && k >= 6 { jacobian[(row - 6, k - 6)] } else { f64::from(u8::from(row == k)) };
            // A metre of position error is counted by radii dr/R away.
            let tolerance = if k < 3 { 2e-5 } else { 1e-9 };
            assert!((slope - expected).abs() < tolerance, "({row}, {k}): {slope} {expected}");
        }
    }
    // Without it the error is of the size of the estimate.
    assert!((jacobian[(0, 1)] + 0.5 * 0.2).abs() < 0.02);
    // Small estimates, where closed forms cancel.
    for phi in [Vec3::new(1e-9, 2e-9, -1e-9), Vec3::new(0.0099, 0.0, 0.0), Vec3::new(0.0, 0.0101, 0.0)] {
        let off = attitude_reset(phi) * phi.as_nalgebra() - phi.as_nalgebra();
        assert!(off.norm() <= 1e-16, "{off}");
    }
}

/// The same errors seen in both forms: equal estimates, equal covariances of the phi errors, before and after a reset.
#[test]
fn both_forms_agree() {
    let (pva, omega) = somewhere();
    let sigmas = [10.0, 20.0, 5.0, 0.5, 0.3, 0.2, 1e-2, 2e-2, 5e-2];
    let filter = |form| {
        let model = Model::<9>::new(form, NavStates::ALL, &Spec::new()).unwrap();
        let mut filter = Filter::new(model, &sigmas).unwrap();
        let from = form.from_phi(&pva);
        filter.p = from * filter.p * from.transpose();
        filter
    };
    let [mut phi, mut psi] = [Form::Phi, Form::Psi].map(filter);
    let f = Vec3::new(0.5, -1.0, -9.6);
    for (name, m) in
        true_measurements(&with_errors(&pva, &[3.0, -5.0, 2.0, 0.1, 0.2, -0.1, 1e-3, -2e-3, 9e-3]), omega)
    {
        if matches!(name, "zero velocity" | "zero rate" | "non-holonomic") {
            continue;
        }
        let now = Now::new(&pva, omega, f);
        let (a, b) = (phi.update(m.as_ref(), &now).unwrap(), psi.update(m.as_ref(), &now).unwrap());
        assert!((a.nis - b.nis).abs() < 1e-6 * a.nis, "{name}: {} {}", a.nis, b.nis);
    }
    let compare = |phi: &Filter<9>, psi: &Filter<9>, pva: &Pva| {
        let to = Form::Psi.to_phi(pva);
        let p = to * psi.p * to.transpose();
        for i in 0..9 {
            for j in 0..9 {
                let size = (phi.p[(i, i)] * phi.p[(j, j)]).sqrt();
                assert!((p[(i, j)] - phi.p[(i, j)]).abs() < 1e-6 * size, "({i}, {j})");
            }
        }
    };
    compare(&phi, &psi, &pva);
    let (a, b) = (phi.feedback(&pva), psi.feedback(&pva));
    assert!(position_error(a.position, b.position).norm() < 1e-6);
    assert!((a.v_t - b.v_t).norm() < 1e-9);
    assert!(schuler_frames::phi_between(a.c_tb, b.c_tb).norm() < 1e-10);
    compare(&phi, &psi, &a);
}

/// An observation that says the same in correlated rows changes the filter as the vector formula does.
#[test]
fn correlated_rows_are_taken_as_the_vector_formula_takes_them() {
    let model = Model::<12>::new(Form::Phi, NavStates::ALL, &Spec::new()).unwrap();
    let mut filter = Filter::new(model, &[3.0, 2.0, 1.0, 0.5, 0.4, 0.3, 0.1, 0.2, 0.3]).unwrap();
    let pva = somewhere().0;
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for _ in 0..20 {
        let mut o = Observation::new(3, [random(), random(), random()], [0.0; 3]);
        let l = nalgebra::Matrix3::from_fn(|i, j| if i >= j { 0.3 + random() } else { 0.0 });
        let r = l * l.transpose() + nalgebra::Matrix3::identity() * 0.01;
        let h = nalgebra::SMatrix::<f64, 3, 12>::from_fn(|i, j| {
            let h = random();
            if j < 9 {
                o.h_nav[i][j] = h;
                h
            } else {
                0.0
            }
        });
        for i in 0..3 {
            for j in 0..3 {
                o.r[i][j] = r[(i, j)];
            }
        }
        let (p, x) = (filter.p, filter.x);
        let s = h * p * h.transpose() + r;
        let k = p * h.transpose() * s.try_inverse().unwrap();
        let nu = nalgebra::Vector3::from(o.z) - h * x;
        let reduce = nalgebra::SMatrix::<f64, 12, 12>::identity() - k * h;
        let (new_p, new_x) = (reduce * p * reduce.transpose() + k * r * k.transpose(), x + k * nu);
        let outcome = filter.update_with(&o, &Now::at(&pva)).unwrap();
        assert!(
            (outcome.nis - (nu.transpose() * s.try_inverse().unwrap() * nu)[0]).abs() < 1e-9 * outcome.nis
        );
        assert!((filter.x - new_x).norm() < 1e-12 * (1.0 + new_x.norm()));
        assert!((filter.p - new_p).norm() < 1e-12 * p.norm());
        assert_eq!(filter.p, filter.p.transpose());
        filter.p +=
            nalgebra::SMatrix::<f64, 12, 12>::from_fn(|i, j| if i == j && i < 9 { 0.05 } else { 0.0 });
    }
}
