//! The ways of a drift study against each other and against independent tables.

use std::f64::consts::PI;

use schuler_frames::{Euler, Geodetic, Gravity};
use schuler_imu::{Instrument, Source, Spec, Value};
use schuler_strapdown::Coning;

use super::case::cases;
use super::linear::Linear;
use super::scene::Scene;
use super::{Curves, Way, curves, summary};
use crate::Context;
use crate::scenario::{Drift, Frame, Imu, Initial, Mechanization, Start, Vertical};

const ARCSEC: f64 = PI / 648_000.0;
const DEG_PER_HOUR: f64 = PI / 648_000.0;
const UG: f64 = 9.80665e-6;

fn drift(lat_deg: f64, rate: f64, duration: f64, spec: Spec, initial_errors: Vec<Initial>) -> Drift {
    Drift {
        start: Start {
            epoch: None,
            position: Geodetic::new(lat_deg.to_radians(), 0.0, 0.0),
            attitude: Euler { roll: 0.0, pitch: 0.0, yaw: 0.0 },
            velocity: [0.0; 3],
        },
        samples: (duration * rate) as u64,
        imu: Imu { rate, spec, temperature: None },
        initial_errors,
        mechanization: Mechanization {
            frame: Frame::T,
            vertical: Vertical::Held,
            gravity: Gravity::Somigliana,
            coning: Coning::One,
        },
    }
}

