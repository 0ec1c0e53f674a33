//! Time and measurement updates of the filter against the same written with dense matrices.
//!
//! `cargo bench -p schuler-strapdown --bench filter` prints both; what counts is their ratio in one run.

mod flight;

use divan::{Bencher, black_box};
use nalgebra::{Matrix3, Matrix6, SMatrix, Vector3, Vector6};
use schuler_frames::Gravity;
use schuler_imu::{Instrument, Source, Spec, Truth};
use schuler_strapdown::filter::{Accumulator, Filter, Form, Model, NavStates, Propagation, Row};
use schuler_strapdown::{ErrorDynamics, Increments, LocalLevel, Pva, Vertical};

fn main() {
    divan::main();
}

const DYNAMICS: ErrorDynamics = ErrorDynamics { gravity: Gravity::Somigliana, vertical: Vertical::Free };

/// IMU steps of one time update.
const STEPS: usize = 20;

/// Updates in one sample, so that the clock's own time does not count; figures are those of the sample, rates those of one.
const MANY: usize = 100;

/// White noise, and so many Gauss-Markov biases on each axis of both triads.
fn spec(biases: usize) -> Spec {
    let source = |i, process, given: &[(&str, f64)]| {
        let given: Vec<_> = given.iter().map(|(name, value)| (*name, (*value).into())).collect();
        Source::named(i, "bias", process, &given).unwrap()
    };
    let mut spec = Spec::new();
    for (i, size) in [(Instrument::Gyro, 1e-6), (Instrument::Accel, 1e-3)] {
        spec.push(source(i, "white", &[("density", size)])).unwrap();
        for k in 0..biases {
            let tau = 100.0 * 3f64.powi(k as i32);
            spec.push(source(i, "gauss_markov", &[("sigma", size), ("tau", tau)])).unwrap();
        }
    }
    spec
}

fn filter<const N: usize>(biases: usize) -> Filter<N> {
    let model = Model::new(Form::Phi, NavStates::ALL, &spec(biases)).unwrap();
    Filter::new(model, &[3.0, 3.0, 5.0, 0.1, 0.1, 0.1, 3e-4, 3e-4, 3e-3]).unwrap()
}

/// The flight, navigated beforehand.
fn flown() -> Vec<(Increments, Pva)> {
    let mut nav = LocalLevel::new(&flight::start(), Gravity::Somigliana, Vertical::Free);
    flight::log()
        .take(STEPS)
        .map(|increments| {
            nav.step(&increments, flight::DT);
            (increments, nav.pva())
        })
        .collect()
}

fn step<const N: usize>(filter: &Filter<N>) -> Propagation<N> {
    let pva = flight::start();
    let f_b = schuler_frames::Vec3::new(0.1, 0.5, -9.8);
    let seen = Truth::rates([0.0; 3], f_b.as_array());
    Propagation::exact(filter.model(), &DYNAMICS.system(&pva, f_b), &seen, flight::DT)
}

/// phi * p * phi' + q with 15 states, the matrices being there: one step.
#[divan::bench]
fn time_dense(bencher: Bencher) {
    let filter = filter::<15>(1);
    let step = step(&filter);
    let (phi, q, mut p) = (step.phi(), step.q(), filter.p);
    bencher.counter(divan::counter::ItemsCount::new(MANY)).bench_local(|| {
        for _ in 0..MANY {
            let phi = black_box(&phi);
            p = phi * p * phi.transpose() + q;
        }
    });
}

/// The same by the sparse form: one step.
#[divan::bench]
fn time_sparse(bencher: Bencher) {
    let filter = filter::<15>(1);
    let step = step(&filter);
    let mut p = filter.p;
    bencher.counter(divan::counter::ItemsCount::new(MANY)).bench_local(|| {
        for _ in 0..MANY {
            black_box(&step).apply(&mut p);
        }
    });
}

/// Twenty IMU steps gathered, with all that makes Phi and Q, and one time update: figures are those of one step.
#[divan::bench]
fn time_accumulated(bencher: Bencher) {
    let mut filter = filter::<15>(1);
    let model = filter.model().clone();
    let log = flown();
    let mut accumulator = Accumulator::new(&model, DYNAMICS, &flight::start());
    let mut step = Propagation::identity(&model);
    bencher.counter(divan::counter::ItemsCount::new(STEPS * MANY)).bench_local(|| {
        for _ in 0..MANY {
            for (increments, pva) in black_box(&log) {
                accumulator.step(&model, pva, increments, flight::DT);
            }
            accumulator.close_into(&model, &mut step);
            filter.propagate(&step);
        }
    });
}

