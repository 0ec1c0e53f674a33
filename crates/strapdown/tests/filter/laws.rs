//! Laws of the heading that an optimal filter finds at rest with its velocity known to be zero, one noise at a time.

use schuler_frames::wgs84;
use schuler_strapdown::filter::{Filter, Now, Propagation, ZeroVelocity, measurement};

use crate::common::*;

const LAT: f64 = 45.0 * DEG;

/// What a run of measurements every second starts from.
struct Start {
    /// White noise of gyro and accelerometer.
    density: [f64; 2],
    /// Noise of the velocity measured, m/s.
    measured: f64,
    /// Velocity at the start, m/s.
    velocity: f64,
    /// Whether velocity turns the level (terms dv/R): the laws are made without.
    transport: bool,
}

impl Start {
    /// Heading sigma (rad) after `t` (s).
    fn heading(&self, t: usize) -> f64 {
        let pva = at_rest(LAT, 0.0);
        let model = ten_states(&sensors(self.density[0], self.density[1], 0.0, 0.0));
        let mut system = model.form().system(&HELD, &pva, felt(&pva).1);
        if !self.transport {
            system.f.fixed_view_mut::<3, 3>(6, 3).fill(0.0);
        }
        let step = Propagation::exact(&model, &system, &seen(&pva), 1.0);
        let wide = [0.0, 0.0, 0.0, self.velocity, self.velocity, 0.0, 0.2, 0.2, 3.0];
        let mut filter = Filter::new(model, &wide).unwrap();
        for _ in 0..t {
            filter.propagate(&step);
            let still = ZeroVelocity { sigma: self.measured, axes: measurement::HORIZONTAL };
            filter.update(&still, &Now::at(&pva)).unwrap();
        }
        filter.sigma(4)
    }
}

fn g() -> f64 {
    GRAVITY.gravity_t(at_rest(LAT, 0.0).position)[2]
}

#[test]
fn angle_random_walk_by_the_coth_law() {
    // sd² = N² / (Ω cos L) coth(Ω cos L t)
    let n = 0.003 * DEGPRTH;
    let rate = wgs84::OMEGA * LAT.cos();
    let start = Start { density: [n, 0.0], measured: 1e-9, velocity: 1e-9, transport: true };
    for (t, tolerance) in [(30, 0.01), (120, 0.003), (600, 0.001), (3600, 0.001), (20_000, 0.001)] {
        let law = n / (rate * (rate * t as f64).tanh()).sqrt();
        let ratio = start.heading(t) / law;
        assert!((ratio - 1.0).abs() < tolerance, "{t} s: {ratio}");
    }
}

#[test]
fn velocity_random_walk_falls_with_the_power_one_and_a_half() {
    // sd = sqrt(12) q / (g Ω cos L t^1.5)
    let q = 10.0 * UG;
    let start = Start { density: [0.0, q], measured: 1e-9, velocity: 1e-9, transport: true };
    for t in [30, 120, 600, 1200] {
        let law = 12f64.sqrt() * q / (g() * wgs84::OMEGA * LAT.cos() * (t as f64).powf(1.5));
        let ratio = start.heading(t) / law;
        assert!((ratio - 1.0).abs() < 0.001, "{t} s: {ratio}");
    }
}

#[test]
fn velocity_noise_falls_with_the_power_two_and_a_half() {
    // sd = sqrt(720 r / t^5) / (g Ω cos L), r = sigma² dt. Within 1 % to 300 s; from there on the terms dv/R, which the law
    // leaves out, help: by 1.3 % at 600 s. Without them the law holds on.
    let start = Start { density: [0.0; 2], measured: 0.01, velocity: 10.0, transport: true };
    let without = Start { transport: false, ..start };
    for (start, t, tolerance) in [
        (&start, 60, 0.01),
        (&start, 120, 0.01),
        (&start, 300, 0.01),
        (&without, 120, 0.001),
        (&without, 600, 0.001),
        (&without, 1200, 0.001),
    ] {
        let law = (720.0 * 1e-4 / (t as f64).powi(5)).sqrt() / (g() * wgs84::OMEGA * LAT.cos());
        let ratio = start.heading(t) / law;
        assert!((ratio - 1.0).abs() < tolerance, "{t} s: {ratio}");
    }
}
