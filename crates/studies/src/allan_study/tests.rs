use std::fmt::Write as _;
use std::path::PathBuf;

use schuler_allan::Term;
use schuler_frames::Vec3;
use schuler_imu::{Imu, Instrument::Accel, Instrument::Gyro, Source, Spec, Stream, Truth};

use schuler_strapdown::Increments;

use super::axis::{Channel, KEPT};
use crate::log::{AxisMap, ColumnRef, Columns, Content, Scale};
use crate::record::{Column, Record};
use crate::{Context, Error, Scenario};

const DEG_SQRT_H: f64 = std::f64::consts::PI / 180.0 / 60.0;

/// Half an hour at 10 Hz at rest with white noise on all axes and a bias on one; column gz stuck if wanted.
fn log(stuck: bool) -> String {
    let white = |i, n: f64| Source::named(i, "bias", "white", &[("density", n.into())]).unwrap();
    let spec = Spec::from_sources([white(Gyro, 0.3 * DEG_SQRT_H), white(Accel, 1e-3)]).unwrap();
    let mut imu = Imu::new(&spec, Stream { seed: 11, run: 0 }).unwrap();
    let mut text = String::from("gx,gy,gz,ax,ay,az\n");
    for _ in 0..18_000 {
        let sample = imu.step(0.1, &Truth::rates([1e-3, 0.0, 0.0], [0.0, 0.0, -9.81]));
        let [gx, gy, gz] = sample.dtheta;
        let [ax, ay, az] = sample.dv;
        let gz = if stuck { 0.0 } else { gz };
        writeln!(text, "{gx:e},{gy:e},{gz:e},{ax:e},{ay:e},{az:e}").unwrap();
    }
    text
}

fn run(name: &str, text: &str) -> Result<Record, Error> {
    let folder: PathBuf = std::env::temp_dir().join(format!("schuler-allan-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("log.csv"), text).unwrap();
    let scenario = "schuler: 1\nstudy: allan\ntitle: A log of white noise\nlog:\n  file: log.csv\n  rate: 10 Hz\n  content: increments\n  \
         columns: { gyro: [gx, gy, gz], accel: [ax, ay, az] }\n  scale: { gyro: 1 rad, accel: 1 m/s }\n";
    let scenario = Scenario::load("allan.yaml", scenario, &[])?;
    let context = Context { data: Some(folder.clone()), ..Context::silent() };
    let record = super::run(&scenario, &context);
    std::fs::remove_dir_all(folder).unwrap();
    record
}

fn numbers<'a>(record: &'a Record, table: &str, column: &str) -> &'a [f64] {
    let table = record.tables.iter().find(|t| t.name == table).unwrap();
    table.numbers(column).unwrap()
}

fn words(record: &Record, table: &str, column: &str) -> Vec<String> {
    let table = record.tables.iter().find(|t| t.name == table).unwrap();
    let column = table.columns.iter().find(|c| c.name() == column).unwrap();
    match column {
        Column::Word { words, codes, .. } => codes.iter().map(|c| words[*c as usize].clone()).collect(),
        Column::Number { .. } => panic!("numbers"),
    }
}

/// N comes back on every axis within five of its standard errors (0.53 % by the Cramér-Rao bound), and the sources
/// found are a scenario's.
#[test]
fn white_noise_comes_back_as_error_sources() {
    let record = run("white", &log(false)).unwrap();
    let (axes, terms) = (words(&record, "parameters", "axis"), words(&record, "parameters", "term"));
    let values = numbers(&record, "parameters", "value_si");
    let mut found = 0;
    for ((axis, term), value) in axes.iter().zip(&terms).zip(values) {
        if term == "random walk N" {
            let want = if axis.starts_with("gyro") { 0.3 * DEG_SQRT_H } else { 1e-3 };
            assert!((value / want - 1.0).abs() < 0.027, "{axis}: {value}, true {want}");
            found += 1;
        }
    }
    assert_eq!(found, 6);
    assert_eq!(record.figures.len(), 6);
    // Every estimate lies within its interval.
    let [dev, low, high] =
        ["deviation_radps", "low_radps", "high_radps"].map(|c| numbers(&record, "allan_gyro", c));
    assert!((0..dev.len()).all(|i| low[i] < dev[i] && dev[i] < high[i]));

    let (name, sources) = &record.texts[0];
    assert_eq!(name, "sources.yaml");
    let mut scenario = String::from(
        "schuler: 1\nstudy: imu\ntitle: again\nmotion: zero_truth\nduration: 10 s\nimu:\n  rate: 10 Hz\n",
    );
    for line in sources.lines() {
        writeln!(scenario, "  {line}").unwrap();
    }
    Scenario::load("again.yaml", &scenario, &[]).unwrap();
}

