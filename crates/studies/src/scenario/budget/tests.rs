//! Budgets that make no sense, and what people read then.

use crate::Scenario;

const BUDGET: &str = "\
schuler: 1
study: budget
title: A test
start: { position: { lat: 45 deg, lon: 0 deg, h: 0 m } }
motion: static
duration: 60 s
imu: { rate: 10 Hz, gyro: [bias: { constant: { sigma: 0.01 deg/h } }], accel: [] }
aiding:
  velocity: { rate: 1 Hz, sigma: 0.01 m/s }
mechanization: { frame: t, vertical: held, gravity: somigliana }
budget:
  alignment: { window: 100 s }
  filter: { tilt: 0.1 deg, heading: 1 deg, noise: { velocity: 0.02 m/s } }
  runs: 10
  runs_of: total
";

/// Changes, each of which makes it wrong.
const FAULTS: &[(&str, &str)] = &[
    ("window: 100 s", "window: 100.05 s"),
    (
        "h: 0 m } }\nmotion: static",
        "h: 0 m }, velocity: { n: 1 m/s, e: 0 m/s, d: 0 m/s } }\nmotion: constant_velocity",
    ),
    ("  filter:", "  initial_sigmas: { heading: 1 deg }\n  filter:"),
    ("aiding:\n  velocity: { rate: 1 Hz, sigma: 0.01 m/s }\n", ""),
    ("  velocity: { rate: 1 Hz, sigma: 0.01 m/s }\n", "  {}\n"),
    ("  velocity: { rate", "  height: { rate: 1 Hz, sigma: 1 m }\n  velocity: { rate"),
    ("sigma: 0.01 m/s }\nmech", "sigma: 0 m/s }\nmech"),
    ("sigma: 0.01 m/s }\nmech", "sigma: 0.01 m/s, offset: 0.1 s }\nmech"),
    ("  filter: { tilt: 0.1 deg, heading: 1 deg, noise: { velocity: 0.02 m/s } }\n", ""),
    ("frame: t", "frame: e"),
    ("  runs: 10", "  requirement: { at: 60 s, probability: 95 % }\n  runs: 10"),
    ("  runs: 10", "  requirement: { down: 1 m, at: 60 s, probability: 95 % }\n  runs: 10"),
    ("  runs: 10", "  requirement: { heading: 1 m, at: 60 s, probability: 95 % }\n  runs: 10"),
    ("  runs: 10", "  requirement: { heading: 1 arcmin, at: 60.05 s, probability: 95 % }\n  runs: 10"),
    ("  runs: 10", "  requirement: { heading: 1 arcmin, at: 60 s, probability: 100 % }\n  runs: 10"),
    ("runs_of: total", "runs_of: totals"),
    (
        "motion: static",
        "motion: { segments: [accelerate: { to: 50 m/s, duration: 20 s }, climb: { height: 100 m, angle: 5 deg }, straight: { duration: 60 s }] }",
    ),
];

/// `messages.txt` holds what people read for each fault; it is reviewed as prose, not derived.
#[test]
fn messages() {
    let mut found = String::new();
    Scenario::load("a.yaml", BUDGET, &[]).unwrap_or_else(|e| panic!("{e}"));
    for (from, to) in FAULTS {
        let text = BUDGET.replace(from, to);
        assert_ne!(text, BUDGET, "{from} is not in the scenario");
        let text = if to.starts_with("sigma: 0 m/s") {
            text.replace(", noise: { velocity: 0.02 m/s }", "")
        } else {
            text
        };
        let error = Scenario::load("a.yaml", &text, &[]).expect_err(to);
        found += &format!("== {from:?} -> {to:?}\n{error}\n");
    }
    let expected = include_str!("messages.txt");
    for (found, expected) in found.split("== ").zip(expected.split("== ")) {
        assert_eq!(found, expected);
    }
    assert_eq!(found.len(), expected.len(), "{found}");
}

/// What the filter does not say is what is true.
#[test]
fn a_filter_that_says_nothing_believes_the_truth() {
    let text = BUDGET
        .replace("filter: { tilt: 0.1 deg, heading: 1 deg, noise: { velocity: 0.02 m/s } }", "filter: {}");
    let crate::scenario::Study::Budget(study) = Scenario::load("a.yaml", &text, &[]).expect("valid").study
    else {
        panic!("a budget")
    };
    let filter = study.filter.expect("a filter");
    assert_eq!((&filter.spec, &filter.believed), (&study.imu.spec, &filter.aiding));
    assert_eq!((filter.sigma, study.alignment), ([0.0; 9], 1000));
}
