//! Error-free navigation returns to the truth.

use schuler_frames::{B, Gravity, Vec3};
use schuler_strapdown::{
    Coning, EarthFixed, Increments, Inertial, LocalLevel, Mechanization, Pva, Samples, Vertical,
    WanderAzimuth,
};

use super::kinds::{PLACE, flight, vibration};
use crate::trajectory::{
    Course, GreatCircle, Segment, Segments, Shaken, Sharpness, Truth, Turn, increments_of_rates,
};

fn navigators(start: &Pva) -> [Box<dyn Mechanization>; 4] {
    let (gravity, vertical) = (Gravity::Normal, Vertical::Free);
    [
        Box::new(LocalLevel::new(start, gravity, vertical)),
        Box::new(WanderAzimuth::new(start, gravity, vertical)),
        Box::new(<EarthFixed>::new(start, gravity, vertical)),
        Box::new(<Inertial>::new(start, gravity, vertical)),
    ]
}

/// Horizontal and vertical distance of each from the truth after `steps` of `dt`; `sample` gives the increments of step k,
/// from -1 on.
fn away(
    truth: &Truth,
    coning: Coning,
    dt: f64,
    steps: i64,
    sample: impl Fn(i64) -> Increments,
) -> [[f64; 2]; 4] {
    let mut all = navigators(&truth.moment(0.0).pva);
    let mut samples = Samples::new(coning);
    samples.add(&sample(-1));
    for k in 0..steps {
        let motion = samples.add(&sample(k)).expect("a sample an update");
        for nav in &mut all {
            nav.advance(&motion, dt);
        }
    }
    let end = truth.moment(steps as f64 * dt).pva;
    all.map(|nav| {
        let pva = nav.pva();
        let apart = pva.position.local_ned(end.position.as_ecef());
        [apart[0].hypot(apart[1]), (pva.position.h - end.position.h).abs()]
    })
}

fn shaken_flight() -> Truth {
    let carrier = flight(Gravity::Normal);
    Truth::new(Shaken::new(Box::new(carrier), vibration()), Gravity::Normal)
}

/// 600 s of turns and climbs with 16 mg and 0.3 mrad of vibration at 2 Hz along and about every axis, vertical free: 2 mm
/// from increments at 100 Hz. What is left is of fourth order and grows with the square of the vibration, as the coning does.
#[test]
fn flight_from_increments() {
    let truth = shaken_flight();
    let dt = 0.01;
    let away = away(&truth, Coning::Previous, dt, 60_000, |k| truth.increments(k as f64 * dt, dt));
    assert!(away.iter().all(|[horizontal, vertical]| *horizontal < 0.002 && *vertical < 0.002), "{away:?}");
}

/// The same from instantaneous rates: 0.3 m, by a cubic through the samples.
#[test]
fn flight_from_rates() {
    let truth = shaken_flight();
    let dt = 0.01;
    let rates = |k: i64| {
        let moment = truth.moment(k as f64 * dt);
        [moment.omega_ib_b.as_vec3(), moment.f_b]
    };
    let samples: Vec<[Vec3<B>; 2]> = (-2..60_002).map(rates).collect();
    let increments = increments_of_rates(&samples, dt);
    let away = away(&truth, Coning::Previous, dt, 60_000, |k| increments[(k + 2) as usize]);
    assert!(away.iter().all(|[horizontal, vertical]| *horizontal < 0.3 && *vertical < 0.3), "{away:?}");
}

/// An hour of a car's figure of eight at 200 Hz: 1 cm horizontally.
#[test]
fn car_on_a_figure_of_eight() {
    let turn = Turn { sharpness: Sharpness::Radius(25.0), ramp: 2.0, flat: true };
    let start = Course { position: PLACE, speed: 10.0, heading: 0.3, climb: 0.0, roll: 0.0 };
    let eights = Segments::new(start, &[Segment::FigureOfEight { count: 110, turn }], Gravity::Normal);
    let truth = Truth::new(eights.expect("a drive"), Gravity::Normal);
    assert!(truth.trajectory().duration().expect("an end") > 3600.0);
    let dt = 0.005;
    let away = away(&truth, Coning::Previous, dt, 720_000, |k| truth.increments(k as f64 * dt, dt));
    assert!(away.iter().all(|[horizontal, _]| *horizontal < 0.01), "{away:?}");
}

/// Two hours on a great circle over the north pole, held: the navigators without a north stay within a millimetre.
#[test]
fn over_the_pole() {
    let start = schuler_frames::Geodetic::new(1.45, 0.3, 9000.0);
    let circle = GreatCircle::new(start, 0.0, 250.0, 0.05, 0.02).expect("a flight");
    let truth = Truth::new(circle, Gravity::Normal);
    let first = truth.moment(0.0).pva;
    let mut all: [Box<dyn Mechanization>; 3] = [
        Box::new(WanderAzimuth::new(&first, Gravity::Normal, Vertical::Held)),
        Box::new(<EarthFixed>::new(&first, Gravity::Normal, Vertical::Held)),
        Box::new(<Inertial>::new(&first, Gravity::Normal, Vertical::Held)),
    ];
    let (dt, steps) = (0.04, 180_000);
    for k in 0..steps {
        let increments = truth.increments(f64::from(k) * dt, dt);
        for nav in &mut all {
            nav.step(&increments, dt);
        }
    }
    let end = truth.moment(f64::from(steps) * dt).pva;
    // On the other side of the pole.
    assert!((end.position.lon - 0.3).abs() > 3.0 && end.position.lat < 1.5, "{end:?}");
    for nav in all {
        let apart = nav.pva().position.local_ned(end.position.as_ecef());
        assert!(apart.norm() < 1e-3, "{apart:?}");
    }
}

/// Errors fall with the stated order as the rate doubles: the second from one sample, and from the sample before it too
/// the fourth, until the second order of the navigator shows.
#[test]
fn errors_fall_with_the_stated_order() {
    let truth = Truth::new(flight(Gravity::Normal), Gravity::Normal);
    for (coning, orders) in [(Coning::One, 1.8..2.2), (Coning::Previous, 2.0..4.2)] {
        let error = |rate: f64| {
            let dt = 1.0 / rate;
            let sample = |k: i64| truth.increments(k as f64 * dt, dt);
            away(&truth, coning, dt, (600.0 * rate) as i64, sample).map(|[level, up]| level.hypot(up))
        };
        let [slow, middle, fast] = [12.5, 25.0, 50.0].map(error);
        for nav in 0..4 {
            for (coarse, fine) in [(slow[nav], middle[nav]), (middle[nav], fast[nav])] {
                let order = (coarse / fine).log2();
                assert!(
                    orders.contains(&order),
                    "{coning:?}, {nav}: {order} of {slow:?} {middle:?} {fast:?}"
                );
            }
        }
    }
}
