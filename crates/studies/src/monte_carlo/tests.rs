//! Laws of the runs, and their figures against covariance and independent tables.

use schuler_frames::{Vec3, with_phi};
use schuler_imu::{Imu, Stream, random::Draws};
use schuler_strapdown::{Increments, LocalLevel, NavError};

use super::prediction::{Predicted, prediction};
use super::runs::{Chunk, runs};
use super::scene::Scene;
use super::statistics::{Statistics, verdict};
use crate::scenario::{MonteCarlo, RunFigure, Study};
use crate::{Record, Scenario, Silent, run};

const NOISES: &str = "
imu:
  rate: 20 Hz
  gyro:
    - bias: { white: { density: 0.1 deg/sqrt(h) } }
    - bias: { gauss_markov: { sigma: 1 deg/h, tau: 10 min } }
    - scale_factor: { constant: { sigma: 300 ppm } }
  accel:
    - bias: { random_walk: { density: 10 ug/sqrt(h) } }
    - bias: { constant: { sigma: 1 mg } }
";

const LEVEL: &str = "mechanization: { frame: t, vertical: held, gravity: somigliana }\nmotion: static\n";

const FLIGHT: &str = "
mechanization: { frame: t, vertical: { damped: { order: 2, tau: 100 s } }, gravity: normal }
motion: { segments: [accelerate: { to: 80 m/s, duration: 20 s }, turn: { angle: 90 deg, rate: 3 deg/s, ramp: 2 s }, straight: { duration: 100 s }] }
";

