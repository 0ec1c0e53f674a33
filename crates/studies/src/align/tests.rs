//! Align studies against tables, laws and each other.

use crate::record::Cell;
use crate::{Context, Record, Scenario, run};

const HEAD: &str = "\
schuler: 1
study: align
title: A test
start: { position: { lat: 45 deg, lon: 0 deg, h: 0 m } }
motion: static
mechanization: { frame: t, vertical: held, gravity: somigliana }
";

fn record(tail: &str) -> Record {
    let text = format!("{HEAD}{tail}");
    let scenario = Scenario::load("test.yaml", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
    run(&scenario, &Context::silent()).unwrap_or_else(|e| panic!("{e}"))
}

/// The last row of `errors` of that source and way: time and the nine errors.
fn last(record: &Record, source: &str, way: &str) -> (f64, [f64; 9]) {
    let table = record.tables.iter().find(|t| t.name == "errors").unwrap();
    let is = |row: usize, column: usize, word: &str| table.columns[column].cell(row) == Cell::Word(word);
    let row = (0..table.len()).rev().find(|&row| is(row, 1, source) && is(row, 2, way)).unwrap();
    let number = |column: usize| match table.columns[column].cell(row) {
        Cell::Number(x) => x,
        Cell::Word(_) => panic!("a word"),
    };
    (number(0), std::array::from_fn(|k| number(3 + k)))
}

/// tests/data/static_theory/nl_posttriad_*.csv: a day of navigation after TRIAD with the same constant errors, by a
/// quad-precision mechanization.
#[test]
fn navigation_after_alignment_agrees_with_the_tables() {
    let cases = [
        ("gyroE", "[0 deg/h, 0.01 deg/h, 0 deg/h]", "[0 ug, 0 ug, 0 ug]"),
        ("accE", "[0 deg/h, 0 deg/h, 0 deg/h]", "[0 ug, 100 ug, 0 ug]"),
        ("accN", "[0 deg/h, 0 deg/h, 0 deg/h]", "[100 ug, 0 ug, 0 ug]"),
        ("mix", "[0.01 deg/h, -0.01 deg/h, 0.005 deg/h]", "[100 ug, -50 ug, 30 ug]"),
    ];
    for (name, gyro, accel) in cases {
        let record = record(&format!(
            "duration: 10 s
imu:
  rate: 100 Hz
  gyro: [bias: {{ constant: {{ value: {gyro} }} }}]
  accel: [bias: {{ constant: {{ value: {accel} }} }}]
alignment: {{ methods: [triad: {{}}], navigate: 24 h }}
output: {{ every: 10 s, formats: [csv] }}
"
        ));
        let (t, found) = last(&record, "triad", "run");
        assert_eq!(t, 86_410.0);
        let path =
            format!("{}/../../tests/data/static_theory/nl_posttriad_{name}.csv", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        let row: Vec<f64> = text.lines().last().unwrap().split(',').map(|x| x.parse().unwrap()).collect();
        let (s, c) = 45f64.to_radians().sin_cos();
        let north = row[6] * schuler_frames::wgs84::r_m(s);
        let east = row[7] * schuler_frames::wgs84::r_n(s) * c;
        assert!((found[0] - north).abs() < 1e-3, "{name}: {} {north}", found[0]);
        assert!((found[1] - east).abs() < 1e-3, "{name}: {} {east}", found[1]);
        for axis in 0..3 {
            assert!((found[6 + axis] - row[3 + axis]).abs() < 1e-9, "{name}: {found:?}");
        }
    }
}

const NOISY: &str = "\
duration: 60 s
imu:
  rate: 10 Hz
  gyro:
    - bias: { constant: { sigma: 0.01 deg/h } }
    - bias: { white: { density: 0.003 deg/sqrt(h) } }
  accel:
    - bias: { constant: { sigma: 50 ug } }
alignment:
  coarse: { sigma: { tilt: 0.1 deg, heading: 1 deg } }
  velocity: { every: 1 s, noise: 0.02 m/s, coloured: { sigma: 0.01 m/s, tau: 10 s }, burst: { window: [20 s, 30 s], factor: 3 } }
  knock: { at: 30 s, tilt: [0.02 deg, 0.02 deg], heading: 0.5 deg }
  filter: { gyro: [bias: { constant: { sigma: 0.01 deg/h } }], accel: [], form: FORM }
  methods: [{ filter: {} }, { inertial: { solution: optimal, latitude: unknown } }, { gyrocompass: { tau: 20 s } }]
  runs: 17
  navigate: 10 s
output: { every: 5 s, formats: [csv] }
";

/// Runs are pure functions of their number: how many threads share them changes no bit.
#[test]
fn threads_change_nothing() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| record(&NOISY.replace("FORM", "phi")).tables)
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(format!("{one:?}"), format!("{three:?}"));
}

