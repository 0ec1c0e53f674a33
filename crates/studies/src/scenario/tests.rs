use hifitime::Epoch;
use schuler_frames::Gravity;

use super::{Scenario, Statistic, Study, Vertical, json_schema};
use crate::Error;

const DRIFT: &str = "\
schuler: 1
study: drift
title: A test
start:
  epoch: 2026-01-01T00:00:00 UTC
  position: { lat: 45 deg, lon: 0 deg, h: 0 m }
motion: static
duration: 24 h
imu:
  rate: 100 Hz
  gyro:
    - bias: { constant: { value: [0.01 deg/h, 0 deg/h, 0 deg/h] } }
    - bias: { white: { density: 0.003 deg/sqrt(h) } }
  accel:
    - bias: { gauss_markov: { sigma: 50 ug, tau: 1 h } }
mechanization: { frame: t, vertical: held, gravity: somigliana }
output: { every: 60 s, formats: [csv] }
expect:
  - { quantity: dn_m, source: all, way: exact, at: 24 h, value: 1 km, tolerance: 1 % }
seed: 7
";

const IMU: &str = "\
schuler: 1
study: imu
title: A test
start: { position: { lat: 45 deg, lon: 0 deg, h: 0 m } }
motion: { rate_table: { rate: 30 deg/s, tilt: 30 deg, acceleration: 30 deg/s^2 } }
duration: 60 s
imu:
  rate: 100 Hz
  preset: stim300
  temperature: { ramp: { start: 20 degC, rate: 1 K/min } }
  readout:
    gyro:
      bandwidth: { natural_frequency: 200 Hz, damping: 0.7 }
      sampling: point
      range: 400 deg/s
      lsb: { size: 0.1 arcsec, carry: true }
    accel: { output: rates, faults: { drop: 1 % } }
output: { formats: [csv] }
";

/// Changes of the second scenario, each of which makes it wrong.
const IMU_FAULTS: &[(&str, &str)] = &[
    ("stim300", "stim3000"),
    ("20 degC", "-300 degC"),
    ("20 degC", "20"),
    ("20 degC", "20 s"),
    (
        "ramp: { start: 20 degC, rate: 1 K/min }",
        "table: [[0 s, 20 degC], [2 min, 30 degC], [1 min, 40 degC]]",
    ),
    ("ramp: { start: 20 degC, rate: 1 K/min }", "table: []"),
    ("ramp: { start: 20 degC, rate: 1 K/min }", "warmup: { start: 20 degC, end: 45 degC, tau: 10 min }"),
    ("ramp: { start: 20 degC, rate: 1 K/min }", "warm_up: { start: 20 degC, end: 45 degC, tau: 0 s }"),
    ("bandwidth: { natural_frequency: 200 Hz, damping: 0.7 }", "timing: { delay: 1 ms }"),
    ("damping: 0.7", "damping: 0"),
    ("range: 400 deg/s", "range: 4 g"),
    ("range: 400 deg/s", "range: 1 deg/s\n      range_low: 2 deg/s"),
    ("range: 400 deg/s", "range_low: 2 deg/s"),
    ("size: 0.1 arcsec", "size: 0.1 deg/s"),
    ("output: rates", "output: counts"),
    ("drop: 1 %", "drop: 60 %, repeat: 60 %"),
    ("drop: 1 %", "stick: 1 %"),
    ("drop: 1 %", "drop: -1 %"),
    ("30 deg/s^2", "3 deg/s^2"),
    ("formats: [csv]", "formats: [csv], allan: true"),
    ("study: imu", "study: drift"),
    ("duration: 60 s", "gravity: normal\nduration: 60 s"),
    (RATE_TABLE, "sway: { rol: { amplitude: 2 deg, period: 8 s } }"),
    (RATE_TABLE, "sway: { roll: { amplitude: 2 deg } }"),
    (RATE_TABLE, "sway: { roll: [{ amplitude: 2 m, period: 8 s }] }"),
    (RATE_TABLE, "sway: { roll: 2 deg }"),
    (RATE_TABLE, "positions: { rate: 10 deg/s, poses: [] }"),
    (RATE_TABLE, "positions: { rate: 10 deg/s, poses: [{ yaw: 0 deg }] }"),
    (RATE_TABLE, "positions: { rate: 10 deg/s, poses: [{ yaw: 0 deg, dwell: 10 s }] }"),
    (RATE_TABLE, "coning: { half_angle: 1 deg, frequency: 0 Hz }"),
    (RATE_TABLE, "segments: [{ stand: { duration: 5 s } }, { turn: { angle: 90 deg, radius: 100 m } }]"),
    (RATE_TABLE, "segments: [{ stand: { duration: 5 s } }, { turn: { angle: 90 deg } }]"),
    (RATE_TABLE, "segments: [{ strait: { duration: 5 s } }]"),
    (RATE_TABLE, "segments: [{ accelerate: { to: 13 km/s, duration: 5 s } }]"),
    (
        RATE_TABLE,
        "segments: [{ accelerate: { to: 9 m/s, duration: 5 s } }, { climb: { height: 9 m, angle: 90 deg } }]",
    ),
    (RATE_TABLE, "segments: [{ accelerate: { to: 9 m/s, duration: 5 s } }, { stand: { duration: 5 s } }]"),
    (RATE_TABLE, "great_circle: { speed: 250 m/s }"),
    (RATE_TABLE, "great_circle: { speed: 250 m/s, to: [95 deg, 0 deg] }"),
    (RATE_TABLE, "shaken: { motion: zero_truth }"),
    (
        RATE_TABLE,
        "waypoints: { points: [{ lat: 45.1 deg, lon: 0 deg, time: 90 s }, { lat: 45.2 deg, lon: 0 deg, time: 80 s }] }",
    ),
    (RATE_TABLE, "waypoints: { points: [{ lat: 45.1 deg, lon: 0 deg, time: 90 s, speed: 5 m/s }] }"),
    (RATE_TABLE, "waypoints: { points: [{ lat: 46 deg, lon: 0 deg, time: 1 s }] }"),
    (RATE_TABLE, "file: { file: a.csv, knots: 0 s }"),
    (RATE_TABLE, "file: { file: a.csv, knots: 1 s }"),
    ("h: 0 m }", "h: 0 m }, velocity: { n: 1 m/s, e: 0 m/s, d: 0 m/s }"),
];

