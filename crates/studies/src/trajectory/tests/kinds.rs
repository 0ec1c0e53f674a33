//! One of each kind of motion.

use std::f64::consts::TAU;

use schuler_frames::{Euler, Geodetic, Gravity};

use crate::{
    scenario,
    trajectory::{
        Coning, Pose, Positions, RateTable, Sculling, Sine, Still, Sway, SwayAxes, Trajectory, Truth,
    },
};

pub const PLACE: Geodetic = Geodetic::new(0.8, 0.2, 300.0);
pub const ATTITUDE: Euler = Euler::new(0.03, -0.05, 1.0);

/// A kind of motion and what is known of it.
pub struct Kind {
    pub name: &'static str,
    pub truth: Truth,
    /// A span to be looked at, s.
    pub span: f64,
    /// Whether attitude and its rate are continuous.
    pub smooth: bool,
}

pub fn sine(amplitude: f64, period: f64, phase: f64) -> Sine {
    Sine { amplitude, omega: TAU / period, phase }
}

pub fn mooring() -> Sway {
    let axes = SwayAxes {
        roll: vec![sine(0.08, 8.0, 0.0), sine(0.005, 0.5, 1.0)],
        pitch: vec![sine(0.05, 6.0, 0.4)],
        yaw: vec![sine(0.03, 11.0, 2.0)],
        n: vec![sine(0.3, 7.0, 0.1)],
        e: vec![sine(0.2, 9.0, 0.0), sine(0.001, 0.4, 0.0)],
        d: vec![sine(0.5, 5.0, 3.0)],
    };
    Sway::new(PLACE, ATTITUDE, axes)
}

pub fn two_positions() -> Positions {
    let at = |yaw: f64| Pose { attitude: Euler::new(0.0, 0.02, yaw), dwell: 20.0 };
    Positions::new(PLACE, &[at(0.3), at(0.3 + 0.5 * TAU), at(1.0)], 0.2)
}

pub fn rate_table(acceleration: f64) -> RateTable {
    let table = scenario::RateTable { rate: 0.5, tilt: 0.4, acceleration, vibration: [0.1, 0.2, 0.3] };
    RateTable::new(PLACE, &table, 6100, 0.01)
}

impl Kind {
    pub fn motion(&self) -> &dyn Trajectory {
        self.truth.trajectory()
    }
}

pub fn kinds(gravity: Gravity) -> Vec<Kind> {
    let of = |name, motion, span, smooth| Kind { name, truth: Truth::boxed(motion, gravity), span, smooth };
    let kind = |name, motion: Box<dyn Trajectory>, span| of(name, motion, span, true);
    let jumps = |name, motion: Box<dyn Trajectory>, span| of(name, motion, span, false);
    vec![
        kind("static", Box::new(Still::new(PLACE, ATTITUDE)), 10.0),
        kind("sway", Box::new(mooring()), 30.0),
        kind("coning", Box::new(Coning::new(PLACE, ATTITUDE, 0.02, 10.0)), 1.0),
        kind("sculling", Box::new(Sculling::new(PLACE, ATTITUDE, 0.02, 5.0, 10.0)), 1.0),
        kind("positions", Box::new(two_positions()), 110.0),
        jumps("rate table", Box::new(rate_table(0.5)), 61.0),
        jumps("rate table at once", Box::new(rate_table(f64::INFINITY)), 61.0),
    ]
}
