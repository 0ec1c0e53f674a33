//! The ways of a budget against each other, against closed forms and against independent tables.

mod aided;
mod alignment;
mod any_list;
mod pictures;
mod radius;
mod responses;
mod shared;
mod shipped;

use std::f64::consts::PI;

use schuler_frames::{Euler, Geodetic, Gravity};
use schuler_imu::{Instrument, Source as Imu, Spec, Stream, Value};
use schuler_strapdown::Coning;
use schuler_strapdown::filter::{Accumulator, Form, Model, NavStates, Propagation};

use super::radius::horizontal;
use super::scene::Scene;
use super::source::{Nine, sources};
use super::{Contribution, TOTAL, Way, linear, monte_carlo, report};
use crate::scenario::{self, Budget, Frame, Initial, Mechanization, Motion, Start, Vertical};

const DEG_PER_HOUR: f64 = PI / 648_000.0;
const ARCMIN: f64 = PI / 10_800.0;
const UG: f64 = 9.80665e-6;

fn budget(lat_deg: f64, rate: f64, duration: f64, spec: Spec, initial_sigmas: Vec<Initial>) -> Budget {
    Budget {
        motion: Motion::Static,
        start: Start {
            epoch: None,
            position: Geodetic::new(lat_deg.to_radians(), 0.0, 0.0),
            attitude: Euler { roll: 0.0, pitch: 0.0, yaw: 0.0 },
            velocity: [0.0; 3],
        },
        samples: (duration * rate).round() as u64,
        imu: scenario::Imu { rate, spec, temperature: None },
        initial_sigmas,
        alignment: 0,
        filter: None,
        mechanization: Mechanization {
            frame: Frame::T,
            vertical: Vertical::Held,
            gravity: Gravity::Somigliana,
            coning: Coning::One,
        },
        requirement: None,
        runs: 0,
        runs_of_each: true,
    }
}

fn source(instrument: Instrument, term: &str, process: &str, name: &str, value: Value<'_>) -> Imu {
    Imu::named(instrument, term, process, &[(name, value)]).unwrap()
}

/// Tilt north and east, heading, velocity north and east, position north and east.
fn initial(size: f64) -> Vec<Initial> {
    let z = [0.0; 3];
    let at = |k: usize, x: f64| std::array::from_fn(|i| if i == k { x * size } else { 0.0 });
    let all = |name, position, velocity, phi| Initial { name, position, velocity, phi };
    vec![
        all("initial.tilt.n", z, z, at(0, 5e-5)),
        all("initial.tilt.e", z, z, at(1, 5e-5)),
        all("initial.heading.d", z, z, at(2, 3.2322 * ARCMIN)),
        all("initial.velocity.n", z, at(0, 0.1), z),
        all("initial.velocity.e", z, at(1, 0.1), z),
        all("initial.position.n", at(0, 60.0), z, z),
        all("initial.position.e", at(1, 60.0), z, z),
    ]
}

/// Constants, ramps and noises of both instruments.
fn mixed(size: f64) -> Spec {
    use Instrument::{Accel, Gyro};
    Spec::from_sources([
        source(Gyro, "bias", "constant", "sigma", (0.01 * DEG_PER_HOUR * size).into()),
        source(Accel, "bias", "constant", "sigma", (50.0 * UG * size).into()),
        source(Gyro, "scale_factor", "constant", "sigma", (1e-4 * size).into()),
        source(Accel, "misalignment", "constant", "value", (1e-4 * size).into()),
        source(Gyro, "bias", "ramp", "sigma", (0.001 * DEG_PER_HOUR / 3600.0 * size).into()),
        source(Gyro, "bias", "white", "density", (0.001 * PI / 180.0 / 60.0 * size).into()),
        source(Accel, "bias", "random_walk", "density", (UG / 60.0 * size).into()),
    ])
    .unwrap()
}