const RATE_TABLE: &str = "rate_table: { rate: 30 deg/s, tilt: 30 deg, acceleration: 30 deg/s^2 }";

const SIMULATE: &str = "\
schuler: 1
study: simulate
title: A test
start:
  position: { lat: 45 deg, lon: 0 deg, h: 0 m }
  velocity: { n: 0 m/s, e: 100 m/s, d: 0 m/s }
motion: { segments: [{ straight: { duration: 60 s } }] }
gravity: normal
imu: { rate: 100 Hz }
aiding:
  position: { rate: 1 Hz, sigma: 1 m, outages: [[10 s, 20 s]] }
  heading: { rate: 1 Hz, sigma: 1 deg }
";

/// Changes of the third scenario, each of which makes it wrong.
const SIMULATE_FAULTS: &[(&str, &str)] = &[
    ("gravity: normal\n", ""),
    ("gravity: normal", "gravity: normal\nduration: 61 s"),
    ("gravity: normal", "gravity: normal\nmechanization: { frame: t, vertical: free, gravity: normal }"),
    ("velocity: {", "attitude: { roll: 0 deg, pitch: 0 deg, yaw: 45 deg }\n  velocity: {"),
    ("{ segments: [{ straight: { duration: 60 s } }] }", "zero_truth"),
    ("{ segments: [{ straight: { duration: 60 s } }] }", "static"),
    ("{ segments: [{ straight: { duration: 60 s } }] }", "constant_velocity"),
    ("duration: 60 s", "duration: 60 s, distance: 5 m"),
    ("e: 100 m/s", "e: 100 km/s"),
    ("rate: 1 Hz, sigma: 1 m", "rate: 3 Hz, sigma: 1 m"),
    ("sigma: 1 m", "sigma: 1 m/s"),
    ("[10 s, 20 s]", "[20 s, 10 s]"),
    ("sigma: 1 deg", "sigma: 1 deg, lever_arm: [1 m, 0 m, 0 m]"),
    ("heading", "speed"),
];

