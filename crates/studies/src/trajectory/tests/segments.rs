//! Numbers of drives and flights that follow from their segments, and what cannot be driven.

use std::f64::consts::{FRAC_PI_2, PI};

use schuler_frames::{Gravity, Vec3, wgs84};

use super::kinds::{PLACE, flight};
use crate::trajectory::{
    ConstantVelocity, Course, GreatCircle, Segment, Segments, Sharpness, Trajectory, Truth, Turn,
};

fn start(speed: f64) -> Course {
    Course { position: PLACE, speed, heading: 0.3, climb: 0.0, roll: 0.0 }
}

fn drive(speed: f64, segments: &[Segment]) -> Segments {
    Segments::new(start(speed), segments, Gravity::Normal).expect("a drive")
}

fn level(sharpness: Sharpness) -> Turn {
    Turn { sharpness, ramp: 2.0, flat: false }
}

/// The start is that of the scenario, and what a segment asks for stands at its end.
#[test]
fn segments_do_what_they_say() {
    let flight = flight(Gravity::Normal);
    let first = flight.at(0.0);
    assert_eq!((first.position, first.v_t.norm()), (PLACE, 0.0));
    let last = flight.at(flight.duration().expect("an end"));
    // 800 m up, 300 m down.
    assert!((last.position.h - (PLACE.h + 500.0)).abs() < 1e-8, "{}", last.position.h);
    assert!((last.v_t.norm() - 60.0).abs() < 1e-13);
    // All turns: 1.5, 0.8 - 1.6 + 0.8, -4, 0, 0.05.
    let euler = last.c_tb.as_euler();
    assert!((euler.yaw - (0.7 + 1.5 - 4.0 + 0.05)).abs() < 1e-13 && euler.roll.abs() < 1e-15, "{euler:?}");
}

/// A steady coordinated turn: radius v² / (g tan bank), and nothing to feel sideways but the Earth's rotation.
#[test]
fn coordinated_turn() {
    let (speed, bank) = (60.0, 0.5);
    let flight = drive(speed, &[Segment::Turn { angle: PI, turn: level(Sharpness::Bank(bank)) }]);
    let t = 0.5 * flight.duration().expect("an end");
    let now = flight.at(t);
    assert!((now.c_tb.as_euler().roll - bank).abs() < 1e-14);
    let g = Gravity::Normal.gravity_t(PLACE).norm();
    let radius = speed * speed / (g * bank.tan());
    let rate = now.a_t.cross(now.v_t).norm() / speed.powi(2);
    // The circle is that of the acceleration along the ground.
    let sideways = (now.a_t - Vec3::new(0.0, 0.0, now.a_t[2])).norm();
    assert!((sideways - speed * speed / radius).abs() < 2e-3, "{sideways} {rate}");
    let felt = Truth::new(flight, Gravity::Normal).moment(t).f_b;
    assert!(
        felt[1].abs() < 2.0 * wgs84::OMEGA * speed && (felt[2] + g / bank.cos()).abs() < 0.02,
        "{felt:?}"
    );
}

/// A circle closes: after a turn of 360 deg of its steady part the vehicle is where it was.
#[test]
fn a_circle_has_its_radius() {
    let radius = 500.0;
    let drive = drive(20.0, &[Segment::Turn { angle: 6.0 * PI, turn: level(Sharpness::Radius(radius)) }]);
    let circle = 2.0 * PI * radius / 20.0;
    let [a, b, c] = [5.0, 5.0 + 0.5 * circle, 5.0 + circle].map(|t| drive.at(t).position.as_ecef());
    // Half way around it is a diameter away. Heading is against north, which itself turns by v tan L / R, 8e-5 of the rate.
    assert!(((a - b).norm() - 2.0 * radius).abs() < 1e-4 * 2.0 * radius, "{}", (a - b).norm());
    assert!((a - c).norm() < 1e-4 * 2.0 * PI * radius, "{}", (a - c).norm());
}

