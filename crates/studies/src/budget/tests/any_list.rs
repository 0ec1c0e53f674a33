//! Lists of every kind: every term, every process, and what is said of those that a filter or linear theory leaves out.

use schuler_imu::{Instrument, Source as Imu, Spec, process::PROCESSES, term::TERMS};

use super::super::scene::Scene;
use super::super::source::sources;
use super::super::{TOTAL, Way, columns, linear, monte_carlo, report};
use super::aided::driven;
use super::responses::{half_difference, missile, off};
use super::*;
use crate::trajectory::TableTurns;
use crate::{
    Scenario,
    scenario::{Required, Study},
};

/// The shipped list of every term, on its rate table and under its temperature. A budget refuses the table, which mounts the
/// instrument anew after a third of the time; until then it is a motion like others.
fn every_term() -> Budget {
    let text = include_str!("../../../../../configs/imu_every_term.yaml");
    let (head, _) = text.split_once("output:").unwrap();
    let text = head
        .replace("study: imu", "study: budget")
        .replace("duration: 120 s", "duration: 30 s")
        .replace("rate: 100 Hz", "rate: 400 Hz")
        + "mechanization: { frame: t, vertical: free, gravity: normal }\n";
    let error = Scenario::load("a.yaml", &text, &[]).expect_err("a rate table").to_string();
    assert!(error.contains("mounts the instrument anew"), "{error}");
    let table = "motion: { rate_table: { rate: 30 deg/s, tilt: 30 deg, acceleration: 30 deg/s^2, vibration: 0.2 g } }";
    let text = text.replace(table, "motion: static");
    let Study::Budget(mut study) =
        Scenario::load("a.yaml", &text, &[]).unwrap_or_else(|e| panic!("{e}")).study
    else {
        panic!("a budget")
    };
    let rate = 30f64.to_radians();
    study.motion =
        Motion::RateTable(TableTurns { rate, tilt: rate, acceleration: rate, vibration: [0.2 * 9.80665; 3] });
    *study
}

/// Each coefficient of every term, along a motion that excites it: columns, covariance and half-differences agree.
#[test]
fn every_term_does_what_runs_do() {
    let study = every_term();
    let scene = Scene::new(&study, None).with_rows((0..10).map(|k| 400 * k).collect());
    let all = sources(&study);
    let found = linear(&scene, &all).unwrap();
    let responses = columns::responses(&scene, &all);
    let track = monte_carlo::Track::new(&scene).unwrap();
    let mut terms: Vec<&str> = Vec::new();
    let mut compared = 0;
    for ((source, response), c) in all.iter().zip(&responses).zip(&found) {
        let half = half_difference(&scene, &track, source, 1.0);
        let x = off(&half, response, [1e-4, 1e-4, 1e-7]);
        let y = apart(c.of(Way::Covariance).unwrap(), c.of(Way::Columns).unwrap());
        assert!(x.into_iter().all(|x| x < 2e-5) && y < 2e-5, "{}: {x:?} {y:e}", source.name);
        compared += x.into_iter().filter(|x| *x > 0.0).count();
        terms.push(source.name.split('.').nth(1).unwrap());
    }
    terms.sort_unstable();
    terms.dedup();
    assert!(terms.len() == TERMS.len() && compared > 100, "{compared} {terms:?}");
}

