//! Alignment in inertial space.

use schuler_frames::{Vec3, phi_between};
use schuler_strapdown::align::{InertialError, InertialFrame, Limits, Solution};
use schuler_strapdown::static_base::Site;

use crate::base::{ARCMIN, Base, DEG_PER_H, GRAVITY, UG};

const ALL: [Solution; 3] = [Solution::Velocity, Solution::Position, Solution::Optimal];

fn collect(base: &Base, duration: f64, dt: f64) -> InertialFrame {
    let mut frame = InertialFrame::new(0.5 * duration);
    base.run(duration, dt, |motion, dt| frame.advance(motion, dt));
    frame
}

#[test]
fn perfect_sensors_find_the_attitude_and_the_latitude_at_rest() {
    for lat in [-1.2, -0.3, 0.1, 0.8, 1.3] {
        let base = Base::at_rest(lat);
        let frame = collect(&base, 600.0, 0.1);
        for solution in ALL {
            let found = frame.attitude(solution, base.position, GRAVITY).unwrap();
            // The trapezoid of the position form leaves the most; an arc second is 5e-6 rad.
            let phi = phi_between(found, base.attitude(600.0)).norm();
            assert!(phi < 1e-9, "{solution:?} at {lat}: {phi:e}");
        }
        let found = frame.latitude().unwrap();
        // The cone is the flatter the nearer to the equator.
        assert!((found - lat).abs() < 1e-8, "{found} at {lat}");
    }
}

/// 2 deg of rocking about each axis, 600 s: means of rate and force would be off by tens of degrees.
#[test]
fn rocking_does_no_harm() {
    let mut base = Base::at_rest(0.8);
    base.sway = [2.0, 1.7, 1.3]
        .map(f64::to_radians)
        .into_iter()
        .zip([8.0, 6.0, 10.0])
        .collect::<Vec<_>>()
        .try_into()
        .unwrap();
    let frame = collect(&base, 600.0, 0.01);
    for solution in ALL {
        let found = frame.attitude(solution, base.position, GRAVITY).unwrap();
        let phi = phi_between(found, base.attitude(600.0));
        assert!(phi.norm() < 1e-7, "{solution:?}: {phi:?}");
    }
    assert!((frame.latitude().unwrap() - 0.8).abs() < 1e-6);
}

/// Constant errors turn the heading by the bias limit, as far as ten minutes are short against the Earth's turn.
#[test]
fn constant_errors_leave_the_bias_limit() {
    for (eps, nabla) in [
        (Vec3::new(0.01 * DEG_PER_H, 0.0, 0.0), Vec3::ZERO),
        (Vec3::new(0.0, 0.01 * DEG_PER_H, 0.0), Vec3::ZERO),
        (Vec3::ZERO, Vec3::new(100.0 * UG, 0.0, 0.0)),
        (Vec3::ZERO, Vec3::new(0.0, 100.0 * UG, 0.0)),
    ] {
        let base = Base { eps_b: eps, nabla_b: nabla, ..Base::at_rest(0.8) };
        let truth = base.attitude(0.0);
        let limit = Limits::new(Site::new(base.position, GRAVITY)).bias(truth * eps, truth * nabla);
        let frame = collect(&base, 600.0, 0.1);
        for solution in ALL {
            let found = frame.attitude(solution, base.position, GRAVITY).unwrap();
            let phi = phi_between(found, base.attitude(600.0));
            assert!((phi[2] - limit[2]).abs() < 0.1 * ARCMIN, "{solution:?}: {} {}", phi[2], limit[2]);
            // An accelerometer tilts by nabla / g; a gyro by what it drifts since the middle of the specific force. The error
            // stands still in inertial space while the place turns by Ω t / 2 = 0.022.
            let drift = eps.norm() * 600.0 + 0.03 * limit.norm();
            assert!((phi[0] - limit[0]).abs() < drift, "{solution:?}: {} {}", phi[0], limit[0]);
            assert!((phi[1] - limit[1]).abs() < drift, "{solution:?}: {} {}", phi[1], limit[1]);
        }
    }
}

#[test]
fn what_cannot_be_had_is_refused() {
    let base = Base::at_rest(0.8);
    let mut frame = InertialFrame::new(300.0);
    let short = |time| InertialError::TooShort { split: 300.0, time };
    assert_eq!(frame.attitude(Solution::Optimal, base.position, GRAVITY), Err(short(0.0)));
    base.run(10.0, 0.5, |motion, dt| frame.advance(motion, dt));
    assert_eq!(frame.attitude(Solution::Velocity, base.position, GRAVITY), Err(short(10.0)));
    assert_eq!(frame.latitude(), Err(short(10.0)));
    let pole = Base::at_rest(std::f64::consts::FRAC_PI_2);
    let frame = collect(&pole, 600.0, 1.0);
    for solution in ALL {
        let answer = frame.attitude(solution, pole.position, GRAVITY);
        assert!(matches!(answer, Err(InertialError::NoHeading { .. })), "{answer:?}");
    }
}