fn source(instrument: Instrument, term: &str, process: &str, parameters: &[(&str, Value<'_>)]) -> Source {
    Source::named(instrument, term, process, parameters).unwrap()
}

fn run(drift: &Drift, every: f64) -> (Scene, Vec<Curves>) {
    let scene = Scene::new(drift, Some(every));
    let all = cases(drift)
        .into_iter()
        .map(|case| curves(&scene, drift, case, 7, &Context::silent()).unwrap())
        .collect();
    (scene, all)
}

/// Every source of the shipped study's kind, at the sizes of the reference tables times `size`.
fn deterministic(size: f64) -> (Spec, Vec<Initial>) {
    use Instrument::{Accel, Gyro};
    let g = 0.01 * DEG_PER_HOUR * size;
    let a = 100.0 * UG * size;
    let (p, m) = (1e-4 * size, 20.0 * ARCSEC * size);
    let spec = Spec::from_sources([
        source(Gyro, "bias", "constant", &[("value", g.into())]),
        source(Accel, "bias", "constant", &[("value", a.into())]),
        source(Gyro, "scale_factor", "constant", &[("value", p.into())]),
        source(Accel, "scale_factor", "constant", &[("value", p.into())]),
        source(Accel, "quadratic", "constant", &[("value", (10.0 * UG / 96.17 * size).into())]),
        source(Gyro, "misalignment", "constant", &[("value", m.into())]),
        source(Accel, "misalignment", "constant", &[("value", m.into())]),
        source(Gyro, "bias", "ramp", &[("rate", (0.001 * DEG_PER_HOUR / 3600.0 * size).into())]),
        source(Accel, "bias", "ramp", &[("rate", (10.0 * UG / 3600.0 * size).into())]),
    ])
    .unwrap();
    let z = [0.0; 3];
    let at = |k: usize, x: f64| std::array::from_fn(|i| if i == k { x * size } else { 0.0 });
    let initial = |name, position, velocity, phi| Initial { name, position, velocity, phi };
    let initial = vec![
        initial("initial.tilt.n", z, z, at(0, 10.0 * ARCSEC)),
        initial("initial.tilt.e", z, z, at(1, 10.0 * ARCSEC)),
        initial("initial.heading", z, z, at(2, 60.0 * ARCSEC)),
        initial("initial.velocity.n", z, at(0, 0.1), z),
        initial("initial.velocity.e", z, at(1, 0.1), z),
        initial("initial.position.n", at(0, 63.7), z, z),
        initial("initial.position.e", at(1, 63.7), z, z),
    ];
    (spec, initial)
}

fn column(curves: &[Curves], name: &str) -> Vec<(String, f64)> {
    let table = summary::table(curves);
    let values = table.numbers(name).unwrap();
    curves.iter().zip(values).map(|(c, v)| (c.case.name.clone(), *v)).collect()
}

/// Whether the source does nothing in this attitude: then there is no relative difference to judge.
fn is_silent(curves: &[Curves], name: &str) -> bool {
    let c = curves.iter().find(|c| c.case.name == name).unwrap();
    c.ways.iter().all(|(_, rows)| summary::is_silent(rows))
}

/// Half-difference against linear 1e-6 and linear against closed form 1e-9, for every source over 24 h at
/// two latitudes. (theory: the half-difference keeps a third-order residue of 1e-6 for 0.01 deg/h over a day
/// and more for all together, so the sizes here are a tenth of the tables'.)
#[test]
fn ways_agree_for_every_known_source() {
    for lat in [0.0, -75.0] {
        let (spec, initial) = deterministic(0.1);
        let (_, curves) = run(&drift(lat, 10.0, 86_400.0, spec, initial), 600.0);
        for (name, x) in column(&curves, "linear_exact") {
            assert!(x < 1e-9 || is_silent(&curves, &name), "lat {lat} {name}: linear against exact {x:e}");
        }
        for (name, x) in column(&curves, "half_linear") {
            // The third order of thirty sources at once is larger than that of any one.
            let limit = if name == "all" { 1e-5 } else { 1e-6 };
            assert!(
                x < limit || is_silent(&curves, &name),
                "lat {lat} {name}: half-difference against linear {x:e}"
            );
        }
        // Something must have moved for most sources, or the agreement says nothing.
        let moved = column(&curves, "linear_exact").iter().filter(|(_, x)| x.is_finite()).count();
        assert!(moved > 20, "lat {lat}: only {moved} sources move");
    }
}

/// The difference of the non-linear run from the linear one is of second order: a tenth of the size leaves a
/// hundredth of it.
#[test]
fn second_order_residue_falls_by_a_hundred() {
    let residues = [1.0, 0.1].map(|size| {
        let (spec, _) = deterministic(size);
        let spec = spec.keep(|c| c.term().name() == "bias" && c.label() != "z");
        let (_, curves) = run(&drift(45.0, 20.0, 86_400.0, spec, Vec::new()), 600.0);
        let worst = |c: &Curves| {
            let (a, b) = (c.of(Way::Nonlinear).unwrap(), c.of(Way::HalfDifference).unwrap());
            // The even part alone: third order would spoil the factor.
            a.iter().zip(b).map(|(a, b)| (a.dr - b.dr).norm()).fold(0.0, f64::max)
        };
        curves.iter().map(|c| (c.case.name.clone(), worst(c))).collect::<Vec<_>>()
    });
    let mut compared = 0;
    for ((name, whole), (_, tenth)) in residues[0].iter().zip(&residues[1]) {
        let ratio = whole / tenth;
        // Below a decimetre the tenth's hundredth sinks into the error of the mechanization itself.
        if *whole > 0.1 {
            assert!((ratio - 100.0).abs() < 1.0, "{name}: {whole} m, at a tenth {tenth} m, ratio {ratio}");
            compared += 1;
        }
    }
    assert!(compared >= 5, "only {compared} sources have a second-order residue to compare");
}

/// Scale factor, quadratic term and misalignment on a base at rest are biases: their runs equal those of the
/// equivalent biases (theory.md 1.1 by hand: level, heading 0, lat 45).
#[test]
fn static_excitation_makes_biases_of_the_other_terms() {
    use Instrument::{Accel, Gyro};
    let scene = Scene::new(&drift(45.0, 10.0, 1.0, Spec::new(), Vec::new()), None);
    let (o, g) = (7.292115e-5 * 45f64.to_radians().cos(), scene.site.g);
    let k = 1e-3;
    // instrument, term, coefficient number, equivalent bias along x, y, z
    let cases: [(Instrument, &str, usize, [f64; 3]); 8] = [
        (Gyro, "scale_factor", 0, [k * o, 0.0, 0.0]),
        (Gyro, "scale_factor", 2, [0.0, 0.0, -k * o]),
        (Gyro, "misalignment", 2, [0.0, k * o, 0.0]),
        (Gyro, "misalignment", 3, [0.0, -k * o, 0.0]),
        (Accel, "scale_factor", 2, [0.0, 0.0, -k * g]),
        (Accel, "misalignment", 1, [-k * g, 0.0, 0.0]),
        (Accel, "misalignment", 3, [0.0, -k * g, 0.0]),
        (Accel, "quadratic", 2, [0.0, 0.0, k * g * g]),
    ];
    for (instrument, term, j, bias) in cases {
        let len = schuler_imu::term(term).unwrap().labels().len();
        let mut value = vec![0.0; len];
        value[j] = k;
        let pair = [
            source(instrument, term, "constant", &[("value", Value::Each(&value))]),
            source(instrument, "bias", "constant", &[("value", Value::Each(&bias))]),
        ];
        let [a, b] = pair.map(|source| {
            let spec = Spec::from_sources([source]).unwrap();
            let drift = drift(45.0, 10.0, 6.0 * 3600.0, spec, Vec::new());
            let (_, curves) = run(&drift, 600.0);
            curves.iter().find(|c| c.case.name == "all").unwrap().of(Way::Nonlinear).unwrap().to_vec()
        });
        for (x, y) in a.iter().zip(&b) {
            let apart = (x.dr - y.dr).norm();
            assert!(apart <= 1e-9 * (1.0 + y.dr.norm()), "{term} {j}: {apart} m apart");
        }
    }
}

/// The single-axis formula after 24 h at latitude 45 deg in metres (theory.md, table 1.5, printed to 0.01 m), and the
/// percentage by which it fails: against the end and the largest radial error of the 40-digit tables.
#[test]
fn textbook_formula_fails_as_the_tables_say() {
    let (spec, initial) = deterministic(1.0);
    let spec = spec.keep(|c| c.to_string().contains("bias.constant"));
    let (scene, curves) = run(&drift(45.0, 1.0, 86_400.0, spec, initial), 300.0);
    let expected = [
        ("gyro.bias.constant.x", "gyro_N", [0.0, 26705.10]),
        ("gyro.bias.constant.y", "gyro_E", [-26572.98, 0.0]),
        ("gyro.bias.constant.z", "gyro_D", [-59410.82, 0.0]),
        ("accel.bias.constant.x", "acc_N", [52.21, 0.0]),
        ("accel.bias.constant.y", "acc_E", [0.0, 16.47]),
        ("initial.tilt.n", "tilt_N", [0.0, -7.99]),
        ("initial.tilt.e", "tilt_E", [25.31, 0.0]),
        ("initial.heading", "heading", [8221.10, 0.0]),
        ("initial.velocity.n", "vel_N", [31.96, 0.0]),
        ("initial.velocity.e", "vel_E", [0.0, 18.21]),
    ];
    let failures = column(&curves, "single_axis_exact");
    for (name, table, [n, e]) in expected {
        let c = curves.iter().find(|c| c.case.name == name).unwrap();
        let end = c.of(Way::SingleAxis).unwrap().last().unwrap().dr;
        assert!((end[0] - n).abs() < 0.00501 && (end[1] - e).abs() < 0.00501, "{name}: {end:?}");
        let path = format!("{}/../../tests/data/static_theory/lin_{table}.csv", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        let position = |line: &str| {
            let x: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
            [x[6] * scene.site.r_m, x[7] * scene.site.r_n * scene.site.cos_lat]
        };
        let track: Vec<[f64; 2]> = text.lines().skip(1).map(position).collect();
        let largest = track.iter().map(|[n, e]| n.hypot(*e)).fold(0.0, f64::max);
        let last = track[track.len() - 1];
        let expected = (n - last[0]).hypot(e - last[1]) / largest;
        let (_, found) = failures.iter().find(|(f, _)| f == name).unwrap();
        assert!((found / expected - 1.0).abs() < 1e-3, "{name}: {found} against {expected}");
    }
}

/// Standard deviations against the table of an independent Van Loan computation (11 digits printed).
#[test]
fn noise_growth_meets_the_table() {
    use Instrument::{Accel, Gyro};
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/static_theory/noise_rms.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let root_hour = 60.0;
    let arw = 0.001 * PI / 180.0 / root_hour;
    let vrw = 10.0 * UG;
    let rrw = 0.001 * DEG_PER_HOUR / root_hour;
    let arrw = UG / root_hour;
    let axes = |k: usize, x: f64| -> Vec<f64> { (0..3).map(|i| if i == k { x } else { 0.0 }).collect() };
    let of = |case: &str| -> Option<Source> {
        let each = |i, p, name: &str, v: Vec<f64>| source(i, "bias", p, &[(name, Value::Each(&v))]);
        let same = |i, p, name: &str, v: f64| source(i, "bias", p, &[(name, v.into())]);
        let markov = |i, sigma: f64, tau: f64| {
            source(i, "bias", "gauss_markov", &[("sigma", sigma.into()), ("tau", tau.into())])
        };
        Some(match case {
            "ARW_N" => each(Gyro, "white", "density", axes(0, arw)),
            "ARW_E" => each(Gyro, "white", "density", axes(1, arw)),
            "ARW_D" => each(Gyro, "white", "density", axes(2, arw)),
            "ARW_all" => same(Gyro, "white", "density", arw),
            "VRW_N" => each(Accel, "white", "density", axes(0, vrw)),
            "VRW_E" => each(Accel, "white", "density", axes(1, vrw)),
            "VRW_all" => same(Accel, "white", "density", vrw),
            "RRW_all" => same(Gyro, "random_walk", "density", rrw),
            "ARRW_all" => same(Accel, "random_walk", "density", arrw),
            "GMg_all_1h" => markov(Gyro, 0.01 * DEG_PER_HOUR, 3600.0),
            "GMg_all_100s" => markov(Gyro, 0.01 * DEG_PER_HOUR, 100.0),
            "GMa_all_1h" => markov(Accel, 50.0 * UG, 3600.0),
            "GMa_all_100s" => markov(Accel, 50.0 * UG, 100.0),
            _ => return None,
        })
    };
    let mut compared = 0;
    let mut unknown = std::collections::BTreeSet::new();
    let mut done: Vec<(String, Scene, Vec<schuler_strapdown::NavError>)> = Vec::new();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap();
        let key = format!("{} {}", fields[0], fields[1]);
        let Some(source) = of(fields[1]) else {
            unknown.insert(fields[1].to_string());
            continue;
        };
        if !done.iter().any(|(k, _, _)| *k == key) {
            let drift = drift(number(0), 1.0, 86_400.0, Spec::from_sources([source]).unwrap(), Vec::new());
            let scene = Scene::new(&drift, Some(12.0));
            let case = cases(&drift).swap_remove(0);
            let sigmas = Linear::complete(&scene).sigmas(&scene, &case);
            done.push((key.clone(), scene, sigmas));
        }
        let (_, scene, sigmas) = done.iter().find(|(k, _, _)| *k == key).unwrap();
        let row = scene.rows.iter().position(|&k| scene.time(k) == number(2)).unwrap();
        let s = &sigmas[row];
        let arcmin = 60.0 * ARCSEC;
        let got =
            [s.dv[0], s.dv[1], s.phi[0] / arcmin, s.phi[1] / arcmin, s.phi[2] / arcmin, s.dr[0], s.dr[1]];
        for (k, got) in got.iter().enumerate() {
            let expected = number(3 + k);
            let scale = if expected == 0.0 { 1.0 } else { expected };
            assert!((got - expected).abs() / scale < 1e-8, "{line}: column {k}: {got} against {expected}");
            compared += 1;
        }
    }
    assert!(compared == 13 * 7 * 7, "{compared} numbers compared");
    assert!(unknown.is_empty(), "cases not compared: {unknown:?}");
}

/// The single-axis standard deviations are those of the formulas of theory.md 1.7 (white noise and random walk
/// through one Schuler loop), each axis with its own radius.
#[test]
fn single_axis_noise_meets_its_formulas() {
    use Instrument::{Accel, Gyro};
    let (n, v, k) = (0.001 * PI / 180.0 / 60.0, 10.0 * UG, 0.001 * DEG_PER_HOUR / 60.0);
    for (instrument, process, density) in [(Gyro, "white", n), (Accel, "white", v), (Gyro, "random_walk", k)]
    {
        let source = source(instrument, "bias", process, &[("density", density.into())]);
        let drift = drift(45.0, 1.0, 86_400.0, Spec::from_sources([source]).unwrap(), Vec::new());
        let scene = Scene::new(&drift, Some(600.0));
        let sigmas = Linear::single_axis(&scene).sigmas(&scene, &cases(&drift).swap_remove(0));
        for (step, s) in scene.rows.iter().zip(&sigmas).skip(1) {
            let t = scene.time(*step);
            for (axis, r) in [(0, scene.site.r_m), (1, scene.site.r_n)] {
                let w = (scene.site.g / r).sqrt();
                let (sin, sin2, cos) = ((w * t).sin(), (2.0 * w * t).sin(), (w * t).cos());
                let formula = match (instrument, process) {
                    (Gyro, "white") => n * r * (1.5 * t - 2.0 * sin / w + sin2 / (4.0 * w)).sqrt(),
                    (Accel, _) => v / w * (t / 2.0 - sin2 / (4.0 * w)).sqrt(),
                    _ => {
                        let cross = 2.0 * (w * t * cos - sin) / w.powi(3);
                        k * r * (t.powi(3) / 3.0 + cross + (t / 2.0 - sin2 / (4.0 * w)) / (w * w)).sqrt()
                    }
                };
                assert!(
                    (s.dr[axis] / formula - 1.0).abs() < 1e-8,
                    "{process} t {t}: {} {formula}",
                    s.dr[axis]
                );
            }
        }
    }
}

/// Standard deviations do not depend on the interval of the rows, however short the time constants are against it.
#[test]
fn sigmas_do_not_depend_on_the_rows() {
    use Instrument::{Accel, Gyro};
    let markov = |tau: f64| {
        source(Accel, "bias", "gauss_markov", &[("sigma", (50.0 * UG).into()), ("tau", tau.into())])
    };
    let flicker = source(
        Gyro,
        "bias",
        "flicker",
        &[
            ("instability", (0.01 * DEG_PER_HOUR).into()),
            ("tau_min", 10.0.into()),
            ("tau_max", 1000.0.into()),
        ],
    );
    for source in [markov(0.1), markov(1.0), markov(3.0), flicker] {
        for vertical in [Vertical::Held, Vertical::Damped(crate::scenario::Damping { order: 3, tau: 10.0 })] {
            let mut drift = drift(-75.0, 1.0, 6000.0, Spec::from_sources([source]).unwrap(), Vec::new());
            drift.mechanization.vertical = vertical;
            let [short, long] = [10.0, 3000.0].map(|every| {
                let scene = Scene::new(&drift, Some(every));
                *Linear::complete(&scene).sigmas(&scene, &cases(&drift)[0]).last().unwrap()
            });
            for (a, b) in short.as_array().iter().zip(long.as_array()) {
                assert!(
                    (a - b).abs() <= 1e-9 * a.abs(),
                    "{vertical:?} {}: {short:?} {long:?}",
                    source.name()
                );
            }
        }
    }
}

/// The same laws with the vertical channel damped and free: what the loop does is in both ways.
#[test]
fn ways_agree_with_the_vertical_channel_damped_and_free() {
    for (vertical, duration) in [
        (Vertical::Damped(crate::scenario::Damping { order: 2, tau: 100.0 }), 7200.0),
        (Vertical::Damped(crate::scenario::Damping { order: 3, tau: 100.0 }), 7200.0),
        (Vertical::Free, 1200.0),
    ] {
        let (spec, initial) = deterministic(0.1);
        let mut drift = drift(45.0, 100.0, duration, spec, initial);
        drift.mechanization.vertical = vertical;
        let (_, curves) = run(&drift, 60.0);
        for (name, x) in column(&curves, "half_linear") {
            assert!(x < 1e-5 || is_silent(&curves, &name), "{vertical:?} {name}: {x:e}");
        }
    }
}

/// A source that throws the navigator off the Earth is refused by name, not reported as agreement.
#[test]
fn a_run_without_numbers_is_an_error() {
    let spec = Spec::from_sources([source(Instrument::Gyro, "bias", "constant", &[("value", 1e300.into())])])
        .unwrap();
    let drift = drift(45.0, 1.0, 60.0, spec, Vec::new());
    let scene = Scene::new(&drift, Some(10.0));
    let case = cases(&drift).swap_remove(0);
    let error = curves(&scene, &drift, case, 1, &Context::silent()).err().expect("no numbers").to_string();
    assert!(error.contains("gyro.bias.constant.x"), "{error}");
}

/// The frames solve the same equations: whatever the frame and the number of samples in an update, errors grow alike, a
/// millimetre in 300 m, while the first-order update goes its own way.
#[test]
fn every_frame_drifts_alike() {
    let gyro = source(Instrument::Gyro, "bias", "constant", &[("value", (0.05 * DEG_PER_HOUR).into())]);
    let spec = Spec::from_sources([gyro]).unwrap();
    let end = |frame, coning| {
        let mut drift = drift(45.0, 12.0, 1200.0, spec.clone(), Vec::new());
        drift.mechanization = Mechanization { frame, coning, ..drift.mechanization };
        let scene = Scene::new(&drift, Some(600.0));
        let case = cases(&drift).pop().unwrap();
        *super::nonlinear::run(&scene, &case, 1.0, 7, |_, _| ()).unwrap().last().unwrap()
    };
    let t = end(Frame::T, Coning::One);
    assert!(t.dr.norm() > 300.0, "{t:?}");
    for frame in [Frame::T, Frame::Wander, Frame::E, Frame::I] {
        for coning in [Coning::One, Coning::Previous, Coning::Two, Coning::Three, Coning::Four] {
            let other = end(frame, coning);
            assert!((other.dr - t.dr).norm() < 1e-3, "{frame:?} {coning:?}: {other:?} {t:?}");
        }
    }
    let euler = end(Frame::Euler, Coning::One);
    let apart = (euler.dr - t.dr).norm();
    assert!((1e-3..1.0).contains(&apart), "{apart}");
}
