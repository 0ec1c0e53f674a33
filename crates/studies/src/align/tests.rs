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

/// A study of `duration` with these sensors, methods and other keys of `alignment`.
fn study(position: &str, motion: &str, duration: &str, [gyro, accel]: [&str; 2], alignment: &str) -> Record {
    let text = HEAD.replace("lat: 45 deg", position).replace("motion: static", motion)
        + &format!(
            "duration: {duration}
imu: {{ rate: 10 Hz, gyro: [{gyro}], accel: [{accel}] }}
alignment: {{ {alignment} }}
output: {{ every: 1 s, formats: [csv, png] }}
"
        );
    let scenario = Scenario::load("test.yaml", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
    run(&scenario, &Context::silent()).unwrap_or_else(|e| panic!("{e}"))
}

fn note<'a>(record: &'a Record, words: &[&str]) -> Option<&'a String> {
    record.notes.iter().find(|note| words.iter().all(|word| note.contains(word)))
}

fn figures(record: &Record) -> Vec<&str> {
    record.figures.iter().map(|(name, _)| name.as_str()).collect()
}

const TRIAD: &str = "methods: [{ triad: {} }, { inertial: { solution: velocity } }]";

/// An instrument whose errors are larger than the Earth rate gets an answer that names the error, and no number for its heading.
#[test]
fn where_heading_cannot_be_had_it_is_said() {
    let at = |position: &str, gyro: &str| study(position, "motion: static", "60 s", [gyro, ""], TRIAD);
    for (record, words) in [
        (
            at("lat: 45 deg", "bias: { constant: { sigma: 20 deg/h } }"),
            ["10.636 deg/h", "gyro.bias.constant"],
        ),
        // 60 deg/√h over a minute: 465 deg/h.
        (at("lat: 45 deg", "bias: { white: { density: 60 deg/sqrt(h) } }"), ["gyro.bias.white", "464.76"]),
        // 1 deg/h/√s over a minute: √(60/3) = 4.4721 deg/h as a mean, but 0.5 of 10.636 needs more.
        (
            at("lat: 45 deg", "bias: { random_walk: { density: 2 deg/h/sqrt(s) } }"),
            ["gyro.bias.random_walk", "8.9443"],
        ),
        (at("lat: 90 deg", "bias: { constant: { sigma: 0.01 deg/h } }"), ["at a pole", ""]),
    ] {
        assert!(
            note(&record, &["Heading cannot be had", words[0], words[1]]).is_some(),
            "{:?}",
            record.notes
        );
        for way in ["run", "limit"] {
            assert!(last(&record, "triad", way).1[8].is_nan());
        }
        assert!(last(&record, "triad", "limit").1[6].is_finite());
        assert_eq!(figures(&record), ["triad", "inertial_velocity"]);
    }
    let good = at("lat: 45 deg", "bias: { constant: { sigma: 0.01 deg/h } }");
    assert!(note(&good, &["cannot"]).is_none(), "{:?}", good.notes);
}

/// Velocity noise is nothing to a method that measures no velocity: TRIAD keeps its heading, and the filter that knew nothing
/// before does not.
#[test]
fn velocity_noise_hides_no_heading_of_triad() {
    let sensors = ["bias: { constant: { sigma: 0.01 deg/h } }", ""];
    let filter = "coarse: { triad: { window: 2 s } }, velocity: { every: 1 s, noise: 1 cm/s },
  filter: { tilt: 1 deg, heading: 180 deg, gyro: [], accel: [] },";
    let with = format!("{filter} methods: [{{ triad: {{}} }}, {{ filter: {{}} }}]");
    let record = study("lat: 45 deg", "motion: static", "12 s", sensors, &with);
    assert!(last(&record, "triad", "run").1[8].is_finite());
    let limit = last(&record, "triad", "limit").1[8];
    // 0.01 / 10.636.
    assert!((limit - 9.402e-4).abs() < 1e-6, "{limit}");
    assert!(last(&record, "filter", "run").1[8].is_nan());
    assert!(last(&record, "filter", "sigma").1[8].is_nan());
    assert!(note(&record, &["cannot be had by `filter`", "noise of the measured velocity"]).is_some());
    let consistency = record.tables.iter().find(|t| t.name == "consistency").unwrap();
    assert!(consistency.numbers("nees_ratio").unwrap().iter().all(|x| x.is_nan()));
    // Measured from the end of the coarse alignment on.
    assert!(consistency.numbers("nis_ratio").unwrap()[2..].iter().all(|x| x.is_finite()));
}

