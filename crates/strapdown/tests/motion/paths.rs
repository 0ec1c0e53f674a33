//! Flights and drives in closed form.

use std::f64::consts::TAU;

use schuler_frames::wgs84;

use crate::truth::{Against, Jet, Trajectory, normal};

/// An hour of climbs, turns and rolls at airliner speed.
pub struct Manoeuvres;

impl Trajectory for Manoeuvres {
    fn place(&self, t: Jet) -> ([Jet; 3], Jet) {
        let way = 1.0 / wgs84::A;
        let lat =
            t * (90.0 * way) + (t * 0.02).sin() * (6000.0 * way) + (t * 0.11).sin() * (400.0 * way) + 0.7;
        let lon =
            t * (150.0 * way) - (t * 0.02).cos() * (8000.0 * way) + (t * 0.07).cos() * (900.0 * way) + 0.2;
        let h = (t * 0.004).sin() * 1500.0 + (t * 0.05).cos() * 120.0 + 6000.0;
        (normal(lat, lon), h)
    }

    fn stand(&self, t: Jet) -> [Jet; 3] {
        let roll = (t * 0.05).sin() * 0.6 + (t * 0.31).sin() * 0.1;
        let pitch = (t * 0.013).sin() * 0.2 + (t * 0.4).cos() * 0.05;
        let yaw = t * 0.02 + (t * 0.07).sin() * 0.8 + 1.0;
        [roll, pitch, yaw]
    }
}

/// Turns and climbs with a vibration of 2 Hz in position and attitude.
pub struct Vibrating;

impl Trajectory for Vibrating {
    fn place(&self, t: Jet) -> ([Jet; 3], Jet) {
        let way = 1.0 / wgs84::A;
        let w = TAU * 2.0;
        let shake = |phase: f64| (t * w + phase).sin() * 0.001;
        let lat = t * (60.0 * way) + (t * 0.05).sin() * (1500.0 * way) + shake(0.3) * way + 0.8;
        let lon = t * (80.0 * way) + (t * 0.04).cos() * (1800.0 * way) + shake(1.9) * way + 0.1;
        let h = (t * 0.02).sin() * 300.0 + shake(4.0) + 2000.0;
        (normal(lat, lon), h)
    }

    fn stand(&self, t: Jet) -> [Jet; 3] {
        let w = TAU * 2.0;
        let roll = (t * 0.06).sin() * 0.5 + (t * w).sin() * 0.0005;
        let pitch = (t * 0.03).sin() * 0.15 + (t * w + 1.0).sin() * 0.0005;
        let yaw = t * 0.05 + (t * 0.11).sin() * 0.4 + (t * w + 2.0).sin() * 0.0005;
        [roll, pitch, yaw]
    }
}

/// Once around the Earth in `period` (s) at a constant height, on the great circle of normals
/// that rises to the latitude `highest`.
pub struct GreatCircle {
    pub highest: f64,
    pub period: f64,
}

impl Trajectory for GreatCircle {
    fn place(&self, t: Jet) -> ([Jet; 3], Jet) {
        let (s, c) = (t * (TAU / self.period) + 0.4).sin_cos();
        let (sin_top, cos_top) = self.highest.sin_cos();
        ([c, s * cos_top, s * sin_top], Jet::constant(9000.0))
    }

    fn stand(&self, t: Jet) -> [Jet; 3] {
        [Jet::constant(0.1), (t * 0.001).sin() * 0.2, t * 1e-4 + 0.5]
    }

    fn against(&self) -> Against {
        Against::Earth
    }
}

/// A car on a figure of eight, nose along the track, rolling and pitching in step with it: that is coning.
pub struct Eight;

impl Trajectory for Eight {
    fn place(&self, t: Jet) -> ([Jet; 3], Jet) {
        let way = 1.0 / wgs84::A;
        let lat = (t * 0.2).sin() * (80.0 * way) + 0.9;
        let lon = (t * 0.1).sin() * (160.0 * way) + 0.3;
        (normal(lat, lon), Jet::constant(120.0))
    }

    fn stand(&self, t: Jet) -> [Jet; 3] {
        let (n, e) = ((t * 0.2).sin(), (t * 0.1).sin() * 2.0);
        let speed2 = n.1 * n.1 + e.1 * e.1;
        let yaw = Jet(e.1.atan2(n.1), (n.1 * e.2 - e.1 * n.2) / speed2, f64::NAN);
        [(t * 0.1).cos() * 0.05, (t * 0.4).sin() * 0.02, yaw]
    }
}

/// Half an hour to the north pole and half an hour beyond, climbing, sinking and swinging.
pub struct OverThePole;

impl Trajectory for OverThePole {
    fn place(&self, t: Jet) -> ([Jet; 3], Jet) {
        let along = (t + -1800.0) * (240.0 / wgs84::A);
        let aside = (t * 0.01).sin() * 1e-4;
        let ((s, c), (sin_aside, cos_aside)) = (along.sin_cos(), aside.sin_cos());
        ([s * cos_aside, sin_aside, c * cos_aside], (t * 0.005).sin() * 1000.0 + 7000.0)
    }

    fn stand(&self, t: Jet) -> [Jet; 3] {
        [(t * 0.05).sin() * 0.5, (t * 0.03).cos() * 0.2, t * 0.01]
    }

    fn against(&self) -> Against {
        Against::Earth
    }
}
