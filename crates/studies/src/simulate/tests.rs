use schuler_frames::{Euler, Rot};

use super::run;
use crate::{
    Context, Record, Scenario, Silent,
    scenario::{Simulate, Study},
};

const DRIVE: &str = "
schuler: 1
study: simulate
title: A drive & a <turn>
start:
  position: { lat: 48 deg, lon: 11 deg, h: 500 m }
  attitude: { roll: 0 deg, pitch: 0 deg, yaw: 30 deg }
motion:
  segments:
    - stand: { duration: 10 s }
    - accelerate: { to: 20 m/s, duration: 10 s }
    - turn: { angle: 90 deg, radius: 100 m, flat: true }
    - straight: { distance: 400 m }
    - accelerate: { to: 0 m/s, duration: 10 s }
gravity: normal
imu:
  rate: 100 Hz
  gyro: [{ bias: { constant: { value: 1 deg/h } } }]
aiding:
  position: { rate: 1 Hz, sigma: [1 m, 2 m, 3 m], lever_arm: [1 m, 0 m, -2 m], outages: [[20 s, 30 s]] }
  velocity: { rate: 5 Hz, sigma: 0.1 m/s, lever_arm: [1 m, 0 m, -2 m] }
  height: { rate: 10 Hz, sigma: 0 m }
  heading: { rate: 2 Hz, sigma: 1 deg }
output: { every: 1 s, formats: [csv], imu: increments }
seed: 5
";

fn load(text: &str) -> Scenario {
    Scenario::load("a.yaml", text, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn study(scenario: &Scenario) -> &Simulate {
    match &scenario.study {
        Study::Simulate(study) => study,
        _ => panic!("a simulate study"),
    }
}

fn record(text: &str) -> Record {
    let scenario = load(text);
    run(&scenario, study(&scenario), &Context { data: None, progress: &Silent }).expect("runs")
}

fn column<'a>(record: &'a Record, table: &str, column: &str) -> &'a [f64] {
    let table = record.tables.iter().find(|t| t.name == table).expect("a table");
    table.numbers(column).expect("a column")
}

/// 10 s of standing, 10 s to 20 m/s, a right angle by 100 m at 20 m/s with 2 s of ramp, 20 s, 10 s.
#[test]
fn the_motion_sets_the_duration() {
    let record = record(DRIVE);
    let turn = 0.5 * std::f64::consts::PI / 0.2 + 2.0;
    let samples = ((50.0 + turn) * 100.0).floor(); // 5985
    for table in ["imu", "imu_ideal"] {
        let t = column(&record, table, "t_s");
        assert_eq!((t.len() as f64, *t.last().expect("rows")), (samples, samples / 100.0));
    }
    // Every second, the start and the end.
    assert_eq!(column(&record, "truth", "t_s").len(), 61);
    let yaw = column(&record, "truth", "yaw_rad");
    assert!((yaw[0] - 30f64.to_radians()).abs() < 1e-15);
    assert!((yaw[60] - 120f64.to_radians()).abs() < 1e-15);
}

/// What is wrong with the corrupted log is the IMU's error list and nothing else.
#[test]
fn logs_differ_by_the_errors() {
    let record = record(DRIVE);
    let bias = 1f64.to_radians() / 3600.0 * 0.01;
    for axis in ["x", "y", "z"] {
        let name = format!("dtheta_{axis}_rad");
        let pairs = column(&record, "imu", &name).iter().zip(column(&record, "imu_ideal", &name));
        assert!(pairs.into_iter().all(|(measured, ideal)| (measured - ideal - bias).abs() < 1e-17));
        let name = format!("dv_{axis}_mps");
        assert_eq!(column(&record, "imu", &name), column(&record, "imu_ideal", &name));
    }
}

