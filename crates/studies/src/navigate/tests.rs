//! The shipped logs, and what a log that does not fit its scenario is told.

use std::path::{Path, PathBuf};

use crate::record::Table;
use crate::{Context, Error, Record, Scenario, Silent, recorded};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn run(config: &str, overrides: &[&str], data: Option<PathBuf>) -> Result<Record, Error> {
    let file = root().join("configs").join(config);
    let text = std::fs::read_to_string(&file).unwrap();
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    let scenario = Scenario::load(&file, &text, &overrides)?;
    let mut record = super::run(&scenario, &Context { data, progress: &Silent })?;
    record.judge(&scenario);
    // What the shipped file expects holds; overrides may change what comes out.
    assert!(!overrides.is_empty() || record.holds(), "{:?}", record.verdicts);
    Ok(record)
}

fn synthetic(overrides: &[&str]) -> Result<Record, Error> {
    run("navigate_synthetic.yaml", overrides, None)
}

fn table<'a>(record: &'a Record, name: &str) -> &'a Table {
    record.tables.iter().find(|table| table.name == name).unwrap()
}

fn last(record: &Record, name: &str, column: &str) -> f64 {
    *table(record, name).numbers(column).unwrap().last().unwrap()
}

fn degrees(value: f64, expected: f64, arcsec: f64, what: &str) {
    let apart = (value.to_degrees() - expected) * 3600.0;
    assert!(apart.abs() < arcsec, "{what} is {apart} arcsec off");
}

/// Expected numbers: tests/data/static_log/make.py, which shares no code with this crate.
#[test]
fn the_synthetic_log_gives_the_attitude_of_triad_and_the_drift_of_an_independent_integration() {
    let record = synthetic(&[]).unwrap();
    let first = |column: &str| table(&record, "trajectory").numbers(column).unwrap()[0];
    assert_eq!(first("t_s"), 300.0);
    degrees(first("roll_rad"), 1.5017493053247803, 1e-4, "roll");
    degrees(first("pitch_rad"), -1.9971754249038216, 1e-4, "pitch");
    degrees(first("yaw_rad"), 129.88170310591394, 1e-3, "yaw");
    assert_eq!(last(&record, "errors", "t_s"), 1200.0);
    assert!((last(&record, "errors", "dn_m") - -0.08253899624197322).abs() < 1e-3);
    assert!((last(&record, "errors", "de_m") - -24.13641927084969).abs() < 1e-3);
    assert!((last(&record, "errors", "dv_e_mps") - -0.07713025077374594).abs() < 1e-6);
    degrees(last(&record, "trajectory", "roll_rad"), 1.5023688269867506, 1e-3, "roll");
    degrees(last(&record, "trajectory", "pitch_rad"), -1.9965253916069214, 1e-3, "pitch");
    // Down to where the vertical channel is held.
    assert_eq!(last(&record, "trajectory", "h_m"), 450.0);
    assert_eq!(record.figures.len(), 3);
}

#[test]
fn rows_come_as_often_as_asked() {
    let record = synthetic(&["output.every=60 s", "duration=150 s"]).unwrap();
    assert_eq!(table(&record, "trajectory").numbers("t_s").unwrap(), [300.0, 360.0, 420.0, 450.0]);
    let all = synthetic(&["output.every=100 ms"]).unwrap();
    assert_eq!(table(&all, "trajectory").len(), 9001);
}

#[test]
fn columns_may_go_by_number() {
    let by_number = synthetic(&["log.columns={ time: 1, gyro: [2, 3, 4], accel: [5, 6, 7] }"]).unwrap();
    assert_eq!(by_number.tables, synthetic(&[]).unwrap().tables);
}

#[test]
fn a_log_that_moves_has_no_errors() {
    let record = synthetic(&["log.stationary=false"]).unwrap();
    assert!(record.tables.iter().all(|table| table.name != "errors"));
}

#[test]
fn a_log_that_does_not_fit_is_refused() {
    let message = |overrides: &[&str]| synthetic(overrides).unwrap_err().to_string();
    let short = message(&["align.window=[0 s, 1300 s]"]);
    assert!(short.contains("the log ends within the alignment window"), "{short}");
    assert!(short.contains("12000 rows, which are 1200 s at 10 Hz"), "{short}");
    let scale = message(&["log.scale.accel=1e-5 m/s"]);
    assert!(scale.contains("the mean specific force is not that of a vehicle at rest"), "{scale}");
    let mirror = message(&["log.axes=[y, x, z]"]);
    assert!(mirror.contains("[y, x, z] is left-handed (determinant -1)"), "{mirror}");
    let moving = message(&["start.velocity={ n: 1 m/s, e: 0 m/s, d: 0 m/s }"]);
    assert!(
        moving.contains("start.velocity: a velocity at the start of an alignment by averaging"),
        "{moving}"
    );
    let absent = message(&["log.file=no_such.csv"]);
    assert!(absent.contains("the log no_such.csv is not there") && absent.contains("--data DIR"), "{absent}");
}

/// The real log is not part of the repository. Its facts: number of rows, |f| = 9.79548 m/s² and a mean rate of
/// 14.853 deg/h over the whole, as measured by others.
#[test]
fn the_ring_laser_log_is_read_whole() {
    let Some(data) = recorded::folder(&root()) else {
        recorded::skipped("the_ring_laser_log_is_read_whole");
        return;
    };
    let record = run("navigate_ring_laser.yaml", &[], Some(data)).unwrap();
    let log = |column: &str| table(&record, "log").numbers(column).unwrap()[0];
    assert_eq!(log("samples_count"), 184_718.0);
    assert!((log("f_mps2") - 9.79548).abs() < 1e-5);
    degrees(log("omega_radps") * 3600.0, 14.853, 3.6, "mean rate in an hour");
    // Level of the mean specific force over the first 300 s, by numpy on the raw counts.
    let first = |column: &str| table(&record, "trajectory").numbers(column).unwrap()[0];
    degrees(first("pitch_rad"), 0.8764502414476327, 0.01, "pitch");
    degrees(first("roll_rad"), 0.28681025448822195, 0.01, "roll");
}
