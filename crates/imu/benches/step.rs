//! Cost of a sample, beside the same drawn with `rand_distr`. Compare the lines of one run.
//!
//! `core_set` has bias, random walk, Gauss-Markov and white noise on six axes with scale factor and
//! misalignment: one draw for each of 18 processes, which their innovations make enough for exact interval
//! means. `core_set_with_rand_distr` is this one set written out by hand, without any generality, and drawn by
//! `StandardNormal` over `StdRng`: in `30` draws, state and interval mean of the 12 processes with a state,
//! which is how one writes it; in `18`, with the settled innovations, the very numbers that `core_set` takes.
//! `rand_distr_normals` draws as many and does nothing else.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, StandardNormal};
use schuler_imu::process::{Form, Innovation};
use schuler_imu::random::{Level, best_level};
use schuler_imu::readout::{Bandwidth, Channel, Faults, Lsb, Timing};
use schuler_imu::{
    Imu, Instrument, Motion, PROCESSES, Process, ProcessKind, Readout, Sample, Source, Spec, Stream, TERMS,
    Truth, Value, process_kind,
};

const SAMPLES: usize = 4096;

fn main() {
    divan::main();
}

fn core_set() -> Spec {
    let mut spec = Spec::new();
    for instrument in Instrument::ALL {
        let mut add = |term: &str, process: &str, given: &[(&str, Value<'_>)]| {
            spec.push(Source::named(instrument, term, process, given).expect("valid")).expect("room");
        };
        add("bias", "constant", &[("sigma", 1e-3.into())]);
        add("bias", "white", &[("density", 1e-4.into())]);
        add("bias", "random_walk", &[("density", 1e-6.into())]);
        add("bias", "gauss_markov", &[("sigma", 1e-4.into()), ("tau", 100.0.into())]);
        add("scale_factor", "constant", &[("sigma", 1e-4.into())]);
        add("misalignment", "constant", &[("sigma", 1e-4.into())]);
    }
    spec
}

/// Every term with a constant, and the bias with every process in its first form.
fn full_chain() -> Spec {
    let process = |kind: &'static dyn ProcessKind, form: Form| {
        let given: Vec<(&str, Value<'_>)> = form.iter().map(|p| (p.name, p.example.into())).collect();
        Process::new(kind, &given).expect("valid")
    };
    let mut spec = Spec::new();
    let constant = process_kind("constant").expect("registered");
    for instrument in Instrument::ALL {
        for term in TERMS.iter().filter(|t| t.instruments().contains(&instrument)) {
            let p = process(constant, constant.forms()[1]);
            spec.push(Source::new(instrument, *term, p).expect("valid")).expect("room");
        }
        for kind in PROCESSES {
            let p = process(*kind, kind.forms()[0]);
            spec.push(Source::new(instrument, TERMS[0], p).expect("valid")).expect("room");
        }
    }
    spec
}

fn samples(bencher: Bencher<'_, '_>, spec: &Spec) {
    samples_at(best_level(), bencher, spec);
}

fn samples_at(level: Level, bencher: Bencher<'_, '_>, spec: &Spec) {
    let mut imu = Imu::new(spec, Stream { seed: 1, run: 0 }).expect("capacity");
    imu.set_level(level);
    let truth = [Truth::rates([0.1, 0.2, 0.3], [1.0, 2.0, 9.8]); SAMPLES];
    let mut out = [Sample::default(); SAMPLES];
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        imu.steps(0.01, black_box(&truth), &mut out);
        black_box(&out);
    });
}

#[divan::bench]
fn core_set_sample(bencher: Bencher<'_, '_>) {
    samples(bencher, &core_set());
}

