//! Zero velocity, zero rate, non-holonomic motion, height and heading alone, and the start from a window: each against simulated truth.

use super::*;

/// A drive with stops: it stands for the first 120 s, drives a minute, stands for 40 s, drives on.
pub const DRIVE: &str = "
schuler: 1
study: simulate
title: A drive with stops
start:
  position: { lat: 47 deg, lon: 8 deg, h: 450 m }
  attitude: { roll: 0 deg, pitch: 0 deg, yaw: 30 deg }
motion:
  segments:
    - stand: { duration: 120 s }
    - accelerate: { to: 12 m/s, duration: 10 s }
    - turn: { angle: 90 deg, radius: 40 m, flat: true }
    - straight: { duration: 20 s }
    - s_turn: { angle: 45 deg, radius: 60 m, flat: true }
    - accelerate: { to: 0 m/s, duration: 10 s }
    - stand: { duration: 40 s }
    - accelerate: { to: 12 m/s, duration: 10 s }
    - turn: { angle: -90 deg, radius: 40 m, flat: true }
    - straight: { duration: 20 s }
    - accelerate: { to: 0 m/s, duration: 10 s }
    - stand: { duration: 30 s }
gravity: normal
imu:
  rate: 100 Hz
  gyro:
    - bias: { white: { density: 0.1 deg/sqrt(h) } }
    - bias: { constant: { sigma: 2 deg/h } }
  accel:
    - bias: { white: { density: 100 ug/sqrt(Hz) } }
    - bias: { constant: { sigma: 0.5 mg } }
aiding:
  position: { rate: 1 Hz, sigma: 1 m }
  height: { rate: 1 Hz, sigma: 1 m }
  heading: { rate: 1 Hz, sigma: 0.5 deg }
output: { every: 1 s, formats: [csv], imu: increments }
";

/// From a start that is known as well as the filter claims; what is measured comes from the test.
pub const FROM_REST: &str = "
schuler: 1
study: navigate
title: The drive
start:
  position: { lat: 47 deg, lon: 8 deg, h: 450 m }
  attitude: { roll: 0.1 deg, pitch: -0.1 deg, yaw: 30.4 deg }
  velocity: { n: 0 m/s, e: 0 m/s, d: 0 m/s }
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
    - bias: { constant: { sigma: 2 deg/h } }
  accel:
    - bias: { white: { density: 100 ug/sqrt(Hz) } }
    - bias: { constant: { sigma: 0.5 mg } }
  position: 1 m
  velocity: 0.05 m/s
  tilt: 0.1 deg
  heading: 0.4 deg
  measurements: { position: { file: position.csv } }
  reference: { file: truth.csv }
output: { every: 1 s, formats: [csv] }
";

/// When the drive stands, by its truth: the speed of its rows.
pub fn speed(record: &Record) -> Vec<(f64, f64)> {
    let column = |name: &str| numbers(record, "trajectory", name).to_vec();
    let (t, n, e) = (column("t_s"), column("v_n_mps"), column("v_e_mps"));
    (0..t.len()).map(|k| (t[k], n[k].hypot(e[k]))).collect()
}

fn measurements(text: &str) -> String {
    format!("filter.measurements={text}")
}

/// All errors of all rows below `times` their deviation.
fn assert_claimed(record: &Record, times: f64, what: &str) {
    for (t, error, sigma) in errors(record) {
        assert!((0..9).all(|k| error[k].abs() < times * sigma[k] + 1e-9), "{what}, {t}: {error:?} {sigma:?}");
    }
    assert!(record.notes.iter().all(|note| !note.contains("NOT CONSISTENT")), "{what}: {:?}", record.notes);
}

fn last(record: &Record) -> ([f64; 9], [f64; 9]) {
    let (_, error, sigma) = errors(record).pop().unwrap();
    (error, sigma)
}

/// Three standard deviations hold 99.7 % of a component; of 9 components in 300 correlated rows some may pass them, none 4.5.
const CLAIMED: f64 = 4.5;