/// At a pole a filter says why in place of a fault in its numbers, and a loop that diverges says so.
#[test]
fn filters_at_a_pole_and_loops_that_diverge_have_a_reason() {
    let sensors = ["bias: { constant: { sigma: 0.01 deg/h } }", ""];
    let filter =
        "coarse: { sigma: { tilt: 0.1 deg, heading: 1 deg } }, velocity: { every: 1 s, noise: 1 cm/s },
  filter: { gyro: [], accel: [] },";
    let with = format!("{filter} methods: [{{ filter: {{}} }}, {{ gyrocompass: {{ tau: 0.01 s }} }}]");
    let record = study("lat: 90 deg", "motion: static", "12 s", sensors, &with);
    assert!(note(&record, &["`filter` gave no attitude", "at a pole"]).is_some(), "{:?}", record.notes);
    let record = study("lat: 45 deg", "motion: static", "60 s", sensors, &with);
    assert!(
        note(&record, &["`gyrocompass` gave no attitude", "no finite number"]).is_some(),
        "{:?}",
        record.notes
    );
}

const BIASES: [&str; 2] =
    ["bias: { constant: { sigma: 0.01 deg/h } }", "bias: { constant: { sigma: 50 ug } }"];

fn filtered(more: &str) -> String {
    format!(
        "coarse: {{ sigma: {{ tilt: 0.1 deg, heading: 1 deg }} }}, velocity: {{ every: 1 s, noise: 0.01 m/s }},
  filter: {{ gyro: [{}], accel: [{}] }}, methods: [{{ triad: {{}} }}, {{ filter: {{}} }}]{more}",
        BIASES[0], BIASES[1]
    )
}

/// Theory: 11 states, of which one position observes 7; two or three, all but the accelerometer's down error, 10. A knock that
/// the gyros miss is no turn, nor is one after the end.
#[test]
fn observability_of_what_the_base_does() {
    let pose = |yaw: u32| format!("{{ yaw: {yaw} deg, dwell: 20 s }}");
    let positions = |yaws: &[u32]| {
        let poses: Vec<String> = yaws.iter().map(|yaw| pose(*yaw)).collect();
        format!("motion: {{ positions: {{ rate: 90 deg/s, poses: [{}] }} }}", poses.join(", "))
    };
    let knock = ", knock: { at: 30 s, tilt: [0.02 deg, 0.02 deg], heading: 0.5 deg }";
    for (motion, duration, more, words) in [
        ("motion: static".to_string(), "60 s", "", "observes 7 of 11"),
        ("motion: static".into(), "60 s", knock, "observes 7 of 11"),
        (positions(&[0, 180, 0]), "60 s", "", "observes 10 of 11"),
        (positions(&[0, 180]), "40 s", "", "observes 10 of 11"),
        (positions(&[0, 180]), "15 s", "", "observes 7 of 11"),
        (
            "motion: { sway: { roll: { amplitude: 2 deg, period: 8 s }, pitch: { amplitude: 2 deg, period: 6 s } } }".into(),
            "60 s",
            "",
            "the rocking tells less",
        ),
    ] {
        let record = study("lat: 45 deg", &motion, duration, BIASES, &filtered(more));
        assert!(note(&record, &["`filter`", words]).is_some(), "{motion}: {:?}", record.notes);
    }
}

/// What the run leaves of a state cannot be less than the filter's own standard deviation shows, which has all other noise on top;
/// on a base that does not rock much it is what stands still leaves.
#[test]
fn rocking_tells_little_of_the_biases() {
    let motion = "motion: { sway: { roll: { amplitude: 2 deg, period: 8 s } } }";
    let record = study("lat: 45 deg", motion, "60 s", BIASES, &filtered(""));
    let table = record.tables.iter().find(|t| t.name == "observability").unwrap();
    let [start, end, limit] = ["start", "end", "limit"].map(|name| table.numbers(name).unwrap());
    for k in 0..table.len() {
        assert!(limit[k] <= start[k] * (1.0 + 1e-9));
        // Constant states: at the start as at the end.
        if k >= 5 {
            assert!((end[k] / limit[k] - 1.0).abs() < 1e-3, "{k}: {} {}", end[k], limit[k]);
        }
    }
}

