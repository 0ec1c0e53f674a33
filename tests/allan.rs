//! `schuler allan` as users meet it.

use std::{fs, path::PathBuf};

use super::cli::{Place, text};

/// Uniform numbers between -1 and 1 by a linear congruence, six a row: their variance is 1/3.
fn rows(count: usize) -> Vec<[f64; 6]> {
    let mut state = 1_u32;
    let mut number = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 23) - 1.0
    };
    (0..count).map(|_| std::array::from_fn(|_| number())).collect()
}

fn csv(rows: &[[f64; 6]]) -> String {
    let row = |(k, row): (usize, &[f64; 6])| {
        let row = row.map(|x| x.to_string()).join(",");
        format!("{},{row}\n", (k + 1) as f64 / 10.0)
    };
    "t,gx,gy,gz,ax,ay,az\n".to_string() + &rows.iter().enumerate().map(row).collect::<String>()
}

fn npy(rows: &[[f64; 6]]) -> Vec<u8> {
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, 6), }}\n", rows.len());
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(rows.iter().flatten().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// A folder with nothing but the log, as text and as an array. Endings hide both from the list of what is left.
fn place(name: &str) -> Place {
    let place = Place::new(name);
    fs::remove_file(place.0.join("a.yaml")).expect("nothing but the log");
    fs::write(place.0.join("a.csv.yaml"), csv(&rows(4000))).expect("a log");
    fs::write(place.0.join("b.npy.yaml"), npy(&rows(4000))).expect("a log");
    place
}

const COLUMNS: [&str; 3] = ["--columns", "gyro=gx,gy,gz", "accel=ax,ay,az"];
const SCALE: [&str; 3] = ["--scale", "gyro=1 arcsec", "accel=1e-3 m/s"];

fn arguments<'a>(log: &'a str, parts: &[&[&'a str]]) -> Vec<&'a str> {
    [&["allan", log, "--rate", "10Hz"], &parts.concat()[..]].concat()
}

#[test]
fn a_log_leaves_table_pictures_and_sources() {
    let place = place("allan-six");
    let output = place.schuler(&arguments("a.csv.yaml", &[&COLUMNS, &SCALE, &["--time", "t"]]));
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
    let shown = text(&output.stdout);
    let sources = fs::read_to_string(place.0.join("out/a/sources.yaml")).expect("sources");
    for part in ["verdict", "seen", "bounded", "written to out/a", &sources] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    assert!(place.0.join("out/a/figures/accel_z.png").is_file());
    // The variance of a count is 1/3: at 0.1 s the rate deviates by 1 arcsec / 0.1 s / sqrt(3). The relative error of a
    // deviation of 4000 averages of white noise is sqrt(3/4/4000) = 1.4 %.
    let csv = fs::read_to_string(place.0.join("out/a/allan_gyro.csv")).expect("deviations");
    let first: Vec<&str> = csv.lines().nth(1).expect("a row").split(',').collect();
    let expected = 10.0 / 3_f64.sqrt() * std::f64::consts::PI / 648_000.0;
    let found: f64 = first[3].parse().expect("a number");
    assert!((found / expected - 1.0).abs() < 0.07, "{first:?}, {expected}");
}

/// The list of sources is a scenario's.
#[test]
fn the_sources_go_into_a_scenario() {
    let place = place("allan-paste");
    let output = place.schuler(&arguments("a.csv.yaml", &[&SCALE, &["--formats", "csv", "--quiet"]]));
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(0), String::new()));
    assert!(!place.0.join("out/a/figures").exists());
    let sources = fs::read_to_string(place.0.join("out/a/sources.yaml")).expect("sources");
    let mut scenario =
        "schuler: 1\nstudy: imu\ntitle: again\nmotion: zero_truth\nduration: 1 s\nimu:\n  rate: 10 Hz\n"
            .to_string();
    scenario.extend(sources.lines().map(|line| format!("  {line}\n")));
    fs::write(place.0.join("a.yaml"), scenario).expect("a scenario");
    let output = place.schuler(&["check", "a.yaml"]);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
}

/// The same study from a scenario, from text, from an array and with everything told by header and units has the
/// same numbers.
#[test]
fn however_it_is_said_the_numbers_are_the_same() {
    let place = place("allan-same");
    let run = |arguments: &[&str]| {
        let output = place.schuler(arguments);
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()), "{arguments:?}");
    };
    let rest = ["--axes", "-y,x,z", "--formats", "csv", "--quiet", "--out"];
    run(&arguments("a.csv.yaml", &[&COLUMNS, &SCALE, &["--content", "increments"], &rest, &["said"]]));
    run(&arguments("a.csv.yaml", &[&["--scale", "1 arcsec, 1e-3 m/s"], &rest, &["told"]]));
    run(&arguments("a.csv.yaml", &[&["--columns", "gyro=2,3,4", "accel=5,6,7"], &SCALE, &rest, &["number"]]));
    run(&arguments("b.npy.yaml", &[&["--columns", "1,2,3,4,5,6"], &SCALE, &rest, &["array"]]));
    let scenario = "schuler: 1\nstudy: allan\ntitle: a.csv\nlog:\n  file: b.npy.yaml\n  rate: 10 Hz\n  content: increments\n  \
        columns: { gyro: [1, 2, 3], accel: [4, 5, 6] }\n  scale: { gyro: 1 arcsec, accel: 1 mm/s }\n  \
        axes: [-y, x, z]\noutput: { formats: [csv] }\n";
    fs::write(place.0.join("a.yaml"), scenario).expect("a scenario");
    run(&["run", "a.yaml", "--out", "scenario"]);
    for file in ["sources.yaml", "parameters.csv", "allan_gyro.csv", "allan_accel.csv"] {
        let read = |folder: &str| fs::read_to_string(place.0.join(folder).join(file)).expect(file);
        for folder in ["told", "number", "array", "scenario"] {
            assert_eq!(read("said"), read(folder), "{file} of {folder}");
        }
    }
}