#[test]
fn every_condition_alone_is_as_good_as_claimed() {
    let data = Data::simulated("conditions", DRIVE, &["seed=11"]);
    let run = |text: &str| data.navigate_as(FROM_REST, &[&measurements(text)]).unwrap();
    let standing = "windows: [[0 s, 119 s]]";
    // What a filter without anything claims in the end, a height that says nothing being its only measurement.
    let free = last(&run("{ height: { file: height.csv, sigma: 100 km } }")).1;

    let zero_velocity = run(&format!("{{ zero_velocity: {{ sigma: 0.01 m/s, {standing} }} }}"));
    assert_claimed(&zero_velocity, CLAIMED, "zero velocity");
    let (_, sigma) = last(&zero_velocity);
    // Tilt and the biases seen through it are known while it stands, so that the drive after it is far better than without.
    assert!(sigma[0] < 0.2 * free[0] && sigma[1] < 0.2 * free[1], "{sigma:?} {free:?}");

    let zero_rate = run(&format!("{{ zero_rate: {{ sigma: 0.02 deg/s, every: 0.1 s, {standing} }} }}"));
    assert_claimed(&zero_rate, CLAIMED, "zero rate");
    let (_, sigma) = last(&zero_rate);
    // 0.02 deg/s at 1190 samples tell 2 deg/h: of the biases, 2 deg/h themselves, 0.7 remain.
    assert!(sigma[6] < 0.9 * free[6] && sigma[7] < 0.9 * free[7], "{sigma:?} {free:?}");

    let wheels = run("{ non_holonomic: { sigma: 0.02 m/s, every: 0.5 s } }");
    assert_claimed(&wheels, CLAIMED, "non-holonomic");
    let (_, sigma) = last(&wheels);
    assert!(sigma[0] < 0.1 * free[0] && sigma[2] < 0.1 * free[2], "{sigma:?} {free:?}");

    let height = run("{ height: { file: height.csv } }");
    assert_claimed(&height, CLAIMED, "height");
    assert_within(update(&height, "height", "nis_ratio"), band(335, 1e-4), "height");
    assert!(last(&height).1[2] < 1.0);

    let heading = run("{ heading: { file: heading.csv } }");
    assert_claimed(&heading, CLAIMED, "heading");
    assert_within(update(&heading, "heading", "nis_ratio"), band(335, 1e-4), "heading");
    assert!(last(&heading).1[8] < 0.15f64.to_radians());
}

/// A point that does not slip is where the wheels are: an IMU ahead of the axle swings out in turns. With the right lever arm the
/// filter is consistent; taken as zero, 3 m times 0.3 rad/s is 0.9 m/s, which the report must say.
#[test]
fn the_lever_arm_of_the_axle_counts() {
    let data = Data::simulated("axle", DRIVE, &["seed=12"]);
    // The trajectory's point does not slip, so that one 3 m ahead of it moves sideways.
    let run = |x: f64| {
        let text =
            format!("{{ non_holonomic: {{ sigma: 0.02 m/s, every: 0.5 s, lever_arm: [{x} m, 0 m, 0 m] }} }}");
        data.navigate_as(FROM_REST, &[&measurements(&text)]).unwrap()
    };
    assert_claimed(&run(0.0), CLAIMED, "the axle");
    let wrong = run(3.0);
    assert!(wrong.notes.iter().any(|note| note.starts_with("NOT CONSISTENT")), "{:?}", wrong.notes);
}

/// From the average of a window: TRIAD with gyros of 2 deg/h knows heading to 2 deg/h / (15 deg/h cos 47 deg) = 11 deg, so the drive
/// has better ones here.
#[test]
fn a_start_from_a_window() {
    let better = "imu.gyro=[{ bias: { constant: { sigma: 0.02 deg/h } } }, { bias: { white: { density: 0.002 deg/sqrt(h) } } }]";
    let data = Data::simulated("window", DRIVE, &["seed=13", better]);
    // Biases of 0.02 deg/h and noise of 0.002 deg/sqrt(h) over 110 s: heading to (0.02² + 0.011²)^1/2 / 10.26 = 0.13 deg;
    // 0.5 mg tilt by 1.7 arcmin.
    let record = data
        .navigate_as(
            &FROM_REST.replace("  attitude: { roll: 0.1 deg, pitch: -0.1 deg, yaw: 30.4 deg }\n  velocity: { n: 0 m/s, e: 0 m/s, d: 0 m/s }\n", ""),
            &[
                "align={ method: triad, window: [0 s, 110 s] }",
                "filter.gyro=[{ bias: { constant: { sigma: 0.02 deg/h } } }, { bias: { white: { density: 0.002 deg/sqrt(h) } } }]",
                "filter.tilt=0.03 deg",
                "filter.heading=0.15 deg",
            ],
        )
        .unwrap();
    let rows = errors(&record);
    assert!((rows[0].0 - 110.0).abs() < 1e-9);
    assert_claimed(&record, CLAIMED, "from a window");
    assert_within(update(&record, "position", "nis_ratio"), band(675, 1e-4), "position");
}
