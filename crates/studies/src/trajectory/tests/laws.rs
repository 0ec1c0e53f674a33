//! What holds for every kind.

use schuler_frames::{B, E, Gravity, Rot, Vec3, wgs84};

use super::kinds::{Kind, kinds};
use crate::trajectory::Kinematics;

/// Times within the span of a kind, away from its joints by `margin`.
fn times(kind: &Kind, margin: f64) -> Vec<f64> {
    let all = (0..200).map(|k| -0.02 + kind.span * (k as f64 + 0.37) / 200.0);
    all.filter(|t| kind.motion().joints().iter().all(|joint| (joint - t).abs() > margin)).collect()
}

/// Derivative by a central difference of sixth order.
fn derivative(h: f64, f: impl Fn(f64) -> Vec3<E>) -> Vec3<E> {
    let pair = |k: f64| f(k * h) - f(-k * h);
    (pair(1.0) * 45.0 - pair(2.0) * 9.0 + pair(3.0)) * (1.0 / (60.0 * h))
}

fn c_eb(k: &Kinematics) -> Rot<E, B> {
    k.position.c_et() * k.c_tb
}

fn velocity(k: &Kinematics) -> Vec3<E> {
    k.position.c_et() * k.v_t
}

/// Velocity is the derivative of position, acceleration that of velocity, the rate of turn that of attitude, and the angular
/// acceleration that of the rate. Order six at these steps leaves 1e-9 of the largest, and rounding of a position 1e-9 m.
#[test]
fn derivatives() {
    for kind in kinds(Gravity::Normal) {
        let fastest =
            (0..100).map(|k| kind.motion().fastest(0.01 * kind.span * f64::from(k))).fold(0.0, f64::max);
        let h = (0.04 / fastest.max(1e-3)).min(0.5);
        let at = |t: f64| kind.motion().at(t);
        for t in times(&kind, 3.1 * h) {
            let now = at(t);
            let name = kind.name;

            let v = derivative(h, |s| at(t + s).position.as_ecef());
            let error = (v - velocity(&now)).norm();
            assert!(error <= 1e-9 * now.v_t.norm() + 5e-9 / h, "{name}: v at {t}: {error:e}");

            let a = derivative(h, |s| velocity(&at(t + s)));
            let error = (a - now.position.c_et() * now.a_t).norm();
            let scale = fastest * now.v_t.norm() + now.a_t.norm();
            assert!(error <= 1e-8 * scale + 1e-13 * now.v_t.norm() / h, "{name}: a at {t}: {error:e}");

            // Derivatives of the columns of C_b^e: omega × column.
            let c = c_eb(&now);
            let omega = c * now.omega_eb_b;
            for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::<B>::claim) {
                let rate = derivative(h, |s| c_eb(&at(t + s)) * axis);
                let error = (rate - omega.cross(c * axis)).norm();
                assert!(error <= 1e-9 * fastest + 1e-15 / h, "{name}: omega at {t}: {error:e}");
            }
            // Components of the rate in b.
            let alpha = derivative(h, |s| Vec3::claim(at(t + s).omega_eb_b.as_array()));
            let error = (alpha - Vec3::claim(now.alpha_eb_b.as_array())).norm();
            let scale = fastest * now.omega_eb_b.norm() + now.alpha_eb_b.norm();
            assert!(error <= 1e-8 * scale + 1e-17 / h, "{name}: alpha at {t}: {error:e}");
        }
    }
}