/// Changes of the first scenario, each of which makes it wrong.
const FAULTS: &[(&str, &str)] = &[
    ("seed: 7", "sede: 7"),
    ("motion: static", "motion: statik"),
    ("motion: static", "motion: rate_table"),
    ("motion: static", "motion: { static: 3 }"),
    ("motion: static\n", ""),
    ("duration: 24 h", "duration: 24"),
    ("duration: 24 h", "duration: '24'"),
    ("duration: 24 h", "duration: 0 h"),
    ("duration: 24 h", "duration: 24 hh"),
    ("duration: 24 h", "duration: 24 m"),
    ("duration: 24 h", "duration: [24 h]"),
    ("duration: 24 h", "duration:"),
    ("lat: 45 deg", "lat: 95 deg"),
    ("lat: 45 deg", "lta: 45 deg"),
    ("lat: 45 deg, ", ""),
    ("density: 0.003", "density: -0.003"),
    ("deg/sqrt(h)", "deg/h"),
    ("0 deg/h, 0 deg/h]", "0 deg/h]"),
    ("white:", "pink:"),
    ("- bias: { white", "- bais: { white"),
    ("sigma: 50 ug, tau: 1 h", "sigma: 50 ug"),
    ("tau: 1 h", "Tau: 1 h"),
    ("100 Hz", "0 Hz"),
    ("held", "{ damped: { order: 4, tau: 100 s } }"),
    ("2026-01-01T00", "2026-13-01T00"),
    ("dn_m", "dx_m"),
    ("at: 24 h", "at: noon"),
    ("tolerance: 1 %", "tolerance: 1 deg"),
    ("every: 60 s", "every: 0.015 s"),
    ("mechanization", "log: { }\nmechanization"),
    ("mechanization", "initial_errors: { tilt: [1 deg] }\nmechanization"),
    ("gravity: somigliana", "gravity: egm2008"),
    ("frame: t", "frame: ned"),
    ("gravity: somigliana", "gravity: somigliana, coning: five"),
    (
        "frame: t, vertical: held, gravity: somigliana",
        "frame: euler, vertical: held, gravity: somigliana, coning: two",
    ),
    (
        "gravity: somigliana }\noutput: { every: 60 s",
        "gravity: somigliana, coning: four }\noutput: { every: 0.05 s",
    ),
    ("schuler: 1", "schuler: 2"),
    ("title: A test", "title: A test\nduratoin: 1 h"),
    ("h: 0 m", "h: 200000 km"),
    ("motion: static", "motion: zero_truth"),
    ("h: 0 m }", "h: 0 m }\n  velocity: { n: 1 m/s, e: 0 m/s, d: 0 m/s }"),
    ("seed: 7", "seed: -7"),
    ("seed: 7", "seed: 7\nseed: 8"),
    ("seed: 7", "seed: [7"),
    ("rate: 100 Hz", "rate: 100 Hz\n  readout: { gyro: { lsb: { size: 0.1 arcsec } } }"),
    ("rate: 100 Hz", "rate: 100 Hz\n  temperature: { ramp: { start: 20 degC, rate: 1 K/min } }"),
    ("every: 60 s", "every: 60 s, allan: true"),
    ("title: A test", "title: [A, test]"),
    (
        "title: A test",
        "title: &a [x,x,x,x,x,x,x,x,x,x]\nb: &b [*a,*a,*a,*a,*a,*a,*a,*a,*a,*a]\nc: &c [*b,*b,*b,*b,*b,*b,*b,*b,*b,*b]\nd: &d [*c,*c,*c,*c,*c,*c,*c,*c,*c,*c]\ne: &e [*d,*d,*d,*d,*d,*d,*d,*d,*d,*d]",
    ),
];

const SETTINGS: &[&str] = &[
    "imu.rate=0 Hz",
    "imu.gyro[1].bias.white.density=3",
    "imu.gyro[9].bias=3",
    "imu.rat=3 Hz",
    "seed",
    "seed=[1",
];

fn load(text: &str, overrides: &[&str]) -> Result<Scenario, Error> {
    let overrides: Vec<String> = overrides.iter().map(|s| String::from(*s)).collect();
    Scenario::load("a.yaml", text, &overrides)
}

/// `messages.txt` holds what people read for each fault; it is reviewed as prose, not derived.
#[test]
fn messages() {
    let mut found = String::new();
    let drift = FAULTS.iter().map(|fault| (DRIFT, fault));
    let imu = IMU_FAULTS.iter().map(|fault| (IMU, fault));
    let simulate = SIMULATE_FAULTS.iter().map(|fault| (SIMULATE, fault));
    for (base, (from, to)) in drift.chain(imu).chain(simulate) {
        let text = base.replace(from, to);
        assert_ne!(text, base, "{from} is not in the scenario");
        let error = load(&text, &[]).expect_err(to);
        found += &format!("== {from:?} -> {to:?}\n{error}\n");
    }
    for setting in SETTINGS {
        let error = load(DRIFT, &[setting]).expect_err(setting);
        found += &format!("== --set {setting}\n{error}\n");
    }
    // A new term or process is no change of a message.
    let terms: Vec<&str> = schuler_imu::TERMS
        .iter()
        .filter(|t| t.instruments().contains(&schuler_imu::Instrument::Gyro))
        .map(|t| t.name())
        .collect();
    let processes: Vec<&str> = schuler_imu::PROCESSES.iter().map(|p| p.name()).collect();
    let presets: Vec<&str> = schuler_imu::preset::presets().map(|p| p.name).collect();
    for (words, name) in
        [(terms, "<terms of the instrument>"), (processes, "<processes>"), (presets, "<presets>")]
    {
        found = found.replace(&super::de::one_of(&words), &format!("one of {name}"));
    }
    let expected = include_str!("messages.txt");
    for (found, expected) in found.split("== ").zip(expected.split("== ")) {
        assert_eq!(found, expected);
    }
    assert_eq!(found.len(), expected.len());
}