fn scenario(tail: &str) -> Scenario {
    let text = format!(
        "schuler: 1
study: monte_carlo
title: A test
start: {{ position: {{ lat: 45 deg, lon: 0 deg, h: 500 m }}, attitude: {{ roll: 0 deg, pitch: 0 deg, yaw: 30 deg }} }}
{tail}"
    );
    Scenario::load("test.yaml", &text, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn study(scenario: &Scenario) -> &MonteCarlo {
    match &scenario.study {
        Study::MonteCarlo(study) => study,
        _ => unreachable!("a Monte Carlo"),
    }
}

fn in_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

const SIGMAS: &str =
    "initial_sigmas: { tilt: [1 arcmin, 1 arcmin], heading: 0.1 deg, velocity: [0.1 m/s, 0.1 m/s, 0 m/s] }";

/// In lanes or alone, in a chunk of any place: the errors of a run are those of one navigator with one instrument.
#[test]
fn a_run_is_one_navigator_with_one_instrument() {
    for motion in [LEVEL, FLIGHT] {
        let text = format!(
            "{motion}{NOISES}monte_carlo: {{ runs: 100, {SIGMAS} }}\nduration: 130 s\noutput: {{ every: 6.65 s }}\nseed: 9\n"
        );
        let scenario = scenario(&text);
        let scene = Scene::new(&scenario, study(&scenario));
        let rows = scene.rows.len();
        let chunk = runs(&scene, 5, 18, &Silent).unwrap();
        assert_eq!(chunk.errors.len(), 13 * rows);
        for (run, found) in (5..18).zip(chunk.runs(rows)) {
            let stream = Stream { seed: 9, run };
            let mut imu = Imu::new(&scene.study.imu.spec, stream).unwrap();
            let draw = |name: &str| Draws::new(stream, &name).normals(0)[0];
            let arcmin = 1f64.to_radians() / 60.0;
            let mut start = scene.states[0];
            let phi = [
                arcmin * draw("initial.tilt.n"),
                arcmin * draw("initial.tilt.e"),
                0.1f64.to_radians() * draw("initial.heading.d"),
            ];
            start.c_tb = with_phi(start.c_tb, Vec3::claim(phi));
            start.v_t += Vec3::new(0.1 * draw("initial.velocity.n"), 0.1 * draw("initial.velocity.e"), 0.0);
            let mut navigator = LocalLevel::new(&start, scene.study.mechanization.gravity, scene.vertical);
            let mut sample = 0;
            for (row, (&end, truth)) in scene.rows.iter().zip(&scene.states).enumerate() {
                while sample < end {
                    let measured = imu.step(scene.dt, &scene.seen(sample, 1));
                    let increments =
                        Increments { dtheta: Vec3::claim(measured.dtheta), dv: Vec3::claim(measured.dv) };
                    navigator.step(&increments, scene.dt);
                    sample += 1;
                }
                // Sums of initial errors are formed in another order here.
                let expected = NavError::between(&navigator.pva(), truth).as_array();
                assert_eq!(found[row].map(f64::to_bits), expected.map(f64::to_bits), "run {run}, row {row}");
            }
        }
    }
}

/// The place of a run in a chunk, and the way it is stepped (lanes, or alone as other frames ask for), change nothing.
#[test]
fn runs_do_not_depend_on_their_chunk() {
    let text = |frame: &str| {
        let level = LEVEL.replace("frame: t", &format!("frame: {frame}"));
        format!(
            "{level}{NOISES}monte_carlo: {{ runs: 100, {SIGMAS} }}\nduration: 60 s\noutput: {{ every: 10 s }}\n"
        )
    };
    for frame in ["t", "wander"] {
        let scenario = scenario(&text(frame));
        let scene = Scene::new(&scenario, study(&scenario));
        let whole = runs(&scene, 0, 40, &Silent).unwrap();
        let parts: Vec<Chunk> = [(0, 3), (3, 20), (20, 40)]
            .into_iter()
            .map(|(a, b)| runs(&scene, a, b, &Silent).unwrap())
            .collect();
        let joined: Vec<[f64; 9]> = parts.iter().flat_map(|chunk| chunk.errors.clone()).collect();
        assert_eq!(whole.errors, joined, "{frame}");
    }
}

/// What cannot be is told with its place.
#[test]
fn scenarios_that_make_no_sense_are_told() {
    let tail = |block: &str, every: &str| {
        format!("{LEVEL}{NOISES}monte_carlo: {block}\nduration: 60 s\noutput: {{ every: {every} }}\n")
    };
    let fault = |block: &str, every: &str| {
        let text = format!(
            "schuler: 1\nstudy: monte_carlo\ntitle: T\nstart: {{ position: {{ lat: 45 deg, lon: 0 deg, h: 0 m }} }}\n{}",
            tail(block, every)
        );
        Scenario::load("test.yaml", &text, &[]).unwrap_err().to_string()
    };
    for (block, every, message) in [
        ("{ runs: 1 }", "60 s", "monte_carlo.runs: no such number of runs"),
        ("{ runs: 10 }", "50 ms", "output.every: too many rows"),
        ("{ runs: 10, initial_sigmas: { heading: -1 deg } }", "60 s", "must not be negative"),
        (
            "{ runs: 10, thresholds: [{ name: a, quantity: horizontl_m, limit: 1 m }] }",
            "60 s",
            "did you mean `horizontal_m`?",
        ),
        ("{ runs: 10, thresholds: [{ name: a, quantity: dn_m, limit: 1 deg }] }", "60 s", "wrong dimension"),
        (
            "{ runs: 10, thresholds: [{ name: a, quantity: dn_m, limit: 1 m }, { name: a, quantity: de_m, limit: 1 m }] }",
            "60 s",
            "two thresholds of one name",
        ),
        (
            "{ runs: 10, until: { quantity: dn_m, way: mean, at: 60 s, relative: 5 % } }",
            "60 s",
            "unknown way `mean`",
        ),
        (
            "{ runs: 10, until: { quantity: dn_m, way: sd, at: 61 s, relative: 5 % } }",
            "10 s",
            "no row at this time",
        ),
        (
            "{ runs: 10, until: { quantity: dn_m, way: sd, at: 60 s, relative: 0 % } }",
            "10 s",
            "more than zero",
        ),
    ] {
        let found = fault(block, every);
        assert!(found.contains(message), "{block}: {found}");
    }
}

/// A run that is replayed by its number has the errors that it had among all.
#[test]
fn a_replay_is_the_run_itself() {
    let text = format!(
        "{FLIGHT}{NOISES}monte_carlo: {{ runs: 20, {SIGMAS} }}\nduration: 130 s\noutput: {{ every: 10 s }}\n"
    );
    let scenario = scenario(&text);
    let scene = Scene::new(&scenario, study(&scenario));
    let all = runs(&scene, 0, 20, &Silent).unwrap();
    let record = super::replay(&scenario, scene.study, 17, &crate::Context::silent()).unwrap();
    let (table, rows) = (&record.tables[0], scene.rows.len());
    assert_eq!(table.len(), 2601);
    for (row, &sample) in scene.rows.iter().enumerate() {
        for (k, name) in crate::record::columns::ERRORS[3..].iter().enumerate() {
            let found = table.numbers(name).unwrap()[sample as usize];
            assert_eq!(found.to_bits(), all.errors[17 * rows + row][k].to_bits(), "{name}, row {row}");
        }
    }
    assert!(super::replay(&scenario, scene.study, 20, &crate::Context::silent()).is_err());
}

/// Runs end at the first milestone at which the interval is narrow enough, and not before.
#[test]
fn runs_end_when_a_figure_is_known() {
    // Half the 99 % interval of a standard deviation is 2.58/√(2 n): below 12 % from 230 runs on, so at 256.
    let until = "until: { quantity: horizontal_m, way: sd, at: 60 s, relative: 12 % }";
    let one = until.replace("horizontal_m", "dn_m");
    // Two variances alike count twice: from 115 runs on, so at 128.
    for (until, expected) in [(until, "after 128 of"), (&one, "after 256 of")] {
        let text = format!(
            "{LEVEL}{NOISES}monte_carlo: {{ runs: 600, {until} }}\nduration: 60 s\noutput: {{ every: 60 s }}\n"
        );
        let record = run(&scenario(&text), &crate::Context::silent()).unwrap();
        assert!(record.notes.iter().any(|note| note.contains(expected)), "{:?}", record.notes);
    }
}

fn bytes(record: &Record) -> Vec<u8> {
    let mut all = Vec::new();
    record.tables.iter().for_each(|table| table.write_csv(&mut all).unwrap());
    all.extend(record.summary_json(&[]).into_bytes());
    for (_, figure) in &record.figures {
        all.extend(figure.to_svg().unwrap().into_bytes());
    }
    all
}

#[test]
fn one_thread_or_two_give_the_same_bytes() {
    let text = format!(
        "{FLIGHT}{NOISES}monte_carlo: {{ runs: 150, {SIGMAS}, thresholds: [{{ name: far, quantity: dn_m, limit: 100 m }}] }}\nduration: 130 s\noutput: {{ every: 10 s, formats: [csv, svg] }}\n"
    );
    let scenario = scenario(&text);
    let [one, two] = [1, 2]
        .map(|threads| in_threads(threads, || bytes(&run(&scenario, &crate::Context::silent()).unwrap())));
    assert!(one == two && one.len() > 10_000);
}

/// Statistics of the runs of a scene beside its prediction.
fn found<'a>(scene: &Scene<'a>, predicted: &[Predicted]) -> Statistics<'a> {
    let mut statistics = Statistics::new(scene.rows.len(), Some(predicted), &scene.study.thresholds);
    let chunk = runs(scene, 0, scene.study.runs, &Silent).unwrap();
    statistics.add(&chunk.errors);
    statistics
}