/// Newton's law in e, written once more: f = C_e^b (r'' + 2 omega × r' + omega × (omega × r) - gravitation).
#[test]
fn specific_force_and_rate_against_inertial_space() {
    let omega = Vec3::<E>::new(0.0, 0.0, wgs84::OMEGA);
    for gravity in [Gravity::Normal, Gravity::Somigliana] {
        for kind in kinds(gravity) {
            for t in times(&kind, 0.0) {
                let now = kind.motion().at(t);
                let c_et = now.position.c_et();
                let (r, v, a) = (now.position.as_ecef(), c_et * now.v_t, c_et * now.a_t);
                let f = a + omega.cross(v) * 2.0 + omega.cross(omega.cross(r)) - gravity.gravitation_e(r);
                let c_be = c_eb(&now).inverse();
                let moment = kind.truth.moment(t);
                assert!((moment.f_b - c_be * f).norm() < 2e-14 * (9.8 + f.norm()), "{} at {t}", kind.name);
                let rate = now.omega_eb_b + c_be * omega;
                let error = (moment.omega_ib_b.as_vec3() - rate).norm();
                assert!(error <= 1e-19 + 1e-15 * rate.norm(), "{} at {t}: {error:e}", kind.name);
                // The Earth's rate stays in e: what changes in b is its direction there.
                let alpha = now.alpha_eb_b - now.omega_eb_b.cross(c_be * omega);
                assert!((moment.alpha_ib_b - alpha).norm() < 1e-18 + 1e-15 * alpha.norm());
            }
        }
    }
}

/// Increments over an interval are the sum of those over its parts, wherever it is cut and whatever joints it has:
/// quadrature is exact to rounding.
#[test]
fn increments_add_up() {
    for kind in kinds(Gravity::Normal) {
        let joints = kind.motion().joints();
        let near = joints.iter().map(|joint| joint - 0.0037).filter(|t| *t < kind.span);
        for t in times(&kind, 0.0).into_iter().chain(near) {
            let dt = 0.01;
            let whole = kind.truth.increments(t, dt);
            let (mut dtheta, mut dv) = (Vec3::<B>::ZERO, Vec3::<B>::ZERO);
            let parts = 16;
            for k in 0..parts {
                let part = dt / f64::from(parts);
                let increments = kind.truth.increments(t + f64::from(k) * part, part);
                dtheta += increments.dtheta;
                dv += increments.dv;
            }
            let errors = [(whole.dtheta - dtheta).norm(), (whole.dv - dv).norm()];
            // Times have been rounded, by 1e-16 of them: in that time a force that turns or jumps has changed.
            let jump = if kind.smooth { 0.0 } else { 1.4e-14 };
            let moment = kind.truth.moment(t);
            let alpha =
                [t, t + dt].map(|t| kind.truth.moment(t).alpha_ib_b.norm()).into_iter().fold(0.0, f64::max);
            let turn = moment.omega_ib_b.as_vec3().norm()
                + kind.motion().fastest(t).max(kind.motion().fastest(t + dt));
            let limits = [
                1e-17 + 2e-16 * dt * (turn + 2.0 * t * alpha) + jump,
                1e-16 + 1e-15 * (1.0 + turn) * moment.f_b.norm() * dt * (1.0 + 0.2 * t) + 10.0 * jump,
            ];
            let fine = errors[0] < limits[0] && errors[1] < limits[1];
            assert!(fine, "{} at {t}: {errors:?}, {limits:?}", kind.name);
        }
    }
}

/// Joints are at least C2 in position and C1 in attitude: what is on both sides of one agrees.
#[test]
fn joints_are_smooth() {
    for kind in kinds(Gravity::Normal).into_iter().filter(|kind| kind.smooth) {
        for &joint in kind.motion().joints() {
            // The third derivative may jump, so a difference falls with the distance.
            let apart = |d: f64| {
                let (a, b) = (kind.motion().at(joint - d), kind.motion().at(joint + d));
                let turned = (a.c_tb.inverse() * b.c_tb).as_rotation_vector();
                [
                    (b.v_t - a.v_t).norm(),
                    (b.a_t - a.a_t).norm(),
                    Vec3::<B>::claim(turned.as_array()).norm(),
                    (b.omega_eb_b - a.omega_eb_b).norm(),
                ]
            };
            let scale =
                1.0 + kind.motion().fastest(joint - 1e-3).max(kind.motion().fastest(joint + 1e-3)).powi(3);
            for change in apart(1e-6) {
                assert!(change < 1e-4 * scale, "{} at {joint}: {change:e}", kind.name);
            }
        }
    }
}
