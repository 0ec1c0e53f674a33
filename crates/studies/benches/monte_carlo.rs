//! Runs of a Monte Carlo: nanoseconds a run-step (one sample of one run), with all noises of a tactical grade, local level.
//!
//! `cargo bench -p schuler-studies --bench monte_carlo`. Compare the lines of one run.
//!
//! `by_hand` is the yardstick: the same set of errors written out without any generality, drawn by `StandardNormal` over `StdRng`,
//! and one navigator of the library stepped with it; `30` draws state and interval mean of the processes that have
//! both, as one writes it, `18` the innovations that the library draws. `runs` is the study itself, whole, in so many threads.

use divan::{Bencher, black_box, counter::ItemsCount};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};
use schuler_frames::{Geodetic, Gravity, Rot, Vec3};
use schuler_imu::{
    Instrument, Source, Value,
    process::{Innovation, Step},
};
use schuler_strapdown::{Increments, LocalLevel, Pva, Vertical};
use schuler_studies::{Context, Record, Scenario, monte_carlo, scenario::Study};

const RATE: u64 = 200;
const SAMPLES: u64 = 40_000;
const RUNS: u64 = 128;

fn main() {
    divan::main();
}

fn scenario(motion: &str, runs: u64) -> Scenario {
    let text = format!(
        "
schuler: 1
study: monte_carlo
title: Bench
start: {{ position: {{ lat: 45 deg, lon: 7 deg, h: 300 m }}, attitude: {{ roll: 0 deg, pitch: 0 deg, yaw: 0 deg }} }}
motion: {motion}
duration: {} s
imu:
  rate: {RATE} Hz
  gyro: [bias: {{ constant: {{ sigma: 1 deg/h }} }}, bias: {{ white: {{ density: 0.1 deg/sqrt(h) }} }}, bias: {{ random_walk: {{ density: 1 deg/h/sqrt(h) }} }}, bias: {{ gauss_markov: {{ sigma: 1 deg/h, tau: 100 s }} }}, scale_factor: {{ constant: {{ sigma: 300 ppm }} }}, misalignment: {{ constant: {{ sigma: 1 mrad }} }}]
  accel: [bias: {{ constant: {{ sigma: 1 mg }} }}, bias: {{ white: {{ density: 100 ug/sqrt(Hz) }} }}, bias: {{ random_walk: {{ density: 100 ug/sqrt(h) }} }}, bias: {{ gauss_markov: {{ sigma: 100 ug, tau: 100 s }} }}, scale_factor: {{ constant: {{ sigma: 300 ppm }} }}, misalignment: {{ constant: {{ sigma: 1 mrad }} }}]
monte_carlo: {{ runs: {runs} }}
mechanization: {{ frame: t, vertical: held, gravity: somigliana }}
output: {{ every: 10 s, formats: [csv] }}
",
        SAMPLES / RATE
    );
    Scenario::load("bench.yaml", &text, &[]).expect("a scenario")
}

fn pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

fn study(scenario: &Scenario, pool: &rayon::ThreadPool) -> Record {
    let Study::MonteCarlo(study) = &scenario.study else { unreachable!("a Monte Carlo") };
    pool.install(|| monte_carlo::run(scenario, study, &Context::silent()).expect("runs"))
}

fn whole(bencher: Bencher, motion: &str, threads: usize) {
    let (scenario, pool) = (scenario(motion, RUNS), pool(threads));
    bencher.counter(ItemsCount::new(RUNS * SAMPLES)).bench_local(|| study(&scenario, &pool));
}

/// At rest.
#[divan::bench(args = [1, 2], sample_count = 10)]
fn runs(bencher: Bencher, threads: usize) {
    whole(bencher, "static", threads);
}

/// What the machine gives: two studies of one thread each, which share nothing. Two threads of one study cannot be faster.
#[divan::bench(sample_count = 10)]
fn runs_apart(bencher: Bencher) {
    let two = [1, 2].map(|_| (scenario("static", RUNS), pool(1)));
    bencher.counter(ItemsCount::new(2 * RUNS * SAMPLES)).bench_local(|| {
        std::thread::scope(|scope| {
            let started = two.each_ref().map(|(scenario, pool)| scope.spawn(|| study(scenario, pool)));
            started.map(|thread| thread.join().expect("runs"))
        })
    });
}