/// Every sampled variance within the chi-square band that one in a hundred thousand leaves (the 99 % band, widened because
/// many are judged at once), at rest and along a flight, and NEES within the band of its own.
#[test]
fn runs_meet_the_covariance() {
    for (motion, duration) in [(LEVEL, "30 min"), (FLIGHT, "130 s")] {
        let text = format!(
            "{motion}{NOISES}monte_carlo: {{ runs: 600, {SIGMAS} }}\nduration: {duration}\noutput: {{ every: 65 s }}\n"
        );
        let scenario = scenario(&text);
        let scene = Scene::new(&scenario, study(&scenario));
        let predicted = prediction(&scene).unwrap();
        let statistics = found(&scene, &predicted);
        let (mut judged, mut outside) = (0, 0);
        for (row, p) in predicted.iter().enumerate() {
            for k in 0..10 {
                let Some(verdict) = verdict(&statistics, row, k, p) else { continue };
                let half = 0.5 * (verdict.high - verdict.low);
                assert!((verdict.ratio - 1.0).abs() < 1.75 * half, "{motion} row {row}, {k}: {verdict:?}");
                judged += 1;
                outside += usize::from(!verdict.holds());
            }
            let (nees, freedom) = statistics.nees(row).unwrap();
            assert!(
                (nees.value - 1.0).abs() < 0.9 * (nees.high - nees.low),
                "row {row}: {nees:?}, {freedom}"
            );
        }
        assert!(judged > 20 && outside * 10 < judged, "{outside} of {judged}");
    }
}

