//! Laws of noise against the methods themselves: to an impulse in one sample they answer linearly, so that the squares of their
//! answers to all impulses add to the variance under white noise, without any draw.

use schuler_frames::{B, Vec3, phi_between};
use schuler_strapdown::BodyMotion;
use schuler_strapdown::align::{Gyrocompass, InertialFrame, Limits, Solution};
use schuler_strapdown::static_base::Site;

use crate::base::{Base, GRAVITY};

/// Size of an impulse, rad or m/s: small enough for its square, large enough for rounding.
const IMPULSE: f64 = 1e-6;

fn level(lat: f64) -> Base {
    Base { mean: schuler_frames::Euler::new(0.0, 0.0, 0.0), ..Base::at_rest(lat) }
}

/// The motion with an impulse along an axis of the gyros (0 to 2) or the accelerometers (3 to 5).
fn knocked(motion: &BodyMotion, sensor: usize) -> BodyMotion {
    let unit = Vec3::<B>::claim(std::array::from_fn(|i| if i == sensor % 3 { IMPULSE } else { 0.0 }));
    match sensor {
        0..3 => BodyMotion { sigma: motion.sigma + unit, dv: motion.dv },
        _ => BodyMotion { sigma: motion.sigma, dv: motion.dv + unit },
    }
}

fn near(found: [f64; 3], law: [f64; 3], what: &str) {
    for (found, law) in found.into_iter().zip(law) {
        // Steps of a finite length, and the Earth's turn over the time, which the laws leave out.
        assert!((found / law - 1.0).abs() < 0.03, "{what}: {found:e} {law:e}");
    }
}

#[test]
fn inertial_forms_under_white_noise() {
    let (base, dt, steps) = (level(0.7), 1.0, 200);
    let laws = Limits::new(Site::new(base.position, GRAVITY));
    let t = dt * f64::from(steps);
    let motions: Vec<BodyMotion> = (0..steps).map(|k| base.motion(f64::from(k) * dt, dt)).collect();
    let collected = |sensor: usize, at: Option<usize>| {
        let mut frame = InertialFrame::new(0.5 * t);
        for (k, motion) in motions.iter().enumerate() {
            let motion = if Some(k) == at { knocked(motion, sensor) } else { *motion };
            frame.advance(&motion, dt);
        }
        frame
    };
    for solution in [Solution::Velocity, Solution::Position, Solution::Optimal] {
        let attitude = |frame: InertialFrame| frame.attitude(solution, base.position, GRAVITY).unwrap();
        let quiet = attitude(collected(0, None));
        let deviation = |sensors: std::ops::Range<usize>| {
            let mut squares = [0.0; 3];
            for (sensor, at) in sensors.flat_map(|s| (0..motions.len()).map(move |k| (s, k))) {
                let phi = phi_between(attitude(collected(sensor, Some(at))), quiet);
                (0..3).for_each(|i| squares[i] += (phi[i] / IMPULSE).powi(2) * dt);
            }
            squares.map(f64::sqrt)
        };
        let name = format!("{solution:?}");
        near(deviation(0..3), laws.inertial_angle_walk(solution, 1.0, t).as_array(), &name);
        near(deviation(3..6), laws.inertial_velocity_walk(solution, 1.0, t).as_array(), &name);
    }
}

#[test]
fn gyrocompass_under_white_noise() {
    let (base, tau, dt) = (level(0.7), 20.0, 0.1);
    let start = base.attitude(0.0);
    let new = || Gyrocompass::new(start, base.position, GRAVITY, tau);
    // In the settled loop the answer depends on the lag alone: one impulse shows all of them.
    let deviation = |sensors: std::ops::Range<usize>| {
        let mut squares = [0.0; 3];
        for sensor in sensors {
            let (mut quiet, mut loud, mut first) = (new(), new(), true);
            base.run(30.0 * tau, dt, |motion, dt| {
                quiet.advance(motion, dt);
                let motion = if std::mem::take(&mut first) { knocked(motion, sensor) } else { *motion };
                loud.advance(&motion, dt);
                let phi = phi_between(loud.attitude(), quiet.attitude());
                (0..3).for_each(|i| squares[i] += (phi[i] / IMPULSE).powi(2) * dt);
            });
        }
        squares.map(f64::sqrt)
    };
    near(deviation(0..3), new().angle_walk(1.0).as_array(), "angle");
    near(deviation(3..6), new().velocity_walk(1.0).as_array(), "velocity");
}
