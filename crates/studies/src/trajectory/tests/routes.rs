//! Splines, waypoints and recorded trajectories.

use schuler_frames::{Geodetic, Gravity};
use schuler_imu::{Stream, random::Draws};

use super::kinds::{PLACE, route, rows};
use crate::trajectory::{
    Jet, Passage, Recorded, Trajectory, Waypoint, Waypoints,
    spline::{Fit, Interpolation},
};

const TIMES: [f64; 6] = [0.0, 1.0, 1.5, 4.0, 4.2, 9.0];

/// The natural quintic spline passes its points, has four continuous derivatives, third and fourth zero at its ends, and
/// is the parabola where points lie on one.
#[test]
fn interpolation() {
    let values = TIMES.map(|t| [t.sin(), (2.0 * t).cos(), 3.0 - 2.0 * t + 0.5 * t * t]);
    let spline = Interpolation::new(&TIMES, &values);
    for (t, value) in TIMES.iter().zip(values) {
        for axis in 0..3 {
            assert!((spline.at(*t)[axis].value() - value[axis]).abs() < 1e-12, "{t} {axis}");
        }
    }
    for t in &TIMES[1..5] {
        let [before, after] = [-1e-9, 1e-9].map(|d| spline.at(t + d));
        for axis in 0..3 {
            for k in 0..5 {
                let (a, b) = (before[axis].0[k], after[axis].0[k]);
                assert!((a - b).abs() < 1e-6 * (1.0 + a.abs()), "{t} {axis} {k}: {a} {b}");
            }
        }
    }
    for t in [0.0, 9.0] {
        for jet in spline.at(t) {
            assert!(jet.0[3].abs() < 1e-10 && jet.0[4].abs() < 1e-10, "{t}: {jet:?}");
        }
    }
    let parabola = spline.at(2.7)[2];
    assert!((parabola.value() - (3.0 - 5.4 + 0.5 * 2.7 * 2.7)).abs() < 1e-12);
    assert!((parabola.acceleration() - 1.0).abs() < 1e-11 && parabola.0[3].abs() < 1e-11);

    let line = Interpolation::new(&[1.0, 3.0], &[[0.0, 1.0, 2.0], [2.0, 1.0, 0.0]]);
    assert_eq!(line.at(2.0).map(|jet| jet.rate()), [1.0, 0.0, -1.0]);
}

/// Polynomials of fifth degree are splines: the fit is the polynomial, with all its derivatives, at the ends too.
#[test]
fn fit_of_a_polynomial() {
    let polynomial = |t: Jet<5>| t * t * t * t * t * 0.01 - t * t * t * 0.2 + t * 1.5 - t * t * 0.3 + 2.0;
    let times: Vec<f64> = (0..=100).map(|k| 0.05 * f64::from(k)).collect();
    let values: Vec<[f64; 1]> = times.iter().map(|t| [polynomial(Jet::time(*t)).value()]).collect();
    let fit = Fit::new(&times, &values, 0.6).expect("a fit");
    for t in [0.0, 0.3, 2.2, 4.99, 5.0] {
        let ([found], expected) = (fit.at(t), polynomial(Jet::time(t)));
        for k in 0..5 {
            let tolerance = 1e-10 * 30f64.powi(k as i32);
            assert!((found.0[k] - expected.0[k]).abs() < tolerance, "{t} {k}: {found:?} {expected:?}");
        }
    }
    assert!(Fit::new(&times[..4], &values[..4], 0.01).is_none());
}

/// Points are passed when they should be, nose along the track, and in turns nothing is felt sideways but the Earth's rotation.
#[test]
fn waypoints_are_passed() {
    let banked = route(false);
    let start = banked.at(0.0);
    assert!((start.position.as_ecef() - PLACE.as_ecef()).norm() < 1e-8);
    let point = Geodetic::new(0.8001, 0.2012, 420.0);
    assert!((banked.at(190.0).position.as_ecef() - point.as_ecef()).norm() < 1e-7);
    let truth = crate::trajectory::Truth::new(banked, Gravity::Normal);
    for k in 0..300 {
        let now = truth.moment(f64::from(k));
        let along = now.pva.c_tb.inverse() * now.pva.v_t;
        assert!(along[1].abs() < 1e-12 * along[0] && along[2].abs() < 1e-12 * along[0], "{along:?}");
        assert!(now.f_b[1].abs() < 0.03, "{k}: {:?}", now.f_b);
    }
    for k in 0..30 {
        assert!(route(true).at(10.0 * f64::from(k)).c_tb.as_euler().roll.abs() < 1e-15);
    }
}