/// In the lanes of every machine of the target, and of AVX2 where there are such.
#[divan::bench(args = ["baseline", "avx2"])]
fn core_set_sample_in_lanes(bencher: Bencher<'_, '_>, lanes: &str) {
    let level = match lanes {
        #[cfg(target_arch = "x86_64")]
        "avx2" => best_level().as_avx2().map(Level::Avx2),
        _ => None,
    };
    samples_at(level.unwrap_or(Level::baseline()), bencher, &core_set());
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
        let step = e.kind.step(&e.arguments, 0, dt);
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

/// The same set without any generality: what a careful user would write for it by hand.
#[divan::bench(consts = [18, 30])]
fn core_set_with_rand_distr<const DRAWS: usize>(bencher: Bencher<'_, '_>) {
    let mut rng = StdRng::seed_from_u64(1);
    let dt: f64 = 0.01;
    let walk = ByHand::new("random_walk", &[("density", 1e-6.into())], dt, DRAWS);
    let markov = ByHand::new("gauss_markov", &[("sigma", 1e-4.into()), ("tau", 100.0.into())], dt, DRAWS);
    let white = 1e-4 / dt.sqrt();
    let (bias, scale, cross) = ([1e-3; 6], [1e-4; 6], [[1e-4; 3]; 6]);
    let (mut b, mut m) = ([0.0; 6], [0.0; 6]);
    let truth = [Truth::rates([0.1, 0.2, 0.3], [1.0, 2.0, 9.8]); SAMPLES];
    let mut out = [Sample::default(); SAMPLES];
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        for (truth, sample) in black_box(&truth).iter().zip(&mut out) {
            let Motion::Rates { omega, f } = truth.motion else { continue };
            let mut error = [0.0; 6];
            for i in 0..6 {
                let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
                let input = if i < 3 { &omega } else { &f };
                // Of each process the normal of its state, and where they are drawn that of its mean.
                let (w1, v1) = (draw(), if DRAWS == 30 { draw() } else { 0.0 });
                let (w2, v2) = (draw(), if DRAWS == 30 { draw() } else { 0.0 });
                let walked = walk.mean * b[i] + walk.to_mean[0] * w1 + walk.to_mean[1] * v1;
                let correlated = markov.mean * m[i] + markov.to_mean[0] * w2 + markov.to_mean[1] * v2;
                b[i] = walk.phi * b[i] + walk.to_state * w1;
                m[i] = markov.phi * m[i] + markov.to_state * w2;
                let noise = walked + correlated + white * draw();
                let linear: f64 = (0..3).map(|j| cross[i][j] * input[j]).sum();
                error[i] = bias[i] + noise + scale[i] * input[i % 3] + linear;
            }
            sample.dt = dt;
            (0..3).for_each(|i| {
                (sample.omega_error[i], sample.f_error[i]) = (error[i], error[i + 3]);
                sample.dtheta[i] = (omega[i] + error[i]) * dt;
                sample.dv[i] = (f[i] + error[i + 3]) * dt;
            });
        }
        black_box(&out);
    });
}

#[divan::bench]
fn full_chain_sample(bencher: Bencher<'_, '_>) {
    samples(bencher, &full_chain());
}

/// With everything that a readout can do, on both instruments.
#[divan::bench]
fn full_chain_with_readout_sample(bencher: Bencher<'_, '_>) {
    let channel = Channel {
        bandwidth: Some(Bandwidth { natural_frequency: 200.0, damping: 0.7 }),
        timing: Timing { delay: 0.004, jitter: 1e-5 },
        range: Some([(-100.0, 100.0); 3]),
        lsb: Some(Lsb { size: [1e-6; 3], carry: true }),
        faults: Faults { drop: 1e-5, repeat: 1e-5, stick: 1e-5, stuck_samples: 3 },
        ..Channel::default()
    };
    let mut spec = full_chain();
    spec.readout = Some(Readout { gyro: channel, accel: channel });
    samples(bencher, &spec);
}

/// The core set one call at a time, as in a closed loop; most of them find their draws prepared.
#[divan::bench]
fn core_set_step(bencher: Bencher<'_, '_>) {
    let mut imu = Imu::new(&core_set(), Stream { seed: 1, run: 0 }).expect("capacity");
    let truth = Truth::rates([0.1, 0.2, 0.3], [1.0, 2.0, 9.8]);
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        for _ in 0..SAMPLES {
            black_box(imu.step(0.01, black_box(&truth)));
        }
    });
}

#[divan::bench(args = [18, 30])]
fn rand_distr_normals(bencher: Bencher<'_, '_>, count: usize) {
    let mut rng = StdRng::seed_from_u64(1);
    bencher.counter(ItemsCount::new(SAMPLES)).bench_local(|| {
        let mut sum = 0.0;
        for _ in 0..SAMPLES * count {
            let x: f64 = StandardNormal.sample(&mut rng);
            sum += x;
        }
        black_box(sum)
    });
}

#[divan::bench]
fn new_run(bencher: Bencher<'_, '_>) {
    let mut imu = Imu::new(&core_set(), Stream { seed: 1, run: 0 }).expect("capacity");
    bencher.bench_local(|| imu.restart(black_box(Stream { seed: 2, run: 1 })));
}
