//! Closure: what `simulate` writes is navigated with the error model it was drawn from, and the errors are those that the
//! filter claims.

mod conditions;
mod offsets;
mod standstill;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use schuler_frames::{B, Euler, Geodetic, Rot, T, Vec3, with_position_error};
use schuler_imu::{Stream, random::Draws};
use schuler_strapdown::filter::chi_square;

use crate::record::{Cell, Folder, Table};
use crate::{Context, Error, Record, Scenario, Silent, run as run_study};

/// A flight with turns that begins on the move. The IMU has white noise and constant biases of a tactical grade.
const FLIGHT: &str = "
schuler: 1
study: simulate
title: A flight
start:
  position: { lat: 48 deg, lon: 11 deg, h: 800 m }
  attitude: { roll: 0 deg, pitch: 0 deg, yaw: 30 deg }
  velocity: { n: 51.961524227 m/s, e: 30 m/s, d: 0 m/s }
motion:
  segments:
    - straight: { duration: 10 s }
    - turn: { angle: 120 deg, bank: 25 deg, ramp: 4 s }
    - accelerate: { to: 80 m/s, duration: 20 s }
    - climb: { height: 100 m, angle: 5 deg, ramp: 4 s }
    - turn: { angle: -150 deg, bank: 20 deg, ramp: 4 s }
    - straight: { duration: 60 s }
gravity: normal
duration: 160 s
imu:
  rate: 100 Hz
  gyro:
    - bias: { white: { density: 0.1 deg/sqrt(h) } }
    - bias: { constant: { sigma: 5 deg/h } }
  accel:
    - bias: { white: { density: 100 ug/sqrt(Hz) } }
    - bias: { constant: { sigma: 1 mg } }
aiding:
  position: { rate: 1 Hz, sigma: [2 m, 2 m, 4 m], lever_arm: [1 m, 0.5 m, -1.5 m] }
  velocity: { rate: 1 Hz, sigma: 0.1 m/s, lever_arm: [1 m, 0.5 m, -1.5 m] }
  height: { rate: 2 Hz, sigma: 2 m, lever_arm: [1 m, 0.5 m, -1.5 m] }
  heading: { rate: 1 Hz, sigma: 0.5 deg }
output: { every: 1 s, formats: [csv], imu: increments }
";

const NAVIGATE: &str = "
schuler: 1
study: navigate
title: The flight with measurements
start:
  position: { lat: 48 deg, lon: 11 deg, h: 800 m }
  attitude: { roll: 0 deg, pitch: 0 deg, yaw: 30 deg }
  velocity: { n: 51.961524227 m/s, e: 30 m/s, d: 0 m/s }
log:
  file: imu.csv
  rate: 100 Hz
  content: increments
  columns:
    time: t_s
    gyro: [dtheta_x_rad, dtheta_y_rad, dtheta_z_rad]
    accel: [dv_x_mps, dv_y_mps, dv_z_mps]
  scale: { gyro: 1 rad, accel: 1 m/s }
mechanization: { frame: t, vertical: free, gravity: normal }
filter:
  gyro:
    - bias: { white: { density: 0.1 deg/sqrt(h) } }
    - bias: { constant: { sigma: 5 deg/h } }
  accel:
    - bias: { white: { density: 100 ug/sqrt(Hz) } }
    - bias: { constant: { sigma: 1 mg } }
  position: 5 m
  velocity: 0.5 m/s
  tilt: 0.5 deg
  heading: 1 deg
  measurements:
    position: { file: position.csv, lever_arm: [1 m, 0.5 m, -1.5 m] }
  reference: { file: truth.csv }
output: { every: 1 s, formats: [csv, svg] }
";

/// What a simulation wrote, in a folder that goes with it.
struct Data(PathBuf);

impl Data {
    /// The flight of that seed in a folder of its own.
    fn flight(name: &str, seed: u64) -> Data {
        Data::simulated(name, FLIGHT, &[&format!("seed={seed}")])
    }