/// Every process that scatters, each on another term.
fn every_process(size: f64) -> Spec {
    use Instrument::{Accel, Gyro};
    let s = |x: f64| Value::from(x * size);
    let of = |i, term, process, values: &[(&str, Value<'_>)]| Imu::named(i, term, process, values).unwrap();
    let second = |x: f64| Value::from(x);
    Spec::from_sources([
        of(Gyro, "bias", "constant", &[("sigma", s(DEG_PER_HOUR))]),
        of(Gyro, "bias", "white", &[("density", s(0.05 * PI / 180.0 / 60.0))]),
        of(Gyro, "bias", "random_walk", &[("density", s(0.5 * DEG_PER_HOUR / 60.0))]),
        of(Gyro, "scale_factor", "gauss_markov", &[("sigma", s(3e-4)), ("tau", second(30.0))]),
        of(Accel, "bias", "second_order_gauss_markov", &[("sigma", s(300.0 * UG)), ("tau", second(20.0))]),
        of(
            Gyro,
            "bias",
            "flicker",
            &[("instability", s(2.0 * DEG_PER_HOUR)), ("tau_min", second(1.0)), ("tau_max", second(100.0))],
        ),
        of(Accel, "bias", "ramp", &[("sigma", s(5.0 * UG))]),
        of(Gyro, "bias", "quantization", &[("q", s(2e-5))]),
        of(Accel, "bias", "quantization", &[("q", s(2e-2))]),
        of(Gyro, "bias", "sinusoid", &[("amplitude", s(20.0 * DEG_PER_HOUR)), ("frequency", second(0.05))]),
        of(Accel, "misalignment", "white", &[("density", s(1e-4))]),
    ])
    .unwrap()
}

/// Every process in flight: runs of each and of all against the covariance, forward and back; one process of the IMU is a letter
/// of a paper with a fixed value, which runs refuse.
#[test]
fn every_process_does_what_runs_do() {
    let mut study = Budget { samples: 1500, ..missile(50.0) };
    study.imu.spec = every_process(1.0);
    study.initial_sigmas.clear();
    study.runs = 150;
    let kinds: std::collections::BTreeSet<&str> =
        study.imu.spec.sources().map(|s| s.process().kind().name()).collect();
    assert_eq!(kinds.len() + 1, PROCESSES.len());
    judge(&study);
}

/// The same through a filter that knows of constants and white noise.
#[test]
fn every_process_through_a_filter_does_what_runs_do() {
    let mut study = driven(1.0, 20.0);
    study.imu.spec = every_process(1.0);
    study.runs = 150;
    judge(&study);
}

/// Runs of each source and of all against the covariance, where a source has a hundredth of a variance: of less, what is left is
/// the second order, and the navigator's own step.
fn judge(study: &Budget) {
    let scene = Scene::new(study, Some(10.0));
    let track = monte_carlo::Track::new(&scene).unwrap();
    let list = sources(study);
    let all = linear(&scene, &list).unwrap();
    let sigma = (2.0 / study.runs as f64).sqrt();
    let whole = said(&all, TOTAL, Way::Covariance);
    for (k, c) in all.iter().enumerate() {
        let theory = c.of(Way::Covariance).unwrap();
        let mut other = theory.to_vec();
        other[theory.len() - 1] = c.of(Way::Adjoint).unwrap()[0];
        let x = apart(&other, theory);
        assert!(x < 2e-9, "{}: adjoint {x:e}", c.name);
        let together = list.get(k).map_or(&list[..], std::slice::from_ref);
        let runs = monte_carlo::covariance(&scene, &track, together, 3).unwrap();
        for (row, (p, q)) in theory.iter().zip(&runs).enumerate().skip(1) {
            for e in (0..9).filter(|&e| p[(e, e)] > 1e-2 * whole[row][(e, e)] && whole[row][(e, e)] > 0.0) {
                let ratio = q[(e, e)] / p[(e, e)];
                assert!((ratio - 1.0).abs() < 4.5 * sigma, "{} row {row} error {e}: {ratio}", c.name);
            }
        }
    }
}

/// Rounding at rest for a second, levelled, where nothing else turns: a tilt (e_n - e_0) and, with the mean of two ends in
/// each of n steps,
///
/// ```text
/// var(phi) = 2 q²,   var(dv) = (g q dt)² [(n - 1/2)² + n - 3/4]        (gyro; the same for dv and dr of an accelerometer)
/// ```
#[test]
fn rounding_meets_its_closed_forms() {
    use Instrument::{Accel, Gyro};
    let (q, n, dt) = (1e-5, 100.0, 0.01);
    let of = |i, x: f64| source(i, "bias", "quantization", "q", Value::Each(&[x, 0.0, 0.0]));
    let spec = Spec::from_sources([of(Gyro, q), of(Accel, q)]).unwrap();
    let study = budget(45.0, 100.0, 1.0, spec, Vec::new());
    let scene = Scene::new(&study, Some(1.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    let g = -scene.moment(0.0).1[2];
    let integral = q * dt * f64::sqrt((n - 0.5) * (n - 0.5) + n - 0.75);
    for (name, k, expected) in [
        ("gyro.bias.quantization.x", 6, q * f64::sqrt(2.0)),
        ("gyro.bias.quantization.x", 4, g * integral),
        ("accel.bias.quantization.x", 3, q * f64::sqrt(2.0)),
        ("accel.bias.quantization.x", 0, integral),
    ] {
        for way in [Way::Covariance, Way::Adjoint] {
            let found = report::sigma(said(&all, name, way).last().unwrap(), k);
            assert!((found / expected - 1.0).abs() < 1e-5, "{name} {k}: {found:e}, expected {expected:e}");
        }
    }
    // An alignment of a second before: the tilt is of the last error and the first, nabla / g.
    let aligned = Budget { alignment: 100, ..study.clone() };
    let scene = Scene::new(&aligned, Some(1.0));
    let all = linear(&scene, &sources(&aligned)).unwrap();
    let start = &said(&all, "accel.bias.quantization.x", Way::Covariance)[0];
    let expected = q * f64::sqrt(2.0) / g;
    assert!((report::sigma(start, 7) / expected - 1.0).abs() < 1e-9);
}

/// What a filter does not see is said.
#[test]
fn what_a_filter_leaves_out_is_said() {
    let mut study = driven(1.0, 20.0);
    let knows = [
        source(Instrument::Gyro, "thermal", "constant", "sigma", 1e-7.into()),
        source(Instrument::Gyro, "bias", "quantization", "q", 1e-5.into()),
    ];
    let filter = study.filter.as_mut().unwrap();
    knows.into_iter().for_each(|known| filter.spec.push(known).unwrap());
    let scene = Scene::new(&study, Some(60.0));
    let notes =
        report::notes(&scene, &linear(&scene, &sources(&study)).unwrap(), None, &[Required::Horizontal]);
    let said = |words: &str| notes.iter().any(|note| note.contains(words));
    assert!(said("what it knows of gyro.thermal.constant does nothing"), "{notes:?}");
    assert!(said("it takes gyro.bias.quantization to be nothing"), "{notes:?}");
    assert!(said("to the antenna is left out by covariance"), "{notes:?}");
}

/// A signal of a known phase does not scatter.
#[test]
fn runs_refuse_a_known_phase() {
    let text = "\
schuler: 1
study: budget
title: A test
start: { position: { lat: 45 deg, lon: 0 deg, h: 0 m } }
motion: static
duration: 60 s
imu: { rate: 10 Hz, gyro: [bias: { sinusoid: { amplitude: 1 deg/h, frequency: 0.1 Hz, phase: 30 deg } }], accel: [] }
mechanization: { frame: t, vertical: held, gravity: somigliana }
budget: { runs: 10 }
";
    let error = Scenario::load("a.yaml", text, &[]).expect_err("a known phase").to_string();
    assert!(error.contains("gyro.bias.sinusoid.x") && error.contains("no `phase`"), "{error}");
    assert!(Scenario::load("a.yaml", &text.replace(", phase: 30 deg", ""), &[]).is_ok());
}