/// Each method beside its own limit: means for TRIAD, which measures no velocity; nothing known once the base is turned.
#[test]
fn limits_are_those_of_the_methods() {
    let noisy =
        ["bias: { white: { density: 0.003 deg/sqrt(h) } }", "bias: { white: { density: 10 ug/sqrt(Hz) } }"];
    let record = study("lat: 45 deg", "motion: static", "60 s", noisy, &filtered(""));
    let arcmin = |record: &Record, source: &str, axis: usize| {
        last(record, source, "limit").1[6 + axis] * 10_800.0 / std::f64::consts::PI
    };
    // N / (Ω c √t) of 0.003 deg/√h over a minute is 7.51 arcmin; 10 ug/√Hz are 10e-6/√60 rad in the tilt.
    assert!((arcmin(&record, "triad", 2) - 7.51).abs() < 0.01, "{}", arcmin(&record, "triad", 2));
    assert!((arcmin(&record, "triad", 0) - 4.438e-3).abs() < 2e-5, "{}", arcmin(&record, "triad", 0));
    // 65.4 arcmin by velocity noise of 0.01 m/s, and 5 by velocity random walk: √(7.51² + 4.96² + 65.4²).
    assert!((arcmin(&record, "filter", 2) - 66.0).abs() < 0.2, "{}", arcmin(&record, "filter", 2));
    let turned =
        "motion: { positions: { rate: 90 deg/s, poses: [{ dwell: 20 s }, { yaw: 180 deg, dwell: 60 s }] } }";
    let record = study("lat: 45 deg", turned, "60 s", BIASES, &filtered(""));
    assert!(arcmin(&record, "filter", 0).is_nan());
    let errors = record.tables.iter().find(|t| t.name == "errors").unwrap();
    let limits: Vec<f64> = (0..errors.len())
        .filter(|&row| errors.columns[2].cell(row) == Cell::Word("limit"))
        .map(|row| errors.numbers("phi_n_rad").unwrap()[row])
        .collect();
    assert_eq!(limits.iter().filter(|x| x.is_finite()).count(), 40);
    let before =
        "motion: { positions: { rate: 90 deg/s, poses: [{ dwell: 70 s }, { yaw: 180 deg, dwell: 60 s }] } }";
    let record = study("lat: 45 deg", before, "60 s", BIASES, &filtered(""));
    // 50 ug.
    assert!((last(&record, "triad", "limit").1[6] - 5.0e-5).abs() < 1e-8);
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
output: { every: 10 s, formats: [csv, png] }
";
    let pole = text.replace("lat: 45 deg", "lat: 90 deg");
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
    // Each window beside the method's own sigma and limit: √(720 r/t⁵)/(g Ω c) of 0.01 m/s each second over a minute, 65.4 arcmin;
    // TRIAD measures no velocity, and its sensors are said to be perfect.
    let of = |name: &str, row: usize| windows.numbers(name).unwrap()[row];
    assert!((of("limit_d_rad", 2) * 10_800.0 / std::f64::consts::PI - 65.4).abs() < 0.1);
    assert_eq!(of("limit_d_rad", 0), 0.0);
    assert!(of("sigma_d_rad", 2) > 0.0 && of("sigma_d_rad", 2) < 0.0175 && of("sigma_d_rad", 0).is_nan());
    assert!(note(&record, &["`filter` observes all of its 5 states"]).is_some(), "{:?}", record.notes);
    assert_eq!(figures(&record), ["windows", "repeatability", "filter_heading"]);
    let scenario = Scenario::load(folder.join("a.yaml"), &pole, &[]).unwrap_or_else(|e| panic!("{e}"));
    let record = run(&scenario, &context).unwrap_or_else(|e| panic!("{e}"));
    assert!(note(&record, &["Heading cannot be had", "at a pole"]).is_some(), "{:?}", record.notes);
    assert!(!figures(&record).contains(&"filter_heading"));
    std::fs::remove_dir_all(&folder).unwrap();
}