/// A value that is fixed moves the mean, and what scatters does so about it.
#[test]
fn fixed_values_move_the_mean() {
    let text = format!(
        "{LEVEL}imu: {{ rate: 10 Hz, gyro: [{{ bias: {{ constant: {{ value: [0 deg/h, 1 deg/h, 0 deg/h] }} }} }}, {{ bias: {{ white: {{ density: 0.01 deg/sqrt(h) }} }} }}] }}
monte_carlo: {{ runs: 64 }}
duration: 10 min
output: {{ every: 10 min }}
"
    );
    let scenario = scenario(&text);
    let scene = Scene::new(&scenario, study(&scenario));
    let predicted = prediction(&scene).unwrap();
    let statistics = found(&scene, &predicted);
    for k in [0, 1, 3, 4, 6, 7, 8] {
        let (mean, p) = (statistics.mean(1, k), &predicted[1]);
        assert!((mean.low..=mean.high).contains(&p.mean(k)), "{k}: {mean:?}, {}", p.mean(k));
    }
    // g eps t³/6 of the y axis, which points 30 deg east of north-to-east: 16.64 m for 0.01 deg/h at 10 min, times 100.
    let along = predicted[1].mean(0).hypot(predicted[1].mean(1));
    assert!((along / 1664.0 - 1.0).abs() < 0.01, "{along}");
}

/// Sampled against a table of an independent Van Loan computation: root mean squares within 4.5 sigma, and the prediction
/// to its digits.
#[test]
fn noise_growth_meets_the_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/static_theory/noise_rms.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let cases = [
        ("ARW_all", "gyro: [bias: { white: { density: 0.001 deg/sqrt(h) } }]"),
        ("VRW_N", "accel: [bias: { white: { density: [10 ug/sqrt(Hz), 0 ug/sqrt(Hz), 0 ug/sqrt(Hz)] } }]"),
        ("RRW_all", "gyro: [bias: { random_walk: { density: 0.001 deg/h/sqrt(h) } }]"),
        ("GMg_all_1h", "gyro: [bias: { gauss_markov: { sigma: 0.01 deg/h, tau: 1 h } }]"),
        ("GMa_all_100s", "accel: [bias: { gauss_markov: { sigma: 50 ug, tau: 100 s } }]"),
    ];
    let mut compared = 0;
    for (case, imu) in cases {
        let tail = format!(
            "{LEVEL}imu: {{ rate: 1 Hz, {imu} }}\nmonte_carlo: {{ runs: 400 }}\nduration: 3600 s\noutput: {{ every: 60 s }}\n"
        );
        let scenario = scenario(&tail.replace("h: 500 m", "h: 0 m"));
        let mut study = study(&scenario).clone();
        study.start.position.h = 0.0;
        study.start.attitude = Default::default();
        let scene = Scene::new(&scenario, &study);
        let predicted = prediction(&scene).unwrap();
        let statistics = found(&scene, &predicted);
        for line in text.lines().filter(|line| line.starts_with(&format!("45,{case},"))) {
            let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect();
            let row = (fields[2] / 60.0) as usize;
            if row >= scene.rows.len() {
                continue;
            }
            for (column, k) in [3, 4, 6, 7, 8, 0, 1].into_iter().enumerate() {
                let unit = if (6..9).contains(&k) { 1f64.to_radians() / 60.0 } else { 1.0 };
                let expected = fields[3 + column] * unit;
                let p = predicted[row].sd(k);
                assert!((p - expected).abs() <= 1e-8 * expected, "{line}: error {k}: predicted {p}");
                if expected > 0.0 {
                    let found = statistics.figure(row, k, RunFigure::Rms).value;
                    let sigmas = (found / expected - 1.0) * (2.0 * 400f64).sqrt();
                    assert!(sigmas.abs() < 4.5, "{line}: error {k}: {found}, {sigmas} sigmas");
                }
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 5 * 3 * 7);
}