/// Measurements come at their rate but in outages, and differ from the truth by lever arm and noise.
#[test]
fn aiding_is_truth_lever_arm_and_noise() {
    let record = record(DRIVE);
    let t = column(&record, "position", "t_s");
    let expected: Vec<f64> =
        (1..=59).map(f64::from).filter(|t| !(20.0..30.0).contains(t) && *t < 59.8).collect();
    assert_eq!(t, expected);
    // At rest: the antenna stands 1 m along heading 30 deg and 2 m above.
    let scenario = load(DRIVE);
    let start = study(&scenario).start.position;
    let c_tb = Rot::from_euler(Euler::new(0.0, 0.0, 30f64.to_radians()));
    let arm: schuler_frames::Vec3<schuler_frames::T> =
        c_tb * schuler_frames::Vec3::<schuler_frames::B>::new(1.0, 0.0, -2.0);
    let position = |k: usize| {
        let [lat, lon, h] = ["lat_rad", "lon_rad", "h_m"].map(|name| column(&record, "position", name)[k]);
        start.local_ned(schuler_frames::Geodetic::new(lat, lon, h).as_ecef()) - arm
    };
    for k in 0..9 {
        let noise = position(k);
        for (axis, sigma) in [1.0, 2.0, 3.0].into_iter().enumerate() {
            assert!(noise[axis] != 0.0 && noise[axis].abs() < 5.0 * sigma, "{noise:?}");
        }
    }
    // No noise, no difference.
    let heights = column(&record, "height", "h_m");
    assert!(heights.iter().all(|h| (h - 500.0).abs() < 1e-3));
    // 0.1 m/s in the spread of 5 x 10 measurements at rest, three axes: within 5 sigma of its estimate.
    let speeds = ["v_n_mps", "v_e_mps", "v_d_mps"].map(|name| &column(&record, "velocity", name)[..49]);
    let mean_square = speeds.iter().copied().flatten().map(|v| v * v).sum::<f64>() / 147.0;
    assert!((mean_square / 0.01 - 1.0).abs() < 5.0 * (2f64 / 147.0).sqrt(), "{mean_square}");
}

/// Maps get degrees and the title as it is.
#[test]
fn tracks_for_maps() {
    let record = record(DRIVE);
    let text = |name: &str| &record.texts.iter().find(|(file, _)| file == name).expect("a text").1;
    assert!(text("track.kml").contains("<name>A drive &amp; a &lt;turn&gt;</name>"));
    assert!(text("track.kml").contains("\n11.00000000,48.00000000,500.000\n"));
    let json: serde_json::Value = serde_json::from_str(text("track.geojson")).expect("JSON");
    assert_eq!(json["properties"]["name"], "A drive & a <turn>");
    assert_eq!(json["geometry"]["coordinates"].as_array().map(Vec::len), Some(61));
}

/// A log that is written is a log that can be read and navigated: at rest the error-free IMU stays where it was.
#[test]
fn navigate_reads_what_simulate_writes() {
    let folder = std::env::temp_dir().join(format!("schuler-simulate-{}", std::process::id()));
    let simulate = "
schuler: 1
study: simulate
title: Mooring
start: { position: { lat: 48 deg, lon: 11 deg, h: 500 m }, attitude: { roll: 1 deg, pitch: 2 deg, yaw: 30 deg } }
motion: static
gravity: somigliana
duration: 900 s
imu: { rate: 50 Hz }
output: { every: 10 s, formats: [csv], imu: increments }
";
    let written = record(simulate);
    crate::record::Folder::check(&folder)
        .and_then(|to| to.write(&written, load(simulate).output.formats))
        .expect("written");
    let navigate = "
schuler: 1
study: navigate
title: Mooring
start: { position: { lat: 48 deg, lon: 11 deg, h: 500 m } }
log:
  file: imu.csv
  rate: 50 Hz
  content: increments
  columns:
    time: t_s
    gyro: [dtheta_x_rad, dtheta_y_rad, dtheta_z_rad]
    accel: [dv_x_mps, dv_y_mps, dv_z_mps]
  scale: { gyro: 1 rad, accel: 1 m/s }
  stationary: true
align: { method: triad, window: [0 s, 300 s] }
mechanization: { frame: t, vertical: held, gravity: somigliana }
output: { every: 10 s, formats: [csv] }
expect:
  - { quantity: dn_m, at: largest, value: 0 m, tolerance: 1 mm }
  - { quantity: de_m, at: largest, value: 0 m, tolerance: 1 mm }
  - { quantity: yaw_rad, at: final, value: 30 deg, tolerance: 1e-6 deg }
";
    let scenario = load(navigate);
    let found =
        crate::run(&scenario, &Context { data: Some(folder.clone()), progress: &Silent }).expect("runs");
    let _ = std::fs::remove_dir_all(&folder);
    assert!(found.holds() && found.verdicts.len() == 3, "{:?}", found.verdicts);
}