#[test]
fn a_scenario_in_si() {
    let scenario = load(DRIFT, &[]).expect("valid");
    let Study::Drift(drift) = &scenario.study else { panic!("a drift study") };
    assert_eq!(scenario.seed, 7);
    assert_eq!(drift.samples, 8_640_000);
    assert_eq!(drift.start.position.lat, 45f64.to_radians());
    assert_eq!(drift.start.epoch, Some(Epoch::from_gregorian_utc_at_midnight(2026, 1, 1)));
    assert_eq!(drift.mechanization.gravity, Gravity::Somigliana);
    assert_eq!(drift.mechanization.vertical, Vertical::Held);
    assert_eq!(scenario.output.every, Some(60.0));
    let expect = &scenario.expect[0];
    assert_eq!((expect.at, expect.value, expect.tolerance), (Statistic::Time(86_400.0), 1000.0, 10.0));
    let names: Vec<String> = drift.imu.spec.components().map(|c| c.to_string()).collect();
    assert_eq!(names[0], "gyro.bias.constant.x");
    assert_eq!(names.len(), 9);
}

#[test]
fn settings_change_the_document() {
    let of = |settings: &[&str]| load(DRIFT, settings).unwrap_or_else(|e| panic!("{settings:?}: {e}"));
    assert_eq!(of(&["seed=8"]).seed, 8);
    // A setting of what is written already, in another unit, is the same scenario.
    assert_eq!(of(&["duration=1 d"]), of(&[]));
    let Study::Drift(drift) = of(&["imu.gyro=[]", "imu.rate=1 kHz", "initial_errors.heading=1 arcmin"]).study
    else {
        panic!("a drift study")
    };
    assert_eq!((drift.imu.spec.components().count(), drift.samples), (3, 86_400_000));
    assert_eq!(drift.initial_errors[0].name, "initial.heading.d");
    assert_eq!(drift.initial_errors[0].phi[2], (1.0f64 / 60.0).to_radians());
}

#[test]
fn the_hash_knows_numbers_and_nothing_else() {
    let hash = |text: &str| load(text, &[]).expect("valid").hash;
    let same = DRIFT.replace("24 h", "1440 min").replace("A test", "Another").replace("seed: 7\n", "")
        + "seed: 7 # last\n";
    assert_eq!(hash(DRIFT), hash(&same));
    assert_ne!(hash(DRIFT), hash(&DRIFT.replace("0.003", "0.0030001")));
    assert_ne!(hash(DRIFT), hash(&DRIFT.replace("seed: 7", "seed: 8")));
}

/// The semi-axes of WGS 84 as Earth-fixed positions: points of the equator and of the pole at height 0.
#[test]
fn earth_fixed_positions() {
    let at = |x: &str, z: &str| {
        let position = format!("position: {{ x: {x}, y: 0 m, z: {z} }}");
        let scenario = load(&DRIFT.replace("position: { lat: 45 deg, lon: 0 deg, h: 0 m }", &position), &[]);
        let Study::Drift(drift) = scenario.expect("valid").study else { panic!("a drift study") };
        drift.start.position
    };
    let equator = at("6378137 m", "0 m");
    assert!(equator.lat.abs() < 1e-15 && equator.h.abs() < 1e-8);
    let pole = at("0 m", "6356752.314245 m");
    assert!((pole.lat.to_degrees() - 90.0).abs() < 1e-12 && pole.h.abs() < 1e-6);
}

/// Every key of the schema has a working example for messages.
#[test]
fn every_key_has_an_example() {
    let schema: serde_json::Value = serde_json::from_str(&json_schema()).expect("JSON");
    let example = [include_str!("example.yaml"), include_str!("example_motion.yaml")].concat();
    let mut keys: Vec<&String> = Vec::new();
    let root = schema["properties"].as_object().expect("keys");
    keys.extend(root.keys());
    for (name, definition) in schema["$defs"].as_object().expect("definitions") {
        // Words of enumerations are listed by the message itself; sources have examples of their own.
        if !matches!(name.as_str(), "Sources" | "RateTable" | "Damping" | "Ramp") {
            keys.extend(definition["properties"].as_object().into_iter().flat_map(|p| p.keys()));
        }
    }
    for key in keys {
        assert!(example.contains(&format!("{key}:")), "example.yaml has no `{key}`");
    }
}

/// What a message shows for a process is taken, on every term of every instrument.
#[test]
fn examples_of_sources_work() {
    use schuler_imu::{Instrument, PROCESSES, TERMS};
    for instrument in Instrument::ALL {
        for term in TERMS.iter().filter(|t| t.instruments().contains(&instrument)) {
            for process in PROCESSES {
                let example = super::process_example(*process, term.unit(instrument));
                let setting = format!("imu.{instrument}=[{{ {}: {example} }}]", term.name());
                load(DRIFT, &[&setting]).unwrap_or_else(|e| panic!("{setting}: {e}"));
            }
        }
    }
}
