//! What one more source costs a budget: as a column under transitions gathered over an interval, and with a covariance of
//! its own; items are IMU steps of one source. And what a whole study costs with more of them, to the last column of its tables;
//! items are IMU steps.
//!
//! `cargo bench -p schuler-studies --bench budget`; what counts is the ratio of the figures in one run.

use divan::{Bencher, black_box, counter::ItemsCount};
use nalgebra::{SMatrix, SVector};
use schuler_frames::{Geodetic, Gravity, Rot, Vec3};
use schuler_imu::{Instrument, Source, Spec, Truth, process::MAX_STATES};
use schuler_strapdown::filter::{Accumulator, Form, Model, NavStates};
use schuler_strapdown::{ErrorDynamics, Increments, Pva, Vertical};
use schuler_studies::budget::Columns;
use schuler_studies::{Context, Scenario};

/// IMU steps of an interval: one second at 100 Hz.
const STEPS: usize = 100;
/// Those of the intervals of the study at that rate.
const OF_STUDY: usize = 20;
const DT: f64 = 0.01;

/// Intervals in one sample of a single source, so that the clock's own time does not count.
const MANY: usize = 10;

/// Coefficients that columns answer to: three biases, three scale factors and six misalignments of both triads.
const RESPONSES: usize = 24;

/// Room for the states of one source, as the study has it.
const ROOM: usize = 9 + MAX_STATES;

fn main() {
    divan::main();
}

/// Columns of constants and initial errors: what grows with their number, transition and responses being there.
#[divan::bench(args = [64, 512, 2048, 8192])]
fn columns(bencher: Bencher, sources: usize) {
    columns_over(bencher, sources, STEPS);
}

/// The same over intervals of the study.
#[divan::bench(args = [64, 2048])]
fn columns_of_the_study(bencher: Bencher, sources: usize) {
    columns_over(bencher, sources, OF_STUDY);
}

fn columns_over(bencher: Bencher, sources: usize, steps: usize) {
    let mut columns = Columns::new();
    for k in 0..sources {
        columns.push([1.0; 9], k % (1 + RESPONSES), 0.5);
    }
    // Near the identity, so that numbers stay numbers.
    let phi =
        SMatrix::<f64, 9, 9>::from_fn(|i, j| if i == j { 0.999 } else { 1e-4 * (i + 2 * j) as f64 / 24.0 });
    let responses = [SVector::<f64, 9>::repeat(1e-6); 1 + RESPONSES];
    bencher
        .counter(ItemsCount::new(sources * steps))
        .bench_local(|| columns.advance(black_box(&phi), black_box(&responses)));
}

/// A budget of two minutes of flight, two rows, all its ways but runs, with so many constants in its list, of the same few kinds.
#[divan::bench(args = [6, 606], sample_count = 10)]
fn whole_study(bencher: Bencher, constants: usize) {
    let bias = |k: usize| format!("bias: {{ constant: {{ sigma: {}e-3 deg/h }} }}", k + 1);
    let of_gyro = |k: usize| format!("{}, ", bias(k));
    let of_accel = |k: usize| format!("{}, ", bias(k).replace("deg/h", "mg"));
    let list = |of: &dyn Fn(usize) -> String| (0..constants / 6).map(of).collect::<String>();
    let text = format!(
        "
schuler: 1
study: budget
title: Bench
start: {{ position: {{ lat: 45 deg, lon: 7 deg, h: 300 m }}, velocity: {{ n: 100 m/s, e: 0 m/s, d: 0 m/s }} }}
motion: {{ segments: [{{ turn: {{ angle: 90 deg, rate: 3 deg/s, ramp: 2 s }} }}, {{ straight: {{ duration: 60 s }} }}] }}
duration: 90 s
imu: {{ rate: 100 Hz, gyro: [{}], accel: [{}] }}
budget: {{ runs: 0 }}
mechanization: {{ frame: t, vertical: held, gravity: somigliana }}
output: {{ every: 90 s, formats: [csv] }}
",
        list(&of_gyro),
        list(&of_accel)
    );
    let scenario = Scenario::load("bench.yaml", &text, &[]).expect("a scenario");
    bencher
        .counter(ItemsCount::new(9000_usize))
        .bench_local(|| schuler_studies::run(&scenario, &Context::silent()).expect("a budget"));
}

/// A constant gyro bias with its covariance: transition accumulated step by step, and a time update an interval.
#[divan::bench]
fn covariance_of_its_own(bencher: Bencher) {
    let sigma = [("sigma", (&[4.8e-8, 0.0, 0.0][..]).into())];
    let source = Source::named(Instrument::Gyro, "bias", "constant", &sigma).expect("a source");
    let all = Spec::from_sources([source]).expect("a list");
    let one = all.components().next().expect("a component");
    let model = Model::<ROOM>::new(Form::Phi, NavStates::ALL, &all.only(&one)).expect("room");
    let place = Geodetic::new(0.8, 0.0, 0.0);
    let pva = Pva { position: place, v_t: Vec3::ZERO, c_tb: Rot::IDENTITY };
    let dynamics = ErrorDynamics { gravity: Gravity::Somigliana, vertical: Vertical::Held };
    let f = -Gravity::Somigliana.gravity_t(place);
    let seen = Truth::rates([5.1e-5, 0.0, -5.2e-5], f.as_array());
    let increments = Increments {
        dtheta: Vec3::new(5.1e-5 * DT, 0.0, -5.2e-5 * DT),
        dv: Vec3::claim(f.as_array().map(|x| x * DT)),
    };
    let mut accumulator = Accumulator::new(&model, dynamics, &pva);
    let start = model.p0(&[0.0; 9]).expect("standard deviations");
    bencher.counter(ItemsCount::new(MANY * STEPS)).bench_local(|| {
        let mut p = start;
        for _ in 0..MANY {
            for _ in 0..STEPS {
                accumulator.step_seen(&model, black_box(&pva), &seen, &increments, DT);
            }
            let step = accumulator.close(&model);
            step.transport(&mut p);
            step.diffuse(&mut p);
        }
        p
    });
}