/// Each kind of motion can be written, runs, and starts where the scenario says.
#[test]
fn every_kind_runs() {
    let kinds = [
        ("static", ""),
        (
            "{ sway: { roll: { amplitude: 2 deg, period: 8 s }, n: [{ amplitude: 1 m, frequency: 0.1 Hz }] } }",
            "",
        ),
        ("{ rate_table: { rate: 10 deg/s, tilt: 0 deg } }", ""),
        (
            "{ positions: { rate: 20 deg/s, poses: [{ yaw: 40 deg, dwell: 10 s }, { yaw: 220 deg, dwell: 30 s }] } }",
            "",
        ),
        ("{ sculling: { angle: 1 deg, acceleration: 1 g, frequency: 2 Hz } }", ""),
        (
            "{ segments: [{ accelerate: { to: 30 m/s, duration: 10 s } }, { climb: { height: 20 m, angle: 5 deg } }, { straight: { duration: 30 s } }] }",
            "",
        ),
        (
            "{ segments: [{ s_turn: { angle: 30 deg, bank: 20 deg } }, { figure_of_eight: { rate: 20 deg/s } }] }",
            "n: 30 m/s, e: 40 m/s, d: 0 m/s",
        ),
        ("{ segments: [{ roll: { to: 30 deg, duration: 30 s } }] }", "n: 30 m/s, e: 40 m/s, d: 0 m/s"),
        ("constant_velocity", "n: 30 m/s, e: 40 m/s, d: 0 m/s"),
        (
            "{ waypoints: { points: [{ lat: 48.02 deg, lon: 11.01 deg, speed: 60 m/s }, { lat: 48.03 deg, lon: 11 deg, h: 600 m, time: 90 s }] } }",
            "",
        ),
        ("{ great_circle: { speed: 250 m/s, heading: 30 deg } }", ""),
        ("{ great_circle: { speed: 250 m/s, to: [60 deg, -30 deg] } }", ""),
        (
            "{ shaken: { motion: static, roll: { amplitude: 1 mrad, frequency: 2 Hz }, x: { amplitude: 1 mm, frequency: 3 Hz } } }",
            "",
        ),
    ];
    for (motion, velocity) in kinds {
        let velocity = match velocity {
            "" => String::new(),
            velocity => format!(", velocity: {{ {velocity} }}"),
        };
        let text = format!(
            "
schuler: 1
study: simulate
title: A kind
start: {{ position: {{ lat: 48 deg, lon: 11 deg, h: 500 m }}{velocity} }}
motion: {motion}
gravity: normal
duration: 20 s
imu: {{ rate: 50 Hz }}
output: {{ formats: [csv] }}
"
        );
        let record = record(&text);
        assert_eq!(column(&record, "truth", "t_s").len(), 1001, "{motion}");
        assert!((column(&record, "truth", "lat_rad")[0].to_degrees() - 48.0).abs() < 1e-12, "{motion}");
        assert!((column(&record, "truth", "h_m")[0] - 500.0).abs() < 1e-8, "{motion}");
        if !velocity.is_empty() {
            assert!((column(&record, "truth", "v_n_mps")[0] - 30.0).abs() < 1e-12, "{motion}");
        }
        let f = column(&record, "imu", "f_z_mps2");
        assert!(f.iter().all(|f| f.is_finite()), "{motion}");
    }
}

/// What `simulate` wrote as truth can be simulated again: the same positions to what the splines leave.
#[test]
fn a_recorded_truth_is_a_motion() {
    let folder = std::env::temp_dir().join(format!("schuler-recorded-{}", std::process::id()));
    let first = DRIVE.replace("every: 1 s", "every: 0.1 s");
    let written = record(&first);
    crate::record::Folder::check(&folder)
        .and_then(|to| to.write(&written, load(&first).output.formats))
        .expect("written");
    let again = "
schuler: 1
study: simulate
title: Again
start: { position: { lat: 0 deg, lon: 0 deg, h: 0 m } }
motion: { file: { file: truth.csv, knots: 0.5 s } }
gravity: normal
duration: 59 s
imu: { rate: 100 Hz }
output: { every: 0.1 s, formats: [csv] }
";
    let scenario = load(again);
    let context = Context { data: Some(folder.clone()), progress: &Silent };
    let second = run(&scenario, study(&scenario), &context).expect("runs");
    for (name, tolerance) in [("lat_rad", 1e-9), ("lon_rad", 1e-9), ("h_m", 1e-6), ("yaw_rad", 1e-3)] {
        let pairs = column(&written, "truth", name).iter().zip(column(&second, "truth", name));
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < tolerance, "{name}: {apart:e}");
    }
    assert!(second.notes.iter().any(|note| note.contains("splines")), "{:?}", second.notes);

    // What is wrong with it is said with its place.
    for (from, to, words) in [
        ("truth.csv", "nothing.csv", "is not there"),
        (
            "knots: 0.5 s",
            "knots: 0.5 s, columns: [t, lat_rad, lon_rad, h_m, roll_rad, pitch_rad, yaw_rad]",
            "no such column",
        ),
        ("knots: 0.5 s", "knots: 0.05 s", "gap"),
        ("duration: 59 s", "duration: 61 s", "ends before"),
    ] {
        let scenario = load(&again.replace(from, to));
        let fault = run(&scenario, study(&scenario), &context).expect_err(words).to_string();
        assert!(fault.contains(words), "{fault}");
    }
    let _ = std::fs::remove_dir_all(&folder);
}
