//! The gyrocompass loop.

use schuler_frames::{Vec3, phi_between, with_phi};
use schuler_strapdown::align::{Gyrocompass, Limits};
use schuler_strapdown::static_base::Site;

use crate::base::{ARCMIN, Base, DEG_PER_H, GRAVITY, UG};

/// From five degrees of heading and one of tilt, with errors in all six sensors, it comes to rest where its law says.
#[test]
fn settles_at_its_law_from_a_coarse_start() {
    let mut base = Base::at_rest(0.8);
    base.eps_b = Vec3::new(0.01, -0.02, 0.015) * DEG_PER_H;
    base.nabla_b = Vec3::new(50.0, -80.0, 30.0) * UG;
    let truth = base.attitude(0.0);
    let start = with_phi(truth, Vec3::new(1.0, -1.0, 5.0) * (60.0 * ARCMIN));
    for tau in [60.0, 30.0] {
        let mut loop_ = Gyrocompass::new(start, base.position, GRAVITY, tau);
        base.run(30.0 * tau, 0.05, |motion, dt| loop_.advance(motion, dt));
        let settled = loop_.settled(truth * base.eps_b, truth * base.nabla_b);
        let residue = phi_between(loop_.attitude(), truth) - settled;
        // Second order: a gyro error resolved in axes that are off by phi, seen as heading.
        let second =
            settled.norm() * base.eps_b.norm() / Limits::new(Site::new(base.position, GRAVITY)).omega_north();
        assert!(residue.norm() < 2.0 * second, "tau {tau}: {residue:?} {settled:?}");
    }
}

/// Without errors the triple pole lets go of a small heading error as e^-x (1 + x + x²/2), x = t / tau.
#[test]
fn heading_comes_in_as_a_triple_pole() {
    let base = Base::at_rest(0.8);
    let (tau, phi_d) = (40.0, 1e-4);
    let mut loop_ = Gyrocompass::new(
        with_phi(base.attitude(0.0), Vec3::new(0.0, 0.0, phi_d)),
        base.position,
        GRAVITY,
        tau,
    );
    let mut t = 0.0;
    base.run(8.0 * tau, 0.02, |motion, dt| {
        loop_.advance(motion, dt);
        t += dt;
        let x = t / tau;
        let expected = phi_d * (-x).exp() * (1.0 + x + 0.5 * x * x);
        let found = phi_between(loop_.attitude(), base.attitude(0.0))[2];
        // The coupling of the channels is tau times the Earth rate, 0.3 %; the step 0.05 %.
        assert!((found - expected).abs() < 0.01 * phi_d, "{t}: {found} {expected}");
    });
}
