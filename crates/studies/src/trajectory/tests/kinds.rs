//! One of each kind of motion.

use std::f64::consts::TAU;

use schuler_frames::{Euler, Geodetic, Gravity, Vec3};

use crate::trajectory::{
    Coning, ConstantVelocity, Course, GreatCircle, Passage, Pose, Positions, RateTable, Recorded, Row,
    Sculling, Segment, Segments, Shaken, Sharpness, Sine, Still, Sway, SwayAxes, TableTurns, Trajectory,
    Truth, Turn, Waypoint, Waypoints,
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
    let table = TableTurns { rate: 0.5, tilt: 0.4, acceleration, vibration: [0.1, 0.2, 0.3] };
    RateTable::new(PLACE, &table, 6100, 0.01)
}

impl Kind {
    pub fn motion(&self) -> &dyn Trajectory {
        self.truth.trajectory()
    }
}

/// Everything a vehicle does, and a little more than ten minutes of it.
pub fn flight(gravity: Gravity) -> Segments {
    let start = Course { position: PLACE, speed: 0.0, heading: 0.7, climb: 0.0, roll: 0.0 };
    let turn =
        |degrees: f64| Turn { sharpness: Sharpness::Rate(degrees.to_radians()), ramp: 3.0, flat: false };
    let bank = Turn { sharpness: Sharpness::Bank(0.5), ramp: 3.0, flat: false };
    let flat = Turn { sharpness: Sharpness::Radius(800.0), ramp: 2.0, flat: true };
    let segments = [
        Segment::Stand { duration: 20.0 },
        Segment::Accelerate { to: 80.0, duration: 30.0 },
        Segment::Straight { duration: 20.0 },
        Segment::Climb { height: 800.0, angle: 0.15, ramp: 4.0 },
        Segment::Turn { angle: 1.5, turn: turn(3.0) },
        Segment::Roll { to: 0.4, duration: 3.0 },
        Segment::Roll { to: 0.0, duration: 3.0 },
        Segment::STurn { angle: 0.8, turn: bank },
        Segment::Distance { distance: 3000.0 },
        Segment::Climb { height: -300.0, angle: 0.1, ramp: 4.0 },
        Segment::Turn { angle: -4.0, turn: flat },
        Segment::FigureOfEight { count: 1, turn: turn(4.0) },
        Segment::Accelerate { to: 60.0, duration: 20.0 },
        Segment::Turn { angle: 0.05, turn: turn(3.0) },
        Segment::Straight { duration: 30.0 },
    ];
    Segments::new(start, &segments, gravity).expect("a flight")
}

/// Through five points, one of them by its time.
pub fn route(flat: bool) -> Waypoints {
    let point =
        |lat: f64, lon: f64, h: f64, passage| Waypoint { position: Geodetic::new(lat, lon, h), passage };
    let points = [
        point(0.8003, 0.2002, 350.0, Passage::Speed(60.0)),
        point(0.8004, 0.2008, 400.0, Passage::Speed(70.0)),
        point(0.8001, 0.2012, 420.0, Passage::Time(190.0)),
        point(0.7996, 0.2013, 400.0, Passage::Speed(65.0)),
        point(0.7994, 0.2006, 380.0, Passage::Speed(65.0)),
    ];
    Waypoints::new(PLACE, &points, flat, Gravity::Normal).expect("a route")
}

/// The route as somebody records it, at 20 Hz.
pub fn rows() -> Vec<Row> {
    let route = route(false);
    let row = |k: u32| {
        let t = f64::from(k) * 0.05;
        let now = route.at(t);
        Row { t: t + 1000.0, position: now.position, attitude: now.c_tb.as_euler() }
    };
    (0..4000).map(row).collect()
}

/// 2 Hz in every axis.
pub fn vibration() -> SwayAxes {
    let of = |amplitude: f64, phase: f64| vec![sine(amplitude, 0.5, phase)];
    SwayAxes {
        roll: of(3e-4, 0.0),
        pitch: of(3e-4, 1.0),
        yaw: of(3e-4, 2.0),
        n: of(1e-3, 0.3),
        e: of(1e-3, 1.9),
        d: of(1e-3, 4.0),
    }
}

pub fn kinds(gravity: Gravity) -> Vec<Kind> {
    let of = |name, motion, span, smooth| Kind { name, truth: Truth::boxed(motion, gravity), span, smooth };
    let kind = |name, motion: Box<dyn Trajectory>, span| of(name, motion, span, true);
    let jumps = |name, motion: Box<dyn Trajectory>, span| of(name, motion, span, false);
    let rhumb =
        ConstantVelocity::new(PLACE, ATTITUDE, Vec3::new(150.0, 180.0, -3.0), 100.0).expect("a flight");
    let circle = GreatCircle::new(PLACE, 0.4, 250.0, 0.05, 0.03).expect("a flight");
    vec![
        kind("segments", Box::new(flight(gravity)), 600.0),
        kind("shaken", Box::new(Shaken::new(Box::new(flight(gravity)), vibration())), 600.0),
        kind("waypoints", Box::new(route(false)), 300.0),
        kind("recorded", Box::new(Recorded::new(&rows(), 2.0).expect("a trajectory")), 199.0),
        kind("constant velocity", Box::new(rhumb), 100.0),
        kind("great circle", Box::new(circle), 3000.0),
        kind("static", Box::new(Still::new(PLACE, ATTITUDE)), 10.0),
        kind("sway", Box::new(mooring()), 30.0),
        kind("coning", Box::new(Coning::new(PLACE, ATTITUDE, 0.02, 10.0)), 1.0),
        kind("sculling", Box::new(Sculling::new(PLACE, ATTITUDE, 0.02, 5.0, 10.0)), 1.0),
        kind("positions", Box::new(two_positions()), 110.0),
        jumps("rate table", Box::new(rate_table(0.5)), 61.0),
        jumps("rate table at once", Box::new(rate_table(f64::INFINITY)), 61.0),
    ]
}
