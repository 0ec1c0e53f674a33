//! Navigation with a filter: nanoseconds a sample of the IMU beyond reading it, at 200 Hz with a position a second.
//!
//! `cargo bench -p schuler-studies --bench navigate`.

use divan::{Bencher, black_box, counter::ItemsCount};
use schuler_frames::{Geodetic, Gravity, Rot, Vec3};
use schuler_strapdown::filter::{Position, measurement::ALL};
use schuler_strapdown::{Increments, LocalLevel, Pva, Vertical};
use schuler_studies::Scenario;
use schuler_studies::navigate::aided::ClosedLoop;
use schuler_studies::scenario::{Aided, Study};

const SAMPLES: u64 = 20_000;
const RATE: u64 = 200;
const DT: f64 = 1.0 / RATE as f64;

fn main() {
    divan::main();
}

/// Settings of a filter that knows white noise and these further sources of each instrument.
fn aided(sources: &str) -> Aided {
    let text = format!(
        "
schuler: 1
study: navigate
title: Bench
start: {{ position: {{ lat: 45 deg, lon: 7 deg, h: 300 m }}, attitude: {{ roll: 0 deg, pitch: 0 deg, yaw: 0 deg }} }}
log:
  file: none.csv
  rate: 200 Hz
  content: increments
  columns: {{ gyro: [1, 2, 3], accel: [4, 5, 6] }}
  scale: {{ gyro: 1 rad, accel: 1 m/s }}
mechanization: {{ frame: t, vertical: free, gravity: normal }}
filter:
  gyro: [{{ bias: {{ white: {{ density: 0.1 deg/sqrt(h) }} }} }}, {{ bias: {{ constant: {{ sigma: 5 deg/h }} }} }}{sources}]
  accel: [{{ bias: {{ white: {{ density: 100 ug/sqrt(Hz) }} }} }}, {{ bias: {{ constant: {{ sigma: 1 mg }} }} }}{sources}]
  position: 5 m
  velocity: 0.5 m/s
  tilt: 0.5 deg
  heading: 1 deg
  measurements: {{ position: {{ file: none.csv, sigma: 1 m }} }}
"
    );
    match Scenario::load("bench.yaml", &text, &[]).expect("a scenario").study {
        Study::Aided(aided) => *aided,
        _ => unreachable!("a navigation with a filter"),
    }
}

/// At rest: where, what a sample holds, and a fix.
fn motion() -> (Pva, Increments, Position) {
    let place = Geodetic::new(45f64.to_radians(), 7f64.to_radians(), 300.0);
    let start = Pva { position: place, v_t: Vec3::ZERO, c_tb: Rot::IDENTITY };
    let f = -Gravity::Normal.gravity_t(place);
    let increments = Increments {
        dtheta: Vec3::new(5.16e-5 * DT, 0.0, -5.16e-5 * DT),
        dv: Vec3::claim(f.as_array().map(|x| x * DT)),
    };
    let fix = Position { position: place, sigma: [1.0; 3], lever: Vec3::new(1.0, 0.5, -1.0), axes: ALL };
    (start, increments, fix)
}

fn navigate<const N: usize>(bencher: Bencher, sources: &str) {
    let (start, increments, fix) = motion();
    let closed = ClosedLoop::<N>::new(&aided(sources), &start, Vertical::Free).expect("a filter");
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        let mut closed = closed.clone();
        for k in 1..=SAMPLES {
            closed.advance(black_box(&increments), DT);
            if k % RATE == 0 {
                closed.measure(&fix).expect("an update");
            }
        }
        closed.pva()
    });
}

/// Six more states.
const SCALE_FACTORS: &str = ", { scale_factor: { constant: { sigma: 100 ppm } } }";

#[divan::bench]
fn states_15(bencher: Bencher) {
    navigate::<16>(bencher, "");
}

#[divan::bench]
fn states_21(bencher: Bencher) {
    navigate::<24>(bencher, SCALE_FACTORS);
}

/// The navigator alone, for the ratio within a run.
#[divan::bench]
fn without_filter(bencher: Bencher) {
    let (start, increments, _) = motion();
    let navigator = LocalLevel::new(&start, Gravity::Normal, Vertical::Free);
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        let mut navigator = navigator;
        for _ in 0..SAMPLES {
            navigator.step(black_box(&increments), DT);
        }
        navigator.pva()
    });
}

/// A fix and what belongs to it, without the samples between.
#[divan::bench]
fn fix_alone_15(bencher: Bencher) {
    fix_alone::<16>(bencher, "");
}

#[divan::bench]
fn fix_alone_21(bencher: Bencher) {
    fix_alone::<24>(bencher, SCALE_FACTORS);
}

fn fix_alone<const N: usize>(bencher: Bencher, sources: &str) {
    let (start, increments, fix) = motion();
    let mut closed = ClosedLoop::<N>::new(&aided(sources), &start, Vertical::Free).expect("a filter");
    closed.advance(&increments, DT);
    bencher.bench_local(|| {
        closed.advance(black_box(&increments), DT);
        closed.measure(&fix).expect("an update");
    });
}