    fn simulated(name: &str, text: &str, overrides: &[&str]) -> Data {
        let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
        // Tests side by side do not meet in the folder above it.
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let own = format!("schuler-aided-{name}-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(own).join("data");
        let scenario = load(text, &overrides);
        let record = run_study(&scenario, &Context { data: None, progress: &Silent }).unwrap();
        std::fs::create_dir_all(&folder).unwrap();
        Folder::check(&folder).and_then(|to| to.write(&record, scenario.output.formats)).unwrap();
        Data(folder)
    }

    /// Navigates with another scenario than that of the flight.
    fn navigate_as(&self, text: &str, overrides: &[&str]) -> Result<Record, Error> {
        let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
        let scenario = Scenario::load(Path::new("navigate.yaml"), text, &overrides)?;
        run_study(&scenario, &Context { data: Some(self.0.clone()), progress: &Silent })
    }

    fn navigate(&self, overrides: &[&str]) -> Result<Record, Error> {
        self.navigate_as(NAVIGATE, overrides)
    }

    /// Navigates from a start with errors drawn from the filter's own standard deviations.
    fn navigate_from_a_drawn_start(&self, seed: u64, overrides: &[&str]) -> Record {
        let draws = Draws::new(Stream { seed, run: 0 }, &"start");
        let vector = |step: u64, sigma: [f64; 3]| {
            let normals = draws.normals(step);
            Vec3::<T>::claim([0, 1, 2].map(|k| sigma[k] * normals[k]))
        };
        let degree = 1f64.to_radians();
        let (dr, dv) = (vector(0, [5.0; 3]), vector(1, [0.5; 3]));
        let phi = vector(2, [0.5 * degree, 0.5 * degree, degree]);
        let place = Geodetic::new(48.0 * degree, 11.0 * degree, 800.0);
        let p = with_position_error(place, dr);
        let v = Vec3::<T>::new(60.0 * (30.0 * degree).cos(), 30.0, 0.0) + dv;
        // The computed attitude is exp(-[phi x]) times the true one.
        let a = (Rot::<T, T>::from_rotation_vector(-phi)
            * Rot::<T, B>::from_euler(Euler::new(0.0, 0.0, 30.0 * degree)))
        .as_euler();
        let start = format!(
            "start={{ position: {{ lat: {} rad, lon: {} rad, h: {} m }}, velocity: {{ n: {} m/s, e: {} m/s, d: {} m/s }}, attitude: {{ roll: {} rad, pitch: {} rad, yaw: {} rad }} }}",
            p.lat, p.lon, p.h, v[0], v[1], v[2], a.roll, a.pitch, a.yaw
        );
        self.navigate(&[&[start.as_str()], overrides].concat()).unwrap()
    }
}

impl Drop for Data {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(self.0.parent().unwrap());
    }
}

fn load(text: &str, overrides: &[String]) -> Scenario {
    Scenario::load(Path::new("test.yaml"), text, overrides).unwrap_or_else(|e| panic!("{e}"))
}

fn table<'a>(record: &'a Record, name: &str) -> &'a Table {
    record.tables.iter().find(|table| table.name == name).unwrap()
}

fn numbers<'a>(record: &'a Record, name: &str, column: &str) -> &'a [f64] {
    table(record, name).numbers(column).unwrap()
}

/// A number of the row of `updates` of that kind.
fn update(record: &Record, source: &str, column: &str) -> f64 {
    let table = table(record, "updates");
    let row = (0..table.len()).find(|&row| table.columns[0].cell(row) == Cell::Word(source)).unwrap();
    table.numbers(column).unwrap()[row]
}

/// Error and standard deviation of every row, of the nine navigation errors.
fn errors(record: &Record) -> Vec<(f64, [f64; 9], [f64; 9])> {
    let table = table(record, "errors");
    let nine = |row: usize| {
        std::array::from_fn(|k| match table.columns[3 + k].cell(row) {
            Cell::Number(x) => x,
            Cell::Word(word) => panic!("{word}"),
        })
    };
    let times = table.numbers("t_s").unwrap();
    (0..table.len() / 2).map(|k| (times[2 * k], nine(2 * k), nine(2 * k + 1))).collect()
}