#[test]
fn a_log_may_be_of_one_axis() {
    let place = place("allan-one");
    let run = |extra: &[&str]| {
        let output = place.schuler(&arguments("b.npy.yaml", &[extra]));
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()), "{extra:?}");
        text(&output.stdout)
    };
    // The unit says that it is an accelerometer, and that it gives its rate.
    let shown = run(&["--columns", "4", "--scale", "1 mg"]);
    assert!(shown.contains("accel.x") && !shown.contains("accel.y") && !shown.contains("gyro.x"), "{shown}");
    assert!(
        shown.contains("taken for all three") && shown.contains("gyro: []      # not in this log"),
        "{shown}"
    );
    assert!(!place.0.join("out/b/allan_gyro.csv").exists());
    let shown = run(&["--columns", "gyro=3,1", "--scale", "gyro=1 deg/s"]);
    assert!(shown.contains("gyro.y") && !shown.contains("gyro.z"), "{shown}");
    assert!(shown.contains("# z: not in this log"), "{shown}");
}

/// What the program writes it reads without being told what it is.
#[test]
fn a_simulated_log_says_what_it_is() {
    let place = Place::new("allan-own");
    let scenario = "schuler: 1\nstudy: imu\ntitle: noise\nmotion: zero_truth\nduration: 60 s\n\
        imu: { rate: 100 Hz, gyro: [{ bias: { white: { density: 0.1 deg/sqrt(h) } } }] }\noutput: { formats: [csv] }\n";
    fs::write(place.0.join("a.yaml"), scenario).expect("a scenario");
    assert_eq!(place.schuler(&["run", "a.yaml"]).status.code(), Some(0));
    let output = place.schuler(&["allan", "out/a/imu.csv", "--rate", "100 Hz", "--out", "b"]);
    let shown = text(&output.stdout);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
    // The accelerometers are without errors.
    assert!(shown.contains("gyro.x  random walk N") && shown.contains("a constant column"), "{shown}");
    let output = place.schuler(&["allan", "out/a/imu.csv", "--rate", "50 Hz", "--out", "b"]);
    assert!(text(&output.stderr).contains("t_s: an interval that is too short"), "{}", text(&output.stderr));
}

