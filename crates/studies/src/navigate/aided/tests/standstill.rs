//! Standstills that are told from the IMU.

use super::conditions::{DRIVE, FROM_REST, speed};
use super::*;
use crate::recorded;

const DETECT: &str = "filter.measurements={ zero_velocity: { sigma: 0.01 m/s, every: 0.5 s, detect: { window: 0.5 s, gyro: 0.02 deg/s, accel: 0.01 m/s^2, speed: 1 m/s } } }";

/// White noise of 0.1 deg/sqrt(h) and 100 ug/sqrt(Hz) at 100 Hz is 0.0167 deg/s and 0.0098 m/s² a sample.
#[test]
fn of_a_drive_with_stops() {
    let data = Data::simulated("stops", DRIVE, &["seed=21"]);
    let found = data.navigate_as(FROM_REST, &[DETECT]).unwrap();
    let times = numbers(&found, "innovations", "t_s");
    let truth = std::fs::read_to_string(data.0.join("truth.csv")).unwrap();
    // Time and speed of the truth, a row a second.
    let rows: Vec<Vec<f64>> = truth
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    let moving = |t: f64| {
        let near = |row: &&Vec<f64>| (row[0] - t).abs() <= 1.0;
        rows.iter().filter(near).map(|row| row[4].hypot(row[5])).fold(0.0, f64::max)
    };
    // Never where it moves: the first and last second of a run-up are slow.
    for t in times {
        assert!(moving(*t) < 0.2, "{t}: {} m/s", moving(*t));
    }
    // Nearly always where it stands: 190 s at two looks a second, three components each.
    let standing = times.len() as f64 / 3.0;
    assert!((330.0..=385.0).contains(&standing), "{standing}");
    let note = found.notes.iter().find(|note| note.contains("a standstill in")).unwrap();
    assert!(note.starts_with("zero_velocity: a standstill in"), "{note}");
    // As good as when it is told: within what the filter claims, and it stands in the end.
    for (t, error, sigma) in errors(&found) {
        assert!((0..9).all(|k| error[k].abs() < 4.5 * sigma[k]), "{t}: {error:?} {sigma:?}");
    }
    assert!(speed(&found).last().unwrap().1 < 0.02);
    // Without the limit of speed, the smooth straight road looks like a standstill: the innovations say so.
    let blind = data.navigate_as(FROM_REST, &[&DETECT.replace(", speed: 1 m/s", "")]).unwrap();
    assert!(blind.notes.iter().any(|note| note.starts_with("NOT CONSISTENT")), "{:?}", blind.notes);
}

/// A vehicle that drives at 11 to 16 m/s all the time never stands, and one in which a person moves about a ring-laser unit does.
#[test]
fn of_recorded_logs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let Some(data) = recorded::folder(&root) else {
        recorded::skipped("of_recorded_logs");
        return;
    };
    let looks = |config: &str, overrides: &[&str]| {
        let file = root.join("configs").join(config);
        let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
        let scenario = Scenario::from_file(&file, &overrides).unwrap_or_else(|e| panic!("{e}"));
        let record = run_study(&scenario, &Context { data: Some(data.clone()), progress: &Silent });
        let record = record.unwrap_or_else(|e| panic!("{e}"));
        let note = record.notes.iter().find(|note| note.contains("a standstill in")).unwrap().clone();
        let numbers: Vec<f64> = note.split(' ').filter_map(|word| word.parse().ok()).collect();
        (numbers[0], numbers[1])
    };
    // The noise of the instrument at rest with an engine running, and no help from the speed.
    let (stood, all) = looks(
        "navigate_mems_vehicle.yaml",
        &[
            "filter.measurements.zero_velocity={ sigma: 0.1 m/s, every: 0.1 s, detect: { window: 0.5 s, gyro: 0.2 deg/s, accel: 0.1 m/s^2 } }",
        ],
    );
    assert!(stood == 0.0 && all > 950.0, "{stood} of {all}");
    // Quantization alone is 0.1 arcsec and 1.2 mm/s in 10 ms: 1e-5 rad/s and 0.04 m/s².
    let (stood, all) = looks(
        "navigate_ring_laser.yaml",
        &[
            "duration=600 s",
            "filter={ gyro: [{ bias: { white: { density: 0.003 deg/sqrt(h) } } }], accel: [{ bias: { white: { density: 50 ug/sqrt(Hz) } } }], position: 1 m, velocity: 0.1 m/s, tilt: 0.1 deg, heading: 5 deg, measurements: { zero_velocity: { sigma: 0.1 m/s, detect: { window: 1 s, gyro: 0.02 deg/s, accel: 0.1 m/s^2, speed: 1 m/s } } } }",
        ],
    );
    assert!(stood > 0.9 * all && all == 600.0, "{stood} of {all}");
}