/// Bounds of the mean of `dof` squares of standard normals that hold with probability 1 - 2p.
fn band(dof: usize, p: f64) -> [f64; 2] {
    [1.0 - p, p].map(|p| chi_square::quantile(p, dof) / dof as f64)
}

fn assert_within(value: f64, [low, high]: [f64; 2], what: &str) {
    assert!((low..high).contains(&value), "{what}: {value}, not within {low} to {high}");
}

const SEEDS: u64 = 8;

#[test]
fn errors_are_those_that_the_filter_claims() {
    let mut nees = [0.0; 3];
    for seed in 1..=SEEDS {
        let record = Data::flight("nees", seed).navigate_from_a_drawn_start(seed, &[]);
        let (times, ratios) = (numbers(&record, "nees", "t_s"), numbers(&record, "nees", "nees_ratio"));
        for (sum, t) in nees.iter_mut().zip([20.0, 80.0, 160.0]) {
            let row = times.iter().position(|x| (x - t).abs() < 1e-9).unwrap();
            *sum += ratios[row] / SEEDS as f64;
        }
        let count = update(&record, "position", "rows_count");
        assert_eq!(count, 480.0);
        assert_within(update(&record, "position", "nis_ratio"), band(480, 1e-4), "NIS");
        // The lever arm and the turns make everything observable but for what the noise hides.
        let (_, error, sigma) = errors(&record).pop().unwrap();
        assert!(sigma[0] < 2.0 && sigma[8] < 0.3f64.to_radians(), "{sigma:?}");
        assert!((0..9).all(|k| error[k].abs() < 4.5 * sigma[k]), "{error:?} {sigma:?}");
    }
    for (nees, t) in nees.into_iter().zip([20, 80, 160]) {
        assert_within(nees, band(9 * SEEDS as usize, 1e-3), &format!("NEES at {t} s"));
    }
}

/// All four kinds at once, in both forms of the dynamics, with 21 states too.
#[test]
fn every_kind_of_log_is_consistent() {
    let data = Data::flight("kinds", 3);
    let all = "filter.measurements={ position: { file: position.csv, lever_arm: [1 m, 0.5 m, -1.5 m] }, velocity: { file: velocity.csv, lever_arm: [1 m, 0.5 m, -1.5 m] }, height: { file: height.csv, lever_arm: [1 m, 0.5 m, -1.5 m] }, heading: { file: heading.csv } }";
    let phi = data.navigate_from_a_drawn_start(3, &[all]);
    for (kind, rows) in [("position", 480.0), ("velocity", 480.0), ("height", 320.0), ("heading", 160.0)] {
        assert_eq!(update(&phi, kind, "rows_count"), rows, "{kind}");
        assert_within(update(&phi, kind, "nis_ratio"), band(rows as usize, 1e-4), kind);
    }
    for (t, error, sigma) in errors(&phi) {
        assert!((0..9).all(|k| error[k].abs() < 5.0 * sigma[k]), "{t}: {error:?} {sigma:?}");
    }
    let psi = data.navigate_from_a_drawn_start(3, &[all, "filter.form=psi"]);
    // The same filter in other states: what differs is of second order in the errors at the start.
    for ((_, a, sigma), (_, b, _)) in errors(&phi).into_iter().zip(errors(&psi)).skip(60) {
        assert!((0..9).all(|k| (a[k] - b[k]).abs() < 0.1 * sigma[k]), "{a:?} {b:?}");
    }
    assert_eq!(phi.figures.len(), 7);
}

#[test]
fn an_outage_lets_the_errors_grow_as_claimed() {
    let data = Data::flight("outage", 5);
    let record =
        data.navigate_from_a_drawn_start(5, &["filter.measurements.position.outages=[[80 s, 120 s]]"]);
    assert_eq!(update(&record, "position", "rows_count"), 360.0);
    let rows = errors(&record);
    let sigma = |t: f64| rows.iter().find(|row| (row.0 - t).abs() < 1e-9).unwrap().2;
    assert!(sigma(119.0)[0] > 3.0 * sigma(79.0)[0] && sigma(125.0)[0] < sigma(119.0)[0]);
    for (t, error, sigma) in &rows {
        assert!((0..9).all(|k| error[k].abs() < 5.0 * sigma[k]), "{t}: {error:?} {sigma:?}");
    }
}