/// Along a flight, whose truth is calculated once for all runs and whose prediction sample by sample.
#[divan::bench(args = [1, 2], sample_count = 10)]
fn runs_in_flight(bencher: Bencher, threads: usize) {
    let motion = "{ segments: [accelerate: { to: 80 m/s, duration: 20 s }, turn: { angle: 90 deg, rate: 3 deg/s, ramp: 2 s }, straight: { duration: 160 s }] }";
    whole(bencher, motion, threads);
}

/// A process with one state: transition, mean of the state, and what its normals add to mean and state.
struct ByHand {
    phi: f64,
    mean: f64,
    to_mean: [f64; 2],
    to_state: f64,
}

impl ByHand {
    fn new(process: &str, given: &[(&str, Value<'_>)], dt: f64, draws: usize) -> ByHand {
        let source = Source::named(Instrument::Gyro, "bias", process, given).expect("valid");
        let e = source.components().next().expect("three axes").evolution();
        let step: Step = e.kind.step(&e.arguments, 0, dt);
        let (phi, mean) = (step.phi[0][0], step.mean[0]);
        if draws == 30 {
            let [[to_state, ..], _, [a, _, b]] = step.noise;
            return ByHand { phi, mean, to_mean: [a, b], to_state };
        }
        let mut now = Innovation::default();
        (0..50).for_each(|_| now = step.innovation(&now.covariance));
        ByHand { phi, mean, to_mean: [now.s, 0.0], to_state: now.k[0] }
    }
}

#[divan::bench(consts = [18, 30], sample_count = 20)]
fn by_hand<const DRAWS: usize>(bencher: Bencher) {
    let dt = 1.0 / RATE as f64;
    let mut rng = StdRng::seed_from_u64(1);
    let walk = ByHand::new("random_walk", &[("density", 1e-6.into())], dt, DRAWS);
    let markov = ByHand::new("gauss_markov", &[("sigma", 5e-6.into()), ("tau", 100.0.into())], dt, DRAWS);
    let white = 3e-5 / dt.sqrt();
    let (bias, scale, cross) = ([5e-6; 6], [3e-4; 6], [[1e-3; 3]; 6]);
    let place = Geodetic::new(45f64.to_radians(), 7f64.to_radians(), 300.0);
    let start = Pva { position: place, v_t: Vec3::ZERO, c_tb: Rot::IDENTITY };
    let f = (-Gravity::Somigliana.gravity_t(place)).as_array();
    let omega = [5.156e-5, 0.0, -5.156e-5];
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        let mut navigator = LocalLevel::new(&start, Gravity::Somigliana, Vertical::Held);
        let (mut b, mut m) = ([0.0; 6], [0.0; 6]);
        for _ in 0..SAMPLES {
            let (omega, f) = black_box((&omega, &f));
            let mut measured = [0.0; 6];
            for i in 0..6 {
                let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
                let input = if i < 3 { omega } else { f };
                // Of each process the normal of its state, and where they are drawn that of its mean.
                let (w1, v1) = (draw(), if DRAWS == 30 { draw() } else { 0.0 });
                let (w2, v2) = (draw(), if DRAWS == 30 { draw() } else { 0.0 });
                let walked = walk.mean * b[i] + walk.to_mean[0] * w1 + walk.to_mean[1] * v1;
                let correlated = markov.mean * m[i] + markov.to_mean[0] * w2 + markov.to_mean[1] * v2;
                b[i] = walk.phi * b[i] + walk.to_state * w1;
                m[i] = markov.phi * m[i] + markov.to_state * w2;
                let noise = walked + correlated + white * draw();
                let linear: f64 = (0..3).map(|j| cross[i][j] * input[j]).sum();
                measured[i] = (input[i % 3] + bias[i] + noise + scale[i] * input[i % 3] + linear) * dt;
            }
            let [a, b, c, d, e, f] = measured;
            navigator.step(&Increments { dtheta: Vec3::new(a, b, c), dv: Vec3::new(d, e, f) }, dt);
        }
        black_box(navigator.pva())
    });
}
