//! Laws of rotations and of their representations.

use core::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use schuler_frames::{B, Dcm, E, Euler, I, Rot, RotationError, T, Vec3, phi_between, with_phi};

use crate::{rotations, vectors};

/// Rounding of a few products of numbers up to 1.
const EPS: f64 = 8e-15;

/// Angle between two rotations, rad.
fn angle(a: Rot<T, B>, b: Rot<T, B>) -> f64 {
    phi_between(a, b).norm()
}

proptest! {
    #![proptest_config(crate::laws())]

    #[test]
    fn products_are_those_of_a_group(a in rotations::<T, B>(), b in rotations::<B, I>(), c in rotations::<I, E>(), v in vectors::<E>(1.0)) {
        prop_assert!((((a * b) * c) * v - a * (b * (c * v))).norm() < EPS);
        prop_assert!((a.inverse() * (a * (b * (c * v))) - b * (c * v)).norm() < EPS);
        prop_assert!(angle(a * Rot::<B, B>::IDENTITY, a) < EPS);
        prop_assert!(angle(a * (a.inverse() * a), a) < EPS);
        prop_assert!(((a * b).inverse() * (a * (b * (c * v))) - c * v).norm() < EPS);
    }

    #[test]
    fn rotations_keep_lengths_angles_and_hands(q in rotations::<T, B>(), v in vectors::<B>(1.0), w in vectors::<B>(1.0)) {
        prop_assert!(((q * v).dot(q * w) - v.dot(w)).abs() < EPS);
        prop_assert!(((q * v).cross(q * w) - q * v.cross(w)).norm() < EPS);
    }

    #[test]
    fn matrices_do_what_quaternions_do(a in rotations::<T, B>(), b in rotations::<B, I>(), v in vectors::<I>(1.0)) {
        prop_assert!(((a.as_dcm() * b.as_dcm()) * v - (a * b) * v).norm() < EPS);
        prop_assert!((a.as_dcm().transpose() * (a * (b * v)) - b * v).norm() < EPS);
        let product = a.as_dcm().as_nalgebra() * (b * v).as_nalgebra();
        prop_assert!((Vec3::claim(product.into()) - a * (b * v)).norm() < EPS);
    }

    #[test]
    fn each_representation_comes_back(q in rotations::<T, B>()) {
        prop_assert!(angle(Rot::from_euler(q.as_euler()), q) < EPS);
        prop_assert!(angle(Rot::from_rotation_vector(q.as_rotation_vector()), q) < EPS);
        prop_assert!(angle(Rot::from_dcm(q.as_dcm()), q) < EPS);
        prop_assert!(angle(Rot::from_dcm(Dcm::from_rows(q.as_dcm().as_rows()).unwrap()), q) < EPS);
        prop_assert!(angle(Rot::from_quaternion(q.as_quaternion()).unwrap(), q) < EPS);
        prop_assert!(q.as_rotation_vector().norm() <= PI + EPS);
        let e = q.as_euler();
        prop_assert!(e.pitch.abs() <= FRAC_PI_2 && e.roll.abs() <= PI && e.yaw.abs() <= PI);
    }

    #[test]
    fn euler_angles_come_back(roll in -PI..PI, pitch in -1.57..1.57f64, yaw in -PI..PI) {
        let e = Rot::<T, B>::from_euler(Euler::new(roll, pitch, yaw)).as_euler();
        // Roll and yaw are determined to rounding / cos(pitch).
        let tolerance = EPS / pitch.cos();
        prop_assert!((e.pitch - pitch).abs() < EPS, "{e:?}");
        prop_assert!((e.roll - roll).abs() < tolerance && (e.yaw - yaw).abs() < tolerance, "{e:?}");
    }

    /// However near to gimbal lock, the three angles together give the rotation back.
    #[test]
    fn gimbal_lock_loses_no_rotation(roll in -PI..PI, exponent in -18..0i32, up in any::<bool>(), yaw in -PI..PI) {
        let pitch = (FRAC_PI_2 - 10f64.powi(exponent)) * if up { 1.0 } else { -1.0 };
        let q = Rot::<T, B>::from_euler(Euler::new(roll, pitch, yaw));
        prop_assert!(angle(Rot::from_euler(q.as_euler()), q) < EPS);
        prop_assert!((q.as_euler().pitch - pitch).abs() < EPS);
    }

    /// Tiny angles keep all their digits.
    #[test]
    fn rotation_vectors_come_back(v in vectors::<T>(1.8), exponent in -300..=0i32) {
        let v = v * 10f64.powi(exponent);
        let back = Rot::<T, B>::from_rotation_vector(v).as_rotation_vector();
        prop_assert!((back - v).norm() <= 2e-15 * v.norm(), "{back:?} {v:?}");
    }

    /// exp((s + t) v) = exp(s v) exp(t v).
    #[test]
    fn turns_about_one_axis_add(v in vectors::<T>(1.0), s in -3.0..3.0f64, t in -3.0..3.0f64) {
        let turn = |k: f64| Rot::<T, T>::from_rotation_vector(v * k);
        prop_assert!(phi_between(turn(s) * turn(t), turn(s + t)).norm() < EPS);
    }

    #[test]
    fn phi_is_what_with_phi_puts_in(truth in rotations::<T, B>(), v in vectors::<T>(1.8), exponent in -14..=0i32) {
        let phi = v * 10f64.powi(exponent);
        prop_assert!((phi_between(with_phi(truth, phi), truth) - phi).norm() < EPS);
    }

    /// The definition C_computed = exp(-[phi ×]) C_true, to first order: C_computed v = C_true v - phi × C_true v.
    #[test]
    fn phi_has_the_sign_of_its_definition(truth in rotations::<T, B>(), phi in vectors::<T>(1e-8), v in vectors::<B>(1.0)) {
        let turned = with_phi(truth, phi) * v - truth * v;
        prop_assert!((turned + phi.cross(truth * v)).norm() < EPS + 2.0 * phi.norm_squared());
    }

    /// phi against exact integer arithmetic on the quaternions as given, down to 1e-14 rad.
    #[test]
    fn phi_of_tiny_angles_keeps_its_digits(truth in rotations::<T, B>(), v in vectors::<T>(1.0), exponent in -14..-7i32) {
        let computed = with_phi(truth, v * 10f64.powi(exponent));
        let fixed = |q: Rot<T, B>| q.as_quaternion().map(|c| (c * 2f64.powi(62)).round() as i128);
        let ([a, b, c, d], [w, x, y, z]) = (fixed(computed), fixed(truth));
        // Vector part of computed * truth⁻¹; components below 2^-10 lose digits in the 62 bits, 1e-19 at most.
        let exact = [-a * x + b * w - c * z + d * y, -a * y + b * z + c * w - d * x, -a * z - b * y + c * x + d * w];
        let exact = Vec3::<T>::claim(exact.map(|n| n as f64 * 2f64.powi(-124) * -2.0));
        let phi = phi_between(computed, truth);
        prop_assert!((phi - exact).norm() < 1e-14 * exact.norm() + 1e-18, "{phi:?} {exact:?}");
    }

    /// q and -q are one rotation: the error is the same to the last bit.
    #[test]
    fn phi_does_not_see_the_sign_of_a_quaternion(truth in rotations::<T, B>(), v in vectors::<T>(1.0), exponent in -14..=0i32) {
        let computed = with_phi(truth, v * 10f64.powi(exponent));
        let minus = Rot::claim(computed.as_quaternion().map(|c| -c));
        prop_assert_eq!(phi_between(minus, truth), phi_between(computed, truth));
    }

    #[test]
    fn norms_are_mended(q in rotations::<T, B>(), k in 0.5..2.0f64) {
        let norm = |q: Rot<T, B>| q.as_quaternion().iter().map(|c| c * c).sum::<f64>().sqrt();
        let times = |k: f64| Rot::<T, B>::claim(q.as_quaternion().map(|c| c * k));
        prop_assert!((norm(times(k).normalized()) - 1.0).abs() < 4e-16);
    }
}