/// Three fixes are moved by 200 m: with the gate they are refused and nothing else changes much; without it the errors leave
/// what the filter claims.
#[test]
fn outliers_are_refused_by_the_gate_alone() {
    let data = Data::flight("outliers", 7);
    let file = data.0.join("position.csv");
    let text = std::fs::read_to_string(&file).unwrap();
    let moved: Vec<String> = text
        .lines()
        .enumerate()
        .map(|(k, line)| match (k, line.split_once(',')) {
            (50 | 90 | 130, Some((t, rest))) => {
                let (lat, rest) = rest.split_once(',').unwrap();
                format!("{t},{},{rest}", lat.parse::<f64>().unwrap() + 200.0 / 6.37e6)
            }
            _ => line.into(),
        })
        .collect();
    std::fs::write(&file, moved.join("\n")).unwrap();
    let worst = |record: &Record| {
        let rows = errors(record).into_iter().skip(30);
        rows.map(|(_, error, sigma)| (error[0] / sigma[0]).abs()).fold(0.0, f64::max)
    };
    let gated = data.navigate_from_a_drawn_start(7, &["filter.gate=1e-4"]);
    assert_eq!(update(&gated, "position", "refused_count"), 9.0);
    assert!(worst(&gated) < 5.0, "{}", worst(&gated));
    let open = data.navigate_from_a_drawn_start(7, &[]);
    assert_eq!(update(&open, "position", "refused_count"), 0.0);
    assert!(worst(&open) > 20.0, "{}", worst(&open));
}

#[test]
fn what_does_not_fit_is_refused() {
    let data = Data::flight("refused", 1);
    let message = |overrides: &[&str]| data.navigate(overrides).map(drop).unwrap_err().to_string();
    for (override_, words) in [
        ("filter.measurements.position.offset=1000 s", "does not overlap with what is navigated"),
        ("filter.reference.offset=0.005 s", "the reference has no row at the time of any row"),
        ("filter.measurements.position.angle=200 deg", "a latitude beyond 90 deg"),
        ("filter.measurements.position.columns=[t_s, lat_rad, lon_rad]", "the list has 3 entries"),
        (
            "filter.measurements={ heading: { file: heading.csv, lever_arm: [1 m, 0 m, 0 m] } }",
            "a heading has no lever arm",
        ),
        ("filter.measurements={}", "a filter that measures nothing"),
        ("filter.measurements.position.file=none.csv", "the log none.csv is not there"),
        ("filter.gate=2", "no probability of refusing"),
        (
            "mechanization={ frame: e, vertical: free, gravity: normal }",
            "a filter goes with a navigator in frame `t`",
        ),
        (
            "mechanization={ frame: t, vertical: { damped: { order: 3, tau: 100 s } }, gravity: normal }",
            "damped",
        ),
        (
            "start={ position: { lat: 48 deg, lon: 11 deg, h: 800 m } }",
            "filter: the attitude at the start is not known",
        ),
        (
            "filter.measurements.zero_rate={ sigma: 1 deg/s, detect: { window: 5 ms, gyro: 1 deg/s, accel: 1 m/s^2 } }",
            "no window that shows a standstill",
        ),
        (
            "filter.measurements.non_holonomic={ sigma: 1 m/s, detect: { window: 1 s, gyro: 1 deg/s, accel: 1 m/s^2 } }",
            "`non_holonomic` holds at a standstill and on the way",
        ),
        (
            "filter.measurements={ velocity: { file: velocity.csv, format: kf_gins } }",
            "this format has no velocity",
        ),
        (
            "filter.measurements.position={ file: position.csv, format: kf_gins, angle: 1 deg }",
            "the format says what `angle` is",
        ),
    ] {
        let text = message(&[override_]);
        assert!(text.contains(words), "{override_}: {text}");
    }
    let file = data.0.join("position.csv");
    let text = std::fs::read_to_string(&file).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.swap(10, 11);
    std::fs::write(&file, lines.join("\n")).unwrap();
    assert!(message(&[]).contains("times do not increase"), "{}", message(&[]));
}