/// Over the date line the short way is meant.
#[test]
fn over_the_date_line() {
    let west = Geodetic::new(0.3, 3.1, 0.0);
    let point = Waypoint { position: Geodetic::new(0.3, -3.1, 0.0), passage: Passage::Speed(100.0) };
    let flight = Waypoints::new(west, &[point], false, Gravity::Normal).expect("a flight");
    // Along the parallel: the spline through two points is straight in latitude and longitude.
    let way = (std::f64::consts::TAU - 6.2) * schuler_frames::wgs84::r_n(0.3f64.sin()) * 0.3f64.cos();
    assert!((flight.duration().expect("an end") - way / 100.0).abs() < 1e-6);
    assert!(flight.at(1.0).v_t[1] > 99.9);
}

/// What is no track is refused, with the point.
#[test]
fn impossible_waypoints() {
    let there = |h: f64, passage| Waypoint { position: Geodetic::new(0.801, 0.2, h), passage };
    let good = there(300.0, Passage::Time(100.0));
    let cases = [
        (vec![], None, "no point"),
        (vec![good, there(400.0, Passage::Time(100.0))], Some(1), "does not come after"),
        (vec![good, there(400.0, Passage::Time(50.0))], Some(1), "does not come after"),
        (vec![there(300.0, Passage::Time(0.1))], Some(0), "speed"),
        (vec![there(300.0, Passage::Speed(13e3))], Some(0), "speed"),
        (vec![Waypoint { position: Geodetic::new(1.57, 0.2, 0.0), ..good }], Some(0), "latitude"),
        (vec![Waypoint { position: Geodetic { h: 400.0, ..PLACE }, ..good }], Some(0), "heading"),
    ];
    for (points, part, word) in cases {
        let fault = Waypoints::new(PLACE, &points, false, Gravity::Normal).expect_err(word);
        assert!(fault.part == part && fault.problem.contains(word), "{word}: {fault}");
    }
}

/// Without noise the splines are the trajectory, to what is faster than their knots; with noise most of it goes: of n
/// samples and p bases, n - p degrees of freedom stay in the residual.
#[test]
fn recorded_trajectories() {
    let mut rows = rows();
    let clean = Recorded::new(&rows, 2.0).expect("a trajectory");
    let residual = clean.residual();
    assert!(residual.position_largest < 1e-3 && residual.attitude_largest < 1e-3, "{residual:?}");
    let route = route(false);
    let away = |recorded: &Recorded| {
        let apart = |k: u32| {
            let t = 1.0 + f64::from(k) * 0.713;
            (recorded.at(t).position.as_ecef() - route.at(t).position.as_ecef()).norm()
        };
        (0..270).map(apart).map(|d| d * d / 270.0).sum::<f64>().sqrt()
    };
    assert!(away(&clean) < 1e-3);

    let draws = Draws::new(Stream { seed: 7, run: 0 }, &"noise");
    for (k, row) in rows.iter_mut().enumerate() {
        row.position.h += draws.normals(k as u64)[0];
    }
    let noisy = Recorded::new(&rows, 2.0).expect("a trajectory");
    let (n, p) = (4000.0, 105.0);
    let rms = noisy.residual().position_rms[2];
    // 5 sigma of an estimate of a variance by n - p.
    let expected: f64 = 1.0 - p / n;
    assert!((rms * rms / expected - 1.0).abs() < 5.0 * (2.0f64 / (n - p)).sqrt(), "{rms}");
    // What stays of the noise: p / n of its variance, 0.16 m.
    let stays = away(&noisy);
    assert!((0.1..0.25).contains(&stays), "{stays}");
}

/// What is no recording is refused, with the row.
#[test]
fn impossible_recordings() {
    let good = rows();
    type Change = fn(&mut Vec<crate::trajectory::Row>);
    let cases: [(Change, Option<usize>, &str); 5] = [
        (|rows| rows.clear(), None, "without rows"),
        (|rows| rows.truncate(5), None, "too few"),
        (|rows| rows[7].t = rows[6].t, Some(7), "does not come after"),
        (|rows| drop(rows.drain(100..200)), Some(100), "gap"),
        (|rows| rows[9].attitude.yaw += 2.0, Some(9), "jumps"),
    ];
    for (change, part, word) in cases {
        let mut rows = good.clone();
        change(&mut rows);
        let fault = Recorded::new(&rows, 2.0).expect_err(word);
        assert!(fault.part == part && fault.problem.contains(word), "{word}: {fault}");
    }
}