#[test]
fn a_wrong_argument_is_named() {
    let place = place("allan-wrong");
    let wrong = |arguments: &[&str], parts: &[&str]| {
        let output = place.schuler(arguments);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert_eq!(place.left(), Vec::<PathBuf>::new(), "{arguments:?}");
        for part in parts {
            assert!(error.contains(part), "{arguments:?}: no `{part}` in\n{error}");
        }
    };
    let six = |log, columns: &[&str], scale: &[&str], parts: &[&str]| {
        wrong(&arguments(log, &[columns, scale]), parts);
    };
    let log = "a.csv.yaml";
    six("b.csv", &COLUMNS, &SCALE, &["LOG: the log b.csv is not there", "--data"]);
    for (rate, problem) in
        [("100", "a number without a unit"), ("100 m", "wrong dimension"), ("0 Hz", "more than zero")]
    {
        let all = [&["allan", log, "--rate", rate], &COLUMNS[..], &SCALE[..]].concat();
        wrong(&all, &["command line: --rate: ", problem, "example: --rate '100 Hz'"]);
    }
    six(log, &["--columns", "gyro=gx,gy,gz", "gyro=ax"], &SCALE, &["--columns: two entries for `gyro`"]);
    six(log, &["--columns", "magnet=gx"], &SCALE, &["--columns: `magnet` is neither of gyro, accel"]);
    six(log, &["--columns", "gx,gy"], &SCALE, &["--columns: 2 columns of an instrument that is not named"]);
    six(
        log,
        &["--columns", "gyro=gx,gy,gz,ax"],
        &["--scale", "1 deg/s"],
        &["--columns: the list has 4 entries"],
    );
    six(log, &["--columns", "gyro=gx", "accel=a"], &SCALE, &["a: the log has no such column", "`gx`, `gy`"]);
    six(log, &["--columns", "gyro=9", "accel=5"], &SCALE, &["column 9: the log has no such column"]);
    six(log, &["--columns", "gyro=gx", "accel=gx"], &SCALE, &["gx: the column is named twice"]);
    six(log, &["--columns", "gyro=gx"], &SCALE, &["--columns: the key `accel` is missing"]);
    six(
        log,
        &COLUMNS,
        &["--scale", "gyro=1 arcsec"],
        &["--scale: the key `accel` is missing", "example: --scale"],
    );
    six(log, &COLUMNS, &[], &["--scale: what one count of a column is, is not known", "example: --scale"]);
    six(log, &COLUMNS, &["--scale", "1,2"], &["--scale: a number without a unit", "example: --scale"]);
    six(log, &COLUMNS, &["--scale", "1 arcsec,1 deg"], &["--scale: two entries for `gyro`"]);
    six(log, &COLUMNS, &["--scale", "1 arcsec,1 m"], &["--scale: wrong dimension"]);
    six(log, &COLUMNS, &["--scale", "1 arcsec,1 m/s^2"], &["--scale: wrong dimension", "found: `1 m/s^2`"]);
    six(log, &COLUMNS, &["--scale", "1 arcsce,1 m/s"], &["--scale: unknown unit `arcsce`"]);
    six(log, &COLUMNS, &[&SCALE[..], &["--content", "counts"]].concat(), &["--content: ", "increments"]);
    six(log, &COLUMNS, &[&SCALE[..], &["--axes", "y,x,z"]].concat(), &["--axes: ", "left-handed"]);
    six(log, &COLUMNS, &[&SCALE[..], &["--formats", "gif"]].concat(), &["--formats: ", "svg"]);
    six("b.npy.yaml", &[], &SCALE, &["--columns: which columns are gyros", "example: --columns gyro=2,3,4"]);
    wrong(&["allan", log], &["--rate"]);
}

/// A log that cannot be used says where and why; an axis that says nothing leaves the others alone.
#[test]
fn a_bad_log_is_named() {
    let place = place("allan-bad");
    let log = "a.csv.yaml";
    let all = arguments(log, &[&COLUMNS, &SCALE, &["--time", "t"]]);
    let with = |change: &dyn Fn(&mut Vec<[f64; 6]>), text_change: &dyn Fn(String) -> String, part: &str| {
        let mut rows = rows(4000);
        change(&mut rows);
        fs::write(place.0.join(log), text_change(csv(&rows))).expect("a log");
        let output = place.schuler(&all);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{part}: {error}");
        assert!(error.contains(part), "no `{part}` in\n{error}");
        assert_eq!(place.left(), Vec::<PathBuf>::new(), "{part}");
    };
    let same = |text: String| text;
    with(&|rows| rows[7][2] = f64::NAN, &same, "gz: a number that is not finite");
    with(&|_| (), &|text| text.replacen("\n100.1,", "\n100.4,", 1), "t: a gap in time");
    let without =
        |text: String| text.lines().filter(|l| !l.starts_with("50,")).map(|l| format!("{l}\n")).collect();
    with(&|_| (), &without, "t: a gap in time");
    with(&|_| (), &|text| text.replacen("\n100.1,", "\n100.02,", 1), "t: an interval that is too short");
    with(&|_| (), &|text| text.replacen("\n100.1,", "\n99,", 1), "t: time goes backwards");
    with(&|rows| rows.clear(), &same, "the log has a header and no rows");

    fs::write(place.0.join(log), csv(&rows(40))).expect("a log");
    let output = place.schuler(&all);
    let shown = text(&output.stdout);
    assert!(output.status.code() == Some(0) && shown.contains("no fit: 40 samples are too few"), "{shown}");
    let mut stuck = rows(4000);
    stuck.iter_mut().for_each(|row| row[1] = 0.25);
    fs::write(place.0.join(log), csv(&stuck)).expect("a log");
    let output = place.schuler(&all);
    let shown = text(&output.stdout);
    assert!(output.status.code() == Some(0) && shown.contains("gyro.y: all 4000 samples equal"), "{shown}");
    assert!(shown.contains("gyro.z   random walk N"), "{shown}");
}