/// Axes that can be checked by eye: nose up, right wing down, nose to the east.
#[test]
fn euler_angles_turn_as_a_pilot_expects() {
    let quarter = FRAC_PI_2;
    let forward = Vec3::<B>::new(1.0, 0.0, 0.0);
    let right = Vec3::<B>::new(0.0, 1.0, 0.0);
    for (angles, body, local) in [
        (Euler::new(0.0, 0.0, quarter), forward, [0.0, 1.0, 0.0]),
        (Euler::new(0.0, quarter, 0.0), forward, [0.0, 0.0, -1.0]),
        (Euler::new(quarter, 0.0, 0.0), right, [0.0, 0.0, 1.0]),
        // Yaw first: facing east and pitched up the nose is up, rolled there the right wing is south.
        (Euler::new(0.0, quarter, quarter), forward, [0.0, 0.0, -1.0]),
        (Euler::new(0.0, 0.0, quarter), right, [-1.0, 0.0, 0.0]),
    ] {
        let c_tb: Rot<T, B> = Rot::from_euler(angles);
        assert!((c_tb * body - Vec3::claim(local)).norm() < 4e-16, "{angles:?}");
    }
}

/// The quaternion of a turn by 90 deg about z, scalar first, and Hamilton's i j = k.
#[test]
fn quaternions_are_hamiltons_scalar_first() {
    let half = 0.5f64.sqrt();
    let q = Rot::<T, B>::from_quaternion([half, 0.0, 0.0, half]).unwrap();
    assert!((q * Vec3::new(1.0, 0.0, 0.0) - Vec3::new(0.0, 1.0, 0.0)).norm() < EPS);
    let [i, j] = [[0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]].map(Rot::<T, T>::claim);
    assert_eq!((i * j).as_quaternion(), [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn at_gimbal_lock_yaw_takes_all() {
    for pitch in [FRAC_PI_2, -FRAC_PI_2] {
        let e = Rot::<T, B>::from_euler(Euler::new(0.5, pitch, 1.2)).as_euler();
        assert_eq!(e.roll, 0.0);
        assert!((e.pitch - pitch).abs() < EPS);
        assert!((e.yaw - (1.2 - 0.5 * pitch.signum())).abs() < EPS, "{e:?}");
    }
}

#[test]
fn what_is_no_rotation_is_refused() {
    let quaternion = |q| Rot::<T, B>::from_quaternion(q).unwrap_err();
    assert_eq!(quaternion([2.0, 0.0, 0.0, 0.0]), RotationError::NotUnit { norm: 2.0 });
    assert_eq!(quaternion([0.0; 4]), RotationError::NotUnit { norm: 0.0 });
    assert!(matches!(quaternion([f64::NAN, 0.0, 0.0, 1.0]), RotationError::NotUnit { .. }));
    let matrix = |rows| Dcm::<T, B>::from_rows(rows).unwrap_err();
    let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut mirror = unit;
    mirror[1][1] = -1.0;
    assert_eq!(matrix(mirror), RotationError::Reflection);
    let mut skewed = unit;
    skewed[0][1] = 1e-3;
    assert_eq!(matrix(skewed), RotationError::NotOrthonormal { excess: 1e-3 });
    let mut hole = unit;
    hole[2][0] = f64::NAN;
    assert!(matches!(matrix(hole), RotationError::NotOrthonormal { .. }));
    let message = quaternion([2.0, 0.0, 0.0, 0.0]).to_string();
    assert_eq!(message, "a rotation needs a quaternion of norm 1 (within 1e-6), but its norm is 2");
}

/// Six printed digits are enough to come in, and what came in is a rotation to rounding.
#[test]
fn printed_matrices_come_in() {
    let rows = [[0.866025, -0.5, 0.0], [0.5, 0.866025, 0.0], [0.0, 0.0, 1.0]];
    let q = Rot::<T, B>::from_dcm(Dcm::from_rows(rows).unwrap());
    assert!((q.as_euler().yaw - PI / 6.0).abs() < 1e-6);
    assert!((q * Vec3::new(3.0, 4.0, 0.0)).norm() - 5.0 < EPS);
}
