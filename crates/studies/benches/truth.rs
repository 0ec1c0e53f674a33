//! Increments of true motion: nanoseconds a sample.
//!
//! `cargo bench -p schuler-studies --bench truth`.

use divan::{Bencher, black_box, counter::ItemsCount};
use schuler_frames::{Euler, Geodetic, Gravity};
use schuler_studies::trajectory::{
    Course, Segment, Segments, Sharpness, Sine, Still, Sway, SwayAxes, Truth, Turn,
};

const PLACE: Geodetic = Geodetic::new(0.8, 0.2, 300.0);
const SAMPLES: u64 = 10_000;
const DT: f64 = 0.01;

fn main() {
    divan::main();
}

fn increments(bencher: Bencher, truth: &Truth) {
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        for k in 0..SAMPLES {
            black_box(truth.increments(k as f64 * DT, DT));
        }
    });
}

const FIELDS: [Gravity; 2] = [Gravity::Normal, Gravity::Somigliana];

/// Turns, climbs and straights.
#[divan::bench(args = FIELDS)]
fn segments(bencher: Bencher, gravity: Gravity) {
    let turn = Turn { sharpness: Sharpness::Rate(0.05), ramp: 2.0, flat: false };
    let start = Course { position: PLACE, speed: 80.0, heading: 0.7, climb: 0.0, roll: 0.0 };
    let parts = [
        Segment::Straight { duration: 10.0 },
        Segment::Climb { height: 100.0, angle: 0.1, ramp: 3.0 },
        Segment::Turn { angle: 1.5, turn },
        Segment::STurn { angle: 0.5, turn },
    ];
    let flight = Segments::new(start, &parts, gravity).expect("a flight");
    increments(bencher, &Truth::new(flight, gravity));
}

/// A ship at its moorings.
#[divan::bench(args = FIELDS)]
fn sway(bencher: Bencher, gravity: Gravity) {
    let sine = |amplitude, omega| vec![Sine { amplitude, omega, phase: 0.3 }];
    let axes = SwayAxes {
        roll: sine(0.05, 0.8),
        pitch: sine(0.03, 1.0),
        yaw: sine(0.02, 0.6),
        n: sine(0.3, 0.9),
        e: sine(0.3, 0.7),
        d: sine(0.5, 1.2),
    };
    increments(bencher, &Truth::new(Sway::new(PLACE, Euler::default(), axes), gravity));
}

/// At rest.
#[divan::bench(args = FIELDS)]
fn still(bencher: Bencher, gravity: Gravity) {
    increments(bencher, &Truth::new(Still::new(PLACE, Euler::default()), gravity));
}
