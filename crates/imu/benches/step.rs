//! Cost of a sample, beside drawing the same number of normals with `rand_distr`.
//!
//! `core_set` has bias, random walk, Gauss-Markov and white noise on six axes with scale factor and
//! misalignment. The issue counts 18 draws for it; exact interval means need 30 (two for each state), and
//! the baseline is drawn with both counts. Compare the columns of one run.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, StandardNormal};
use schuler_imu::process::Form;
use schuler_imu::{
    Imu, Instrument, PROCESSES, Process, ProcessKind, Sample, Source, Spec, Stream, TERMS, Truth, Value,
    process_kind,
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
    let mut imu = Imu::new(spec, Stream { seed: 1, run: 0 }).expect("capacity");
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

#[divan::bench]
fn full_chain_sample(bencher: Bencher<'_, '_>) {
    samples(bencher, &full_chain());
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