/// The gathering alone.
#[divan::bench]
fn time_gathering(bencher: Bencher) {
    let filter = filter::<15>(1);
    let model = filter.model();
    let log = flown();
    let mut accumulator = Accumulator::new(model, DYNAMICS, &flight::start());
    bencher.counter(divan::counter::ItemsCount::new(STEPS * MANY)).bench_local(|| {
        for _ in 0..MANY {
            for (increments, pva) in black_box(&log) {
                accumulator.step(model, pva, increments, flight::DT);
            }
        }
    });
}

/// What is written without any of this: F from the error dynamics, Phi = I + F dt + (F dt)²/2, Q = G Q_c G' dt, and
/// phi * p * phi' + q, at every IMU step.
#[divan::bench]
fn time_dense_built(bencher: Bencher) {
    let filter = filter::<15>(1);
    let model = filter.model();
    let log = flown();
    let dt = flight::DT;
    // Densities of the white noise of both triads, and of what drives the source states.
    let of_white = Matrix6::from_diagonal(&Vector6::new(1e-12, 1e-12, 1e-12, 1e-6, 1e-6, 1e-6));
    let of_sources = step(&filter).q().fixed_view::<6, 6>(9, 9).into_owned();
    let mut p = filter.p;
    bencher.counter(divan::counter::ItemsCount::new(STEPS * MANY)).bench_local(|| {
        for _ in 0..MANY {
            for (increments, pva) in black_box(&log) {
                let f_b = increments.dv * (1.0 / dt);
                let seen = Truth::increments(increments.dtheta.as_array(), increments.dv.as_array());
                let system = DYNAMICS.system(pva, f_b);
                let f = model.dynamics(&system, &seen) * dt;
                let phi = SMatrix::<f64, 15, 15>::identity() + f + f * f * 0.5;
                let mut g = SMatrix::<f64, 9, 6>::zeros();
                g.fixed_view_mut::<9, 3>(0, 0).copy_from(&system.b_gyro);
                g.fixed_view_mut::<9, 3>(0, 3).copy_from(&system.b_accel);
                let mut q = SMatrix::<f64, 15, 15>::zeros();
                q.fixed_view_mut::<9, 9>(0, 0).copy_from(&(g * of_white * g.transpose() * dt));
                q.fixed_view_mut::<6, 6>(9, 9).copy_from(&of_sources);
                p = phi * p * phi.transpose() + q;
            }
            p = black_box(filter.p);
        }
    });
}

/// One sparse time update against the number of states, all in the same room for 64.
#[divan::bench(args = [0, 1, 3, 9])]
fn time_by_states(bencher: Bencher, biases: usize) {
    let filter = filter::<64>(biases);
    let step = step(&filter);
    let mut p = filter.p;
    bencher.counter(divan::counter::ItemsCount::new(MANY)).bench_local(|| {
        for _ in 0..MANY {
            black_box(&step).apply(&mut p);
        }
    });
}

/// Three velocities at once, dense Joseph form.
#[divan::bench]
fn measurement_dense_vector(bencher: Bencher) {
    let filter = filter::<15>(1);
    let p = filter.p;
    let mut h = SMatrix::<f64, 3, 15>::zeros();
    h.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
    let r = Matrix3::from_diagonal(&Vector3::new(1e-2, 1e-2, 1e-2));
    bencher.counter(divan::counter::ItemsCount::new(MANY)).bench_local(|| {
        for _ in 0..MANY {
            let (p, h) = (black_box(&p), black_box(&h));
            let s = h * p * h.transpose() + r;
            let k = p * h.transpose() * s.try_inverse().unwrap();
            let i_kh = SMatrix::<f64, 15, 15>::identity() - k * h;
            black_box(i_kh * p * i_kh.transpose() + k * r * k.transpose());
        }
    });
}

/// One velocity, scalar Joseph form.
#[divan::bench]
fn measurement_scalar(bencher: Bencher) {
    let mut filter = filter::<15>(1);
    let row = Row::from_pairs([(3, 1.0)]);
    bencher.counter(divan::counter::ItemsCount::new(MANY)).bench_local(|| {
        for _ in 0..MANY {
            black_box(filter.update_scalar(black_box(&row), 0.01, 1e-2)).ok();
        }
    });
}

/// One scalar update against the number of states, all in the same room for 64.
#[divan::bench(args = [0, 1, 3, 9])]
fn measurement_by_states(bencher: Bencher, biases: usize) {
    let mut filter = filter::<64>(biases);
    let row = Row::from_pairs([(3, 1.0)]);
    bencher.counter(divan::counter::ItemsCount::new(MANY)).bench_local(|| {
        for _ in 0..MANY {
            black_box(filter.update_scalar(black_box(&row), 0.01, 1e-2)).ok();
        }
    });
}
