//! Radii that hold a share of normal errors.

use std::f64::consts::PI;

use nalgebra::{Matrix2, Matrix3};

use super::super::radius::{derivative, may_grow, radius, spherical};

/// Circle (1.177410, 2.447747 standard deviations: √(2 ln 2), √(-2 ln 0.05)), line (0.674490, 1.959964), and between them
/// a ratio of 0.5, of which Weingarten and Di Donato (A table of generalized circular error, Math. Comp. 15, 1961) is the
/// published kind of table: here against plain integration of the density.
#[test]
fn radii_in_the_plane() {
    let plane = |a: f64, b: f64| Matrix2::new(a * a, 0.0, 0.0, b * b);
    for (p, r) in [(0.5, (2.0 * 2f64.ln()).sqrt()), (0.95, (-2.0 * 0.05f64.ln()).sqrt())] {
        assert!((radius(&plane(3.0, 3.0), p) / (3.0 * r) - 1.0).abs() < 1e-12);
    }
    for (p, r) in [(0.5, 0.674_489_750_196_081_7), (0.95, 1.959_963_984_540_054)] {
        for line in [plane(2.0, 0.0), Matrix2::new(2.0, 2.0, 2.0, 2.0)] {
            assert!((radius(&line, p) / (2.0 * r) - 1.0).abs() < 1e-7, "{p}: {}", radius(&line, p));
        }
    }
    let (a, b, r) = (1.0, 0.5, 1.3);
    let n = 4000;
    let inside: f64 = (0..n)
        .map(|k| {
            // Along x = r sin u the density, across it the exact probability of |y| < r cos u.
            let (s, c) = libm::sincos((k as f64 + 0.5) / n as f64 * PI / 2.0);
            let along = (-0.5 * (r * s / a).powi(2)).exp() / (a * (2.0 * PI).sqrt()) * r * c;
            2.0 * along * libm::erf(r * c / (b * 2f64.sqrt())) * PI / 2.0 / n as f64
        })
        .sum();
    let found = radius(&plane(a, b), inside);
    assert!((found - r).abs() < 1e-6, "{found} {r}");
}

/// The ball: roots of the chi-square quantiles of three degrees of freedom, 2.365974 and 7.814728 (NIST/SEMATECH e-Handbook,
/// 1.3.6.7.4, to more digits). Flat errors are those of the plane, and a spheroid is integrated plainly.
#[test]
fn radii_in_space() {
    let diagonal = |a: f64, b: f64, c: f64| Matrix3::from_diagonal(&[a * a, b * b, c * c].into());
    for (p, chi) in [(0.5, 2.365_973_884_375_337_5_f64), (0.95, 7.814_727_903_251_178)] {
        let found = spherical(&diagonal(2.0, 2.0, 2.0), p);
        assert!((found / (2.0 * chi.sqrt()) - 1.0).abs() < 1e-9, "{p}: {found}");
        for (a, b) in [(3.0, 3.0), (3.0, 1.0), (3.0, 0.0)] {
            let plane = radius(&Matrix2::new(a * a, 0.0, 0.0, b * b), p);
            assert!((spherical(&diagonal(0.0, b, a), p) / plane - 1.0).abs() < 1e-12);
            // Nearly flat: the last axis adds its variance over the radius, far below 1e-5 here.
            let near = spherical(&diagonal(a, 1e-4, b), p);
            assert!((near / plane - 1.0).abs() < 1e-6, "{a} {b} {p}: {near} {plane}");
        }
    }
    for (across, along) in [(1.0, 0.4), (0.5, 2.0), (1.0, 20.0)] {
        let r = 1.5f64;
        // At height z the plane normal is inside with 1 - exp(-(r² - z²)/(2 s²)); z = r sin u.
        let n = 20_000;
        let inside: f64 = (0..n)
            .map(|k| {
                let (s, c) = libm::sincos(((k as f64 + 0.5) / n as f64 - 0.5) * PI);
                let density = (-0.5 * (r * s / along).powi(2)).exp() / (along * (2.0 * PI).sqrt());
                let plane = 1.0 - (-0.5 * (r * c / across).powi(2)).exp();
                density * plane * r * c * PI / n as f64
            })
            .sum();
        let turned = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1);
        let p = turned.matrix() * diagonal(across, across, along) * turned.matrix().transpose();
        let found = spherical(&p, inside);
        assert!((found / r - 1.0).abs() < 1e-6, "{across} {along}: {found}");
    }
}

/// A radius is of first degree in the sizes: its derivatives by them sum to it. And each is the slope of the radius.
#[test]
fn derivatives_sum_to_the_radius() {
    let parts = [
        Matrix2::new(4.0, 1.0, 1.0, 1.0),
        Matrix2::new(0.5, -0.5, -0.5, 0.5),
        Matrix2::new(1.0, 0.0, 0.0, 9.0),
    ];
    let whole: Matrix2<f64> = parts.iter().sum();
    let r = radius(&whole, 0.95);
    let slopes = parts.map(|part| derivative(&whole, &part, r));
    assert!((slopes.iter().sum::<f64>() / r - 1.0).abs() < 1e-12);
    for (part, slope) in parts.iter().zip(slopes) {
        let at = |a: f64| radius(&(whole - part + part * (a * a)), 0.95);
        let difference = (at(1.001) - at(0.999)) / 0.002;
        assert!((slope / difference - 1.0).abs() < 1e-5, "{slope} {difference}");
        let factor = may_grow(&whole, part, 0.95, 1.5 * r);
        assert!((at(factor) / (1.5 * r) - 1.0).abs() < 1e-9, "{factor}");
    }
}
