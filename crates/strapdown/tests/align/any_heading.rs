//! Fine alignment from any heading.

use schuler_frames::{Euler, Vec3, phi_between};
use schuler_strapdown::align::{AnyHeading, AnyHeadingNoise, Limits};
use schuler_strapdown::static_base::Site;

use crate::base::{ARCMIN, Base, DEG_PER_H, GRAVITY, UG};

const NOISE: AnyHeadingNoise =
    AnyHeadingNoise { tilt: 0.01, velocity: 0.1, measurement: 0.01, angle_walk: 8.7e-7, velocity_walk: 1e-4 };

fn run(base: &Base, duration: f64) -> AnyHeading {
    let first = base.motion(0.0, 0.05).dv * 20.0;
    let mut align = AnyHeading::new(first, base.position, GRAVITY, NOISE);
    let mut steps = 0;
    base.run(duration, 0.05, |motion, dt| {
        align.advance(motion, dt);
        steps += 1;
        if steps % 20 == 0 {
            align.measure([0.0; 2]);
        }
    });
    align
}

#[test]
fn finds_every_heading() {
    for lat in [-0.7, 0.8] {
        for k in 0..8 {
            let mean = Euler::new(0.1, -0.2, f64::from(k) * 0.8 - 2.5);
            let base = Base { mean, ..Base::at_rest(lat) };
            let phi = phi_between(run(&base, 600.0).attitude(), base.attitude(600.0));
            // Without noise of sensors what is left is the prior of the Earth rate against what 600 s tell.
            assert!(phi.norm() < 0.02 * ARCMIN, "{lat} {k}: {phi:?}");
        }
    }
}

#[test]
fn a_body_on_its_head_is_levelled_too() {
    let base = Base { mean: Euler::new(std::f64::consts::PI, 0.0, 1.0), ..Base::at_rest(0.8) };
    let phi = phi_between(run(&base, 600.0).attitude(), base.attitude(600.0));
    assert!(phi.norm() < 0.02 * ARCMIN, "{phi:?}");
}

/// Its own standard deviation of heading follows the laws of noise, and constant errors leave the bias limit.
#[test]
fn keeps_to_the_laws() {
    let mut base = Base::at_rest(0.8);
    base.eps_b = Vec3::new(0.01, -0.02, 0.015) * DEG_PER_H;
    base.nabla_b = Vec3::new(50.0, -80.0, 30.0) * UG;
    let truth = base.attitude(0.0);
    let limits = Limits::new(Site::new(base.position, GRAVITY));
    let align = run(&base, 600.0);
    let phi = phi_between(align.attitude(), truth);
    let bias = limits.bias(truth * base.eps_b, truth * base.nabla_b);
    // The down gyro turns l itself, by 0.03 arc minutes in the time; the Earth rate found is about that of its middle.
    let turned = (truth * base.eps_b)[2].abs() * 600.0;
    assert!((phi - bias).norm() < 0.6 * turned, "{phi:?} {bias:?}");

    let heading = limits
        .heading_angle_walk(NOISE.angle_walk, 600.0)
        .hypot(limits.heading_velocity_walk(NOISE.velocity_walk, 600.0))
        .hypot(limits.heading_velocity_noise(1e-4, 600.0));
    // The laws add in variance about: each alone weighs the data in its own way.
    let sigma = align.sigma()[2];
    assert!((sigma / heading - 1.0).abs() < 0.1, "{sigma} {heading}");
}