/// An axis that says nothing is named, and the others are done.
#[test]
fn a_stuck_axis_is_named() {
    let record = run("stuck", &log(true)).unwrap();
    let note = record.notes.iter().find(|n| n.starts_with("gyro.z")).unwrap();
    assert!(note.contains("constant column"), "{note}");
    assert_eq!(record.figures.len(), 5);
    let sources = &record.texts[0].1;
    assert!(
        sources.contains("gyro:\n  # z: not in this log, or without a fit; without errors here."),
        "{sources}"
    );
    assert!(sources.contains(", 0 deg/sqrt(h)]"), "{sources}");
}

#[test]
fn a_bad_row_is_refused() {
    let text = log(false).replacen("\n", "\nnan,0,0,0,0,0\n", 1);
    assert!(run("nan", &text).is_err());
}

/// A log too long to keep says the same as one that is kept: the same differences up to eight samples, a subset of them
/// above, whose price in variance for white noise is 2 %: so the two estimates of a variance differ by
/// sqrt(0.02 · 2/edf), a seventh of their standard error. The octave at 1/4 of the log is the last compared.
#[test]
fn a_log_too_long_to_keep_says_the_same() {
    let spec = crate::log::LogSpec {
        file: String::new(),
        source: String::new(),
        rate: 10.0,
        content: Content::Increments,
        columns: Columns { time: None, gyro: vec![ColumnRef::Number(1)], accel: Vec::new() },
        scale: Scale { gyro: [1.0; 3], accel: [1.0; 3] },
        axes: AxisMap::IDENTITY,
        stationary: false,
    };
    let white = Source::named(Gyro, "bias", "white", &[("density", DEG_SQRT_H.into())]).unwrap();
    let mut imu = Imu::new(&Spec::from_sources([white]).unwrap(), Stream { seed: 5, run: 0 }).unwrap();
    let mut channels = [KEPT, 1000].map(|limit| Channel::all(&spec, limit).pop().unwrap());
    for _ in 0..65_536 {
        let sample = imu.step(0.1, &Truth::rates([0.0; 3], [0.0; 3]));
        let increments = Increments { dtheta: Vec3::claim(sample.dtheta), dv: Vec3::ZERO };
        channels.iter_mut().for_each(|channel| channel.push(&increments));
    }
    let found = channels.map(|channel| channel.finish().found.unwrap());
    assert_eq!(found.each_ref().map(|f| f.streamed), [false, true]);
    let [kept, streamed] = &found;
    let mut compared = 0;
    for sparse in streamed.curves[0].iter().filter(|e| 4 * e.point.m <= 65_536) {
        let full = kept.curves[0].iter().find(|e| e.point.m == sparse.point.m).unwrap();
        let ratio = sparse.point.variance / full.point.variance;
        let sigma = if sparse.point.m <= 8 { 1e-11 } else { (0.02 * 2.0 / full.edf).sqrt() };
        assert!((ratio - 1.0).abs() < 5.0 * sigma, "{}: {ratio}, {sigma}", sparse.point.m);
        compared += 1;
    }
    assert_eq!(compared, 15);
    let [a, b] = found.each_ref().map(|f| {
        let fit = f.fit.as_ref().unwrap();
        fit.parameter(Term::White).unwrap().clone()
    });
    assert!((a.value - b.value).abs() < a.standard_error, "{a:?}, {b:?}");
    assert!((0.9..1.1).contains(&(b.standard_error / a.standard_error)), "{a:?}, {b:?}");
}