/// The largest difference of two covariances at any row, in units of the largest standard deviation of `b` in position, in
/// velocity and in attitude: a variance that is the difference of larger ones has their rounding, and
/// below 0.1 mm, 0.1 um/s and 1e-11 rad there is nothing else.
fn apart(a: &[Nine], b: &[Nine]) -> f64 {
    let unit: [f64; 3] = std::array::from_fn(|group| {
        let sigmas = b.iter().flat_map(|p| (0..3).map(|k| report::sigma(p, 3 * group + k)));
        sigmas.fold([1e-4, 1e-7, 1e-11][group], f64::max)
    });
    let off = |(a, b): (&Nine, &Nine)| {
        let entry = |i: usize, j: usize| (a[(i, j)] - b[(i, j)]).abs() / (unit[i / 3] * unit[j / 3]);
        (0..81).map(|n| entry(n / 9, n % 9)).fold(0.0, f64::max)
    };
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(off).fold(0.0, f64::max)
}

fn said<'a>(contributions: &'a [Contribution], name: &str, way: Way) -> &'a [Nine] {
    contributions.iter().find(|c| c.name == name).unwrap().of(way).unwrap()
}

/// The "1 nmi/h" class: radial RSS of the independent sources after 10 min, 1 h, 2 h, 6 h and 10 h (theory 1.9, computed
/// from 40-digit closed forms and printed to 1 m).
#[test]
fn the_one_mile_class_meets_its_table() {
    use Instrument::{Accel, Gyro};
    let spec = Spec::from_sources([
        source(Gyro, "bias", "constant", "sigma", (0.01 * DEG_PER_HOUR).into()),
        source(Accel, "bias", "constant", "sigma", Value::Each(&[50.0 * UG, 50.0 * UG, 0.0])),
    ])
    .unwrap();
    let mut initial = initial(1.0);
    initial.truncate(3);
    let study = budget(45.0, 1.0, 36_000.0, spec, initial);
    let scene = Scene::new(&study, Some(600.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    for way in [Way::Covariance, Way::Columns, Way::Exact] {
        let total = said(&all, TOTAL, way);
        for (t, expected) in
            [(600, 171.0), (3600, 2467.0), (7200, 3783.0), (21_600, 9844.0), (36_000, 13_974.0)]
        {
            let row = scene.rows.iter().position(|&k| k == t).unwrap();
            let found = horizontal(&total[row]).trace().sqrt();
            assert!((found - expected).abs() < 1.0, "{way:?} {t} s: {found} m, expected {expected} m");
        }
    }
}

/// Rows at rest: columns, covariance and adjoint against the closed form, 1e-9 of the standard deviations.
#[test]
fn ways_at_rest_agree_with_the_closed_form() {
    for lat in [0.0, 45.0, -75.0] {
        let study = budget(lat, 1.0, 36_000.0, mixed(1.0), initial(1.0));
        let scene = Scene::new(&study, Some(1800.0));
        let all = linear(&scene, &sources(&study)).unwrap();
        let (mut exact, mut adjoint) = (0, 0);
        for c in &all {
            let covariance = c.of(Way::Covariance).unwrap();
            if let Some(rows) = c.of(Way::Exact) {
                // Twice 1e-9: of a variance.
                let x = apart(covariance, rows);
                assert!(x < 2e-9, "lat {lat} {}: covariance {x:e}", c.name);
                if let Some(columns) = c.of(Way::Columns) {
                    let x = apart(columns, rows);
                    assert!(x < 2e-9, "lat {lat} {}: columns {x:e}", c.name);
                }
                exact += 1;
            }
            if let Some(rows) = c.of(Way::Adjoint) {
                let x = apart(rows, &covariance[covariance.len() - 1..]);
                assert!(x < 2e-9, "lat {lat} {}: adjoint {x:e}", c.name);
                adjoint += 1;
            }
        }
        assert!(exact > 20 && adjoint > 25, "{exact} closed forms, {adjoint} adjoints");
    }
}

/// Rows sum to the covariance of all sources in one model, to rounding.
#[test]
fn rows_sum_to_one_covariance_of_everything() {
    let study = budget(45.0, 1.0, 21_600.0, mixed(1.0), initial(1.0));
    let scene = Scene::new(&study, Some(3600.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    let model = Model::<48>::new(Form::Phi, NavStates::ALL, &study.imu.spec).unwrap();
    let mut sigmas = [0.0f64; 9];
    for source in sources(&study) {
        for (sum, s) in sigmas.iter_mut().zip(source.initial()) {
            *sum = sum.hypot(s);
        }
    }
    let x0 = model.x0();
    let mut p = model.p0(&sigmas).unwrap();
    for k in 0..48 {
        // Fixed values are independent rows: only their own squares.
        p[(k, k)] += x0[k] * x0[k];
    }
    let (pva, f_b) = scene.moment(0.0);
    let system = Form::Phi.system(&scene.dynamics(), &pva, f_b);
    let step = Propagation::exact(&model, &system, &scene.seen(0, 3600), 3600.0);
    let total = said(&all, TOTAL, Way::Covariance);
    let together: Vec<Nine> = (1..total.len())
        .map(|_| {
            step.transport(&mut p);
            step.diffuse(&mut p);
            Nine::from_fn(|i, j| p[(i, j)])
        })
        .collect();
    let x = apart(&total[1..], &together);
    assert!(x < 1e-12, "{x:e}");
}

/// The same along a flight, the sources of one model gathered together; and the way back.
#[test]
fn rows_of_a_flight_sum_to_one_covariance_of_everything() {
    let mut study = responses::missile(50.0);
    for s in mixed(1.0).sources().filter(|s| s.process().kind().name() != "constant") {
        study.imu.spec.push(*s).unwrap();
    }
    let scene = Scene::new(&study, Some(20.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    let model = Model::<48>::new(Form::Phi, NavStates::ALL, &study.imu.spec).unwrap();
    let mut p = model.p0(&[0.0; 9]).unwrap();
    for source in sources(&study) {
        for (k, sigma) in source.initial().into_iter().enumerate() {
            p[(k, k)] += sigma * sigma;
        }
    }
    let mut accumulator = Accumulator::new(&model, scene.dynamics(), &scene.moment(0.0).0);
    let mut together = vec![Nine::from_fn(|i, j| p[(i, j)])];
    for [begin, end] in super::covariance::intervals(&scene) {
        for s in super::passage::samples(&scene, begin, end).iter().flat_map(|s| &s.parts) {
            accumulator.step_seen(&model, &s.pva, &s.seen, &s.increments, s.dt);
        }
        accumulator.close(&model).apply(&mut p);
        if scene.rows.contains(&end) {
            together.push(Nine::from_fn(|i, j| p[(i, j)]));
        }
    }
    let x = apart(said(&all, TOTAL, Way::Covariance), &together);
    let y = apart(said(&all, TOTAL, Way::Adjoint), &together[together.len() - 1..]);
    assert!(x < 1e-12 && y < 1e-12, "{x:e} {y:e}");
}

/// Columns against half the difference of full runs of the opposite sign: 1e-6 of the largest response.
#[test]
fn columns_meet_half_differences() {
    let mut spec = Spec::new();
    for s in mixed(0.1).sources().filter(|s| s.process().kind().name() == "constant") {
        spec.push(*s).unwrap();
    }
    let study = budget(45.0, 10.0, 7200.0, spec, initial(0.1));
    let scene = Scene::new(&study, Some(600.0));
    let track = monte_carlo::Track::new(&scene).unwrap();
    let all = sources(&study);
    let responses = super::columns::responses(&scene, &all);
    let mut compared = 0;
    for (source, response) in all.iter().zip(&responses) {
        // The response of a fixed value of one standard deviation.
        let value = match (&source.kind, source.size()) {
            (super::source::Kind::Sensor(c), Some(size)) => {
                let mut values = vec![0.0; c.term().len()];
                values[c.coefficient()] = size.value;
                let fixed = Imu::named(
                    c.instrument(),
                    c.term().name(),
                    "constant",
                    &[("value", Value::Each(&values))],
                );
                Spec::from_sources([fixed.unwrap()]).unwrap()
            }
            _ => Spec::new(),
        };
        let stream = Stream { seed: 1, run: 0 };
        let [plus, minus] = [1.0, -1.0].map(|sign| {
            let initial = source.initial().map(|x| sign * x);
            let spec = &value.scaled(sign);
            monte_carlo::Run { track: &track, sources: &[], spec, initial, stream }.navigate(&scene).unwrap()
        });
        for k in [0, 1, 3, 4, 6, 7, 8] {
            let group = k / 3 * 3..k / 3 * 3 + 3;
            let largest =
                response.iter().flat_map(|r| r[group.clone()].to_vec()).fold(0.0, |m: f64, x| m.max(x.abs()));
            let rounding = [1e-4, 1e-7, 1e-11][k / 3];
            if largest < rounding {
                continue;
            }
            for ((p, m), r) in plus.iter().zip(&minus).zip(response) {
                let off = (0.5 * (p[k] - m[k]) - r[k]).abs();
                assert!(
                    off < 1e-6 * largest + rounding * 1e-3,
                    "{} error {k}: {off:e} of {largest:e}",
                    source.name
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 500, "{compared}");
}

/// Runs against covariance: every row's variance within the chi-square band that one in a hundred thousand leaves
/// (the 99 % band of the report, widened because a hundred numbers are judged at once).
#[test]
fn runs_meet_the_covariance() {
    let mut spec = Spec::new();
    for s in
        mixed(1.0).sources().filter(|s| s.process().kind().name() != "constant" || s.term().name() == "bias")
    {
        spec.push(*s).unwrap();
    }
    let mut study = budget(45.0, 1.0, 3600.0, spec, initial(1.0));
    study.runs = 400;
    let scene = Scene::new(&study, Some(1800.0));
    let track = monte_carlo::Track::new(&scene).unwrap();
    let list = sources(&study);
    let all = linear(&scene, &list).unwrap();
    let sigma = (2.0 / study.runs as f64).sqrt();
    let (mut outside, mut judged) = (0, 0);
    let band = report::band(study.runs);
    for (k, c) in all.iter().enumerate() {
        let together = list.get(k).map_or(&list[..], std::slice::from_ref);
        let found = monte_carlo::covariance(&scene, &track, together, 3).unwrap();
        let theory = c.of(Way::Covariance).unwrap();
        for k in [0, 1, 3, 4, 6, 7, 8] {
            let (found, theory) = (found.last().unwrap()[(k, k)], theory.last().unwrap()[(k, k)]);
            if theory < [1e-8, 1e-14, 1e-22][k / 3] {
                continue;
            }
            let ratio = found / theory;
            assert!((ratio - 1.0).abs() < 4.5 * sigma, "{} error {k}: {ratio}", c.name);
            outside += usize::from(!(band[0]..=band[1]).contains(&ratio));
            judged += 1;
        }
    }
    // The numbers of one source hang together: a few per cent may be outside.
    assert!(judged > 60 && outside * 20 <= judged, "{outside} of {judged}");
}

/// 99 % band of the chi-square distribution (NIST/SEMATECH e-Handbook, 1.3.6.7.4: 100 degrees of freedom, 67.328 and
/// 140.169), and the two formulas next to each other.
#[test]
fn bands_of_chi_square() {
    let [low, high] = report::band(100);
    assert!((low * 100.0 - 67.328).abs() < 1e-3 && (high * 100.0 - 140.169).abs() < 1e-3);
    let ([a, b], [c, d]) = (report::band(1000), report::band(1001));
    assert!((a - c).abs() < 1e-4 && (b - d).abs() < 1e-4);
}

/// Standard deviations against the table of an independent Van Loan computation (11 digits printed): 1e-8.
#[test]
fn noise_growth_meets_the_table() {
    use Instrument::{Accel, Gyro};
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/static_theory/noise_rms.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let arw = 0.001 * PI / 180.0 / 60.0;
    let of = |case: &str| -> Imu {
        let one = |i, k: usize, x: f64| {
            let values: [f64; 3] = std::array::from_fn(|j| if j == k { x } else { 0.0 });
            source(i, "bias", "white", "density", Value::Each(&values))
        };
        let markov = |i, sigma: f64, tau: f64| {
            Imu::named(i, "bias", "gauss_markov", &[("sigma", sigma.into()), ("tau", tau.into())]).unwrap()
        };
        match case {
            "ARW_N" => one(Gyro, 0, arw),
            "ARW_E" => one(Gyro, 1, arw),
            "ARW_D" => one(Gyro, 2, arw),
            "ARW_all" => source(Gyro, "bias", "white", "density", arw.into()),
            "VRW_N" => one(Accel, 0, 10.0 * UG),
            "VRW_E" => one(Accel, 1, 10.0 * UG),
            "VRW_all" => source(Accel, "bias", "white", "density", (10.0 * UG).into()),
            "RRW_all" => source(Gyro, "bias", "random_walk", "density", (0.001 * DEG_PER_HOUR / 60.0).into()),
            "ARRW_all" => source(Accel, "bias", "random_walk", "density", (UG / 60.0).into()),
            "GMg_all_1h" => markov(Gyro, 0.01 * DEG_PER_HOUR, 3600.0),
            "GMg_all_100s" => markov(Gyro, 0.01 * DEG_PER_HOUR, 100.0),
            "GMa_all_1h" => markov(Accel, 50.0 * UG, 3600.0),
            "GMa_all_100s" => markov(Accel, 50.0 * UG, 100.0),
            other => panic!("no case {other}"),
        }
    };
    let mut done: Vec<(String, Vec<Nine>)> = Vec::new();
    let mut compared = 0;
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap();
        let key = format!("{} {}", fields[0], fields[1]);
        if done.last().is_none_or(|(k, _)| *k != key) {
            let study =
                budget(number(0), 1.0, 86_400.0, Spec::from_sources([of(fields[1])]).unwrap(), Vec::new());
            let scene = Scene::new(&study, Some(12.0));
            let rows = super::covariance::covariance(&scene, &sources(&study));
            let total = (0..scene.rows.len()).map(|k| rows.iter().map(|p| p[k]).sum()).collect();
            done.push((key, total));
        }
        let p = &done.last().unwrap().1[(number(2) / 12.0).round() as usize];
        for (column, k) in [3, 4, 6, 7, 8, 0, 1].into_iter().enumerate() {
            let unit = if (6..9).contains(&k) { ARCMIN } else { 1.0 };
            let (got, expected) = (report::sigma(p, k) / unit, number(3 + column));
            let scale = if expected == 0.0 { 1.0 } else { expected };
            assert!((got - expected).abs() / scale < 1e-8, "{line}: error {k}: {got} against {expected}");
            compared += 1;
        }
    }
    assert_eq!(compared, 13 * 7 * 7);
}

/// Along a motion the accumulated covariance, the way back and the columns agree: an airliner on a great circle, with biases
/// and scale factors.
#[test]
fn ways_agree_along_a_flight() {
    use Instrument::{Accel, Gyro};
    let spec = Spec::from_sources([
        source(Gyro, "bias", "constant", "sigma", (0.01 * DEG_PER_HOUR).into()),
        source(Accel, "bias", "constant", "sigma", (50.0 * UG).into()),
        source(Gyro, "scale_factor", "constant", "sigma", 1e-5.into()),
    ])
    .unwrap();
    let mut study = budget(45.0, 50.0, 600.0, spec, initial(1.0));
    study.motion = Motion::GreatCircle(250.0, scenario::Way::Heading(0.7));
    study.start.position.h = 10_000.0;
    let scene = Scene::new(&study, Some(100.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    for c in all.iter().filter(|c| c.name != TOTAL) {
        let x = apart(c.of(Way::Covariance).unwrap(), c.of(Way::Columns).unwrap());
        assert!(x < 1e-6, "{}: {x:e}", c.name);
        assert!(c.of(Way::Exact).is_none());
        let covariance = c.of(Way::Covariance).unwrap();
        let x = apart(c.of(Way::Adjoint).unwrap(), &covariance[covariance.len() - 1..]);
        assert!(x < 2e-9, "{}: adjoint {x:e}", c.name);
    }
}

impl monte_carlo::Run<'_> {
    /// The run by itself.
    fn navigate(self, scene: &Scene) -> Result<Vec<[f64; 9]>, crate::Error> {
        Ok(monte_carlo::together(scene, &[self])?.remove(0))
    }
}
