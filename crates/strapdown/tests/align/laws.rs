//! The limits against the figures of the tables' authors (optimal filter covariance, checked there to 0.7 %).

use schuler_frames::Geodetic;
use schuler_strapdown::align::Limits;
use schuler_strapdown::static_base::Site;

use crate::base::{ARCMIN, DEG_PER_H, GRAVITY, UG};

fn at_45() -> Limits {
    Limits::new(Site::new(Geodetic::new(45f64.to_radians(), 0.0, 0.0), GRAVITY))
}

/// Relative difference below half a unit of the last digit printed.
fn agrees(found: f64, printed: f64, digits: f64) {
    assert!((found / printed - 1.0).abs() < digits, "{found} {printed}");
}

#[test]
fn laws_of_heading() {
    let limits = at_45();
    // 0.003 deg/√h
    let n = 0.003 * DEG_PER_H * 60.0;
    for (t, arcmin) in [(60.0, 7.51), (300.0, 3.36), (600.0, 2.376), (3600.0, 0.975)] {
        agrees(limits.heading_angle_walk(n, t) / ARCMIN, arcmin, 2e-3);
    }
    agrees(limits.heading_angle_walk(n, 1e6) / ARCMIN, 0.418, 2e-3);
    agrees(limits.heading_velocity_walk(10.0 * UG, 600.0) / ARCMIN, 0.157, 4e-3);
    for (t, arcmin) in [(60.0, 65.4), (300.0, 1.170), (600.0, 0.2069)] {
        agrees(limits.heading_velocity_noise(1e-4, t) / ARCMIN, arcmin, 1e-3);
    }
    // 50 µg and 0.01 deg/h: 3.237 arc minutes.
    agrees(limits.bias_sigma(0.01 * DEG_PER_H, 50.0 * UG)[2] / ARCMIN, 3.237, 2e-4);
}

/// A sensor noise integrated by TRIAD begins as the filter's does.
#[test]
fn triad_is_as_good_as_the_filter_for_short_times() {
    let limits = at_45();
    let ratio = limits.heading_triad(1e-6, 600.0) / limits.heading_angle_walk(1e-6, 600.0);
    // √(x coth x) = 1 + x²/6 …, x = Ω cos L t = 0.031
    agrees(1.0 / ratio, 1.0 + 0.03094f64.powi(2) / 6.0, 1e-6);
}