/// Along a parallel the longitude grows by its radius; across, by the isometric latitude.
#[test]
fn rhumb_lines() {
    let v = 200.0;
    let east =
        ConstantVelocity::new(PLACE, Default::default(), Vec3::new(0.0, v, 0.0), 7200.0).expect("a flight");
    let end = east.at(7200.0).position;
    let parallel = (wgs84::r_n(PLACE.lat.sin()) + PLACE.h) * PLACE.lat.cos();
    assert!((end.lon - (PLACE.lon + v * 7200.0 / parallel)).abs() < 2e-15 && end.lat == PLACE.lat);

    // Loxodrome on the ellipsoid: longitude by the isometric latitude.
    let ground = schuler_frames::Geodetic::new(0.2, 0.1, 0.0);
    let oblique = ConstantVelocity::new(ground, Default::default(), Vec3::new(100.0, 150.0, 0.0), 20_000.0);
    let end = oblique.expect("a flight").at(20_000.0).position;
    let e = wgs84::E2.sqrt();
    let isometric = |lat: f64| lat.sin().atanh() - e * (e * lat.sin()).atanh();
    let by_formula = 1.5 * (isometric(end.lat) - isometric(0.2));
    assert!((end.lon - 0.1 - by_formula).abs() < 1e-14, "{:e}", end.lon - 0.1 - by_formula);
}

/// From the equator to the pole along a meridian, and a quarter of the equator: the ways are those of the ellipse.
#[test]
fn great_circles() {
    let origin = schuler_frames::Geodetic::default();
    let pole = schuler_frames::Geodetic::new(FRAC_PI_2, 0.0, 0.0);
    let north = GreatCircle::to(origin, pole, 100.0, 0.0, 0.0).expect("a flight");
    // Its speed is v R_M(L) / R_M(0), so the way is the integral of R_M: the meridian quadrant of WGS 84.
    let duration = north.duration().expect("an end");
    let parts = 1000;
    let h = duration / f64::from(parts);
    let speed = |t: f64| north.at(t).v_t.norm();
    let mut way = 0.0;
    for k in 0..parts {
        let t = f64::from(k) * h;
        way += (speed(t) + 4.0 * speed(t + 0.5 * h) + speed(t + h)) * h / 6.0;
    }
    assert!((way - 10_001_965.729).abs() < 1e-3, "{way}");
    // Over the pole the longitude jumps and nothing else.
    let [before, after] = [duration - 1e-3, duration + 1e-3].map(|t| north.at(t));
    assert!((before.position.as_ecef() - after.position.as_ecef()).norm() < 0.21);
    assert_eq!(before.omega_eb_b, after.omega_eb_b);

    let east = GreatCircle::to(origin, schuler_frames::Geodetic::new(0.0, FRAC_PI_2, 0.0), 100.0, 0.0, 0.0);
    let east = east.expect("a flight");
    assert!((east.duration().expect("an end") - FRAC_PI_2 * wgs84::A / 100.0).abs() < 1e-9);
}

/// What cannot be driven is refused, with the segment.
#[test]
fn impossible_segments() {
    let turn = level(Sharpness::Radius(100.0));
    let go = Segment::Straight { duration: 1.0 };
    let cases: &[(f64, Segment, &str)] = &[
        (0.0, Segment::Turn { angle: 1.0, turn }, "speed"),
        (0.0, Segment::Distance { distance: 5.0 }, "speed"),
        (0.0, Segment::Climb { height: 5.0, angle: 0.1, ramp: 1.0 }, "speed"),
        (5.0, Segment::Stand { duration: 5.0 }, "stands"),
        (5.0, Segment::Straight { duration: -5.0 }, "takes"),
        (5.0, Segment::Accelerate { to: 13e3, duration: 5.0 }, "speed"),
        (5.0, Segment::Accelerate { to: -1.0, duration: 5.0 }, "speed"),
        (5.0, Segment::Turn { angle: 1.0, turn: level(Sharpness::Bank(1.6)) }, "bank"),
        (5.0, Segment::Turn { angle: 1.0, turn: level(Sharpness::Radius(0.0)) }, "radius"),
        (5.0, Segment::Climb { height: 50.0, angle: 1.57, ramp: 1.0 }, "climb angle"),
        (5.0, Segment::Climb { height: 0.1, angle: 0.5, ramp: 5.0 }, "pulls"),
    ];
    for (speed, segment, word) in cases {
        let fault = Segments::new(start(*speed), &[go, *segment], Gravity::Normal).expect_err("impossible");
        assert!(fault.part == Some(1) && fault.problem.contains(word), "{segment:?}: {fault}");
    }
    let far = Segment::Straight { duration: 1e6 };
    let fault = Segments::new(start(1e3), &[far], Gravity::Normal).expect_err("comes to a pole");
    assert!(fault.problem.contains("pole"), "{fault}");
}
