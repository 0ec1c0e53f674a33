//! Alignments that make no sense, and what people read then.

use crate::Scenario;

const ALIGN: &str = "\
schuler: 1
study: align
title: A test
start: { position: { lat: 45 deg, lon: 0 deg, h: 0 m } }
motion: static
duration: 60 s
imu: { rate: 10 Hz, gyro: [], accel: [] }
mechanization: { frame: t, vertical: held, gravity: somigliana }
alignment:
  coarse: { sigma: { tilt: 0.1 deg, heading: 1 deg } }
  velocity: { every: 1 s, noise: 0.02 m/s, burst: { window: [20 s, 30 s], factor: 3 } }
  filter: { gyro: [], accel: [] }
  methods:
    - triad: { order: force_first }
    - filter: { strategy: { multiple_fading: { gate: 0.1 % } } }
  runs: 10
";

/// Changes, each of which makes it wrong.
const FAULTS: &[(&str, &str)] = &[
    ("alignment:", "align: { method: triad, window: [0 s, 1 s] }\nalignment:"),
    ("motion: static", "motion: constant_velocity"),
    ("motion: static", "motion: zero_truth"),
    ("frame: t", "frame: e"),
    ("  coarse: { sigma: { tilt: 0.1 deg, heading: 1 deg } }\n", ""),
    ("sigma: { tilt: 0.1 deg, heading: 1 deg }", "triad: { window: 60 s }"),
    ("sigma: { tilt: 0.1 deg, heading: 1 deg }", "value: { tilt: [0.1 deg, 0.1 deg], heading: 1 deg }"),
    ("every: 1 s", "every: 0.15 s"),
    ("[20 s, 30 s]", "[30 s, 20 s]"),
    ("[20 s, 30 s]", "[60 s, 70 s]"),
    ("every: 1 s", "every: 61 s"),
    ("runs: 10", "knock: { at: 60 s, tilt: [0 deg, 0 deg], heading: 1 deg }"),
    ("{ gyro: [], accel: [] }\n  methods", "{ accel: [] }\n  methods"),
    ("{ gyro: [], accel: [] }\n  methods", "{ gyro: [], accel: [], noise: 1 m }\n  methods"),
    ("- triad: { order: force_first }", "- triads: {}"),
    ("- triad: { order: force_first }", "- filter: { name: filter, strategy: residual_noise }"),
    ("order: force_first", "order: gravity_first"),
    ("gate: 0.1 %", "gate: 200 %"),
    ("multiple_fading: { gate: 0.1 % }", "fading: { factor: 0.99 }"),
    ("multiple_fading: { gate: 0.1 % }", "strong_tracking: { beta: 0 }"),
    ("multiple_fading: { gate: 0.1 % }", "batch_noise: { length: 0 }"),
    ("runs: 10", "runs: 0"),
    ("runs: 10", "window: 300 s"),
    ("runs: 10", "navigate: 0 s"),
    (
        "duration: 60 s",
        "duration: 60 s\nlog: { file: a.csv, rate: 10 Hz, content: rates, columns: { gyro: [1, 2, 3], accel: [4, 5, 6] }, scale: { gyro: 1 deg/s, accel: 1 g } }",
    ),
];

/// `messages.txt` holds what people read for each fault; it is reviewed as prose, not derived.
#[test]
fn messages() {
    let mut found = String::new();
    Scenario::load("a.yaml", ALIGN, &[]).unwrap_or_else(|e| panic!("{e}"));
    for (from, to) in FAULTS {
        let text = ALIGN.replace(from, to);
        assert_ne!(text, ALIGN, "{from} is not in the scenario");
        let error = Scenario::load("a.yaml", &text, &[]).expect_err(to);
        found += &format!("== {from:?} -> {to:?}\n{error}\n");
    }
    let expected = include_str!("messages.txt");
    for (found, expected) in found.split("== ").zip(expected.split("== ")) {
        assert_eq!(found, expected);
    }
    assert_eq!(found.len(), expected.len(), "{found}");
}