/// At a place that is known, errors against the true and against the computed frame are the same, up to the way dr/R that
/// a filter without position leaves out.
#[test]
fn both_forms_give_the_same_alignment() {
    let phi = last(&record(&NOISY.replace("FORM", "phi")), "filter", "rms").1;
    let psi = last(&record(&NOISY.replace("FORM", "psi")), "filter", "rms").1;
    for (a, b) in phi.iter().zip(psi) {
        assert!((a - b).abs() <= 1e-3 * a.abs(), "{phi:?} {psi:?}");
    }
}

/// An instrument whose errors are larger than the Earth rate gets an answer, and no number for its heading.
#[test]
fn where_heading_cannot_be_had_it_is_said() {
    let coarse = |position: &str, bias: &str| {
        let text = HEAD.replace("lat: 45 deg", position)
            + &format!(
                "duration: 60 s
imu: {{ rate: 10 Hz, gyro: [bias: {{ constant: {{ sigma: {bias} }} }}], accel: [] }}
alignment: {{ methods: [{{ triad: {{}} }}, {{ inertial: {{ solution: velocity }} }}] }}
output: {{ every: 60 s, formats: [csv] }}
"
            );
        let scenario = Scenario::load("test.yaml", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
        run(&scenario, &Context::silent()).unwrap_or_else(|e| panic!("{e}"))
    };
    for (record, word) in [
        (coarse("lat: 45 deg", "20 deg/h"), "10.636 deg/h"),
        (coarse("lat: 90 deg", "0.01 deg/h"), "at a pole"),
    ] {
        assert!(
            record.notes.iter().any(|n| n.contains("Heading cannot be had") && n.contains(word)),
            "{:?}",
            record.notes
        );
        assert!(last(&record, "triad", "run").1[8].is_nan());
    }
    let good = coarse("lat: 45 deg", "0.01 deg/h");
    assert!(!good.notes.iter().any(|n| n.contains("cannot")), "{:?}", good.notes);
}

/// Two windows of a log at rest, written by hand: each method finds the attitude again in both.
#[test]
fn windows_of_a_log() {
    let folder = std::env::temp_dir().join(format!("schuler_align_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    // Level, nose to the east, at 45 deg: increments over 0.1 s, with a hundred more rows than two windows.
    let (g, o) = (9.806197769, 7.292115e-5);
    let (n, d) = (o * 45f64.to_radians().cos(), -o * 45f64.to_radians().sin());
    let row = format!("{},{},{},0,0,{}\n", 0.0, -n * 0.1, d * 0.1, -g * 0.1);
    std::fs::write(folder.join("log.csv"), format!("gx,gy,gz,ax,ay,az\n{}", row.repeat(1300))).unwrap();
    let text = HEAD.replace("motion: static\n", "")
        + "\
log:
  file: log.csv
  rate: 10 Hz
  content: increments
  columns: { gyro: [gx, gy, gz], accel: [ax, ay, az] }
  scale: { gyro: 1 rad, accel: 1 m/s }
alignment:
  window: 60 s
  coarse: { triad: { window: 10 s } }
  filter: { tilt: 0.1 deg, heading: 1 deg, noise: 0.01 m/s, gyro: [], accel: [] }
  methods: [{ triad: {} }, { inertial: { solution: position } }, { filter: {} }]
  navigate: 30 s
output: { every: 10 s, formats: [csv] }
";
    let scenario = Scenario::load(folder.join("a.yaml"), &text, &[]).unwrap_or_else(|e| panic!("{e}"));
    let context = Context { data: Some(folder.clone()), progress: &crate::Silent };
    let record = run(&scenario, &context).unwrap_or_else(|e| panic!("{e}"));
    let windows = record.tables.iter().find(|t| t.name == "windows").unwrap();
    assert_eq!(windows.len(), 6);
    for yaw in windows.numbers("yaw_rad").unwrap() {
        assert!((yaw - std::f64::consts::FRAC_PI_2).abs() < 1e-6, "{yaw}");
    }
    let (t, error) = last(&record, "filter", "navigated");
    assert_eq!(t, 30.0);
    assert!(error[..2].iter().all(|e| e.abs() < 1e-3), "{error:?}");
    std::fs::remove_dir_all(&folder).unwrap();
}
