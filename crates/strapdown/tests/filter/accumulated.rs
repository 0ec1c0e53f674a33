//! Transitions accumulated over IMU steps against the dense product of exact transitions of every step.

use nalgebra::SMatrix;
use schuler_frames::{B, Euler, Geodetic, Rot, Vec3};
use schuler_imu::Instrument::{Accel, Gyro};
use schuler_imu::{Source, Spec, Truth};
use schuler_strapdown::filter::{Accumulator, Form, Model, NavStates, Propagation};
use schuler_strapdown::{ErrorDynamics, Increments, LocalLevel, Pva, Vertical};

use crate::common::*;

/// Gauss-Markov biases that are short and long, a walk, a ramp, second order, and a scale factor: 9 + 3 + 3 + 3 + 3 + 6 + 3 + 2.
fn mixed() -> Spec {
    let s = |i, term, process, given: &[(&str, f64)]| {
        let given: Vec<_> = given.iter().map(|(name, value)| (*name, (*value).into())).collect();
        Source::named(i, term, process, &given).unwrap()
    };
    Spec::from_sources([
        s(Gyro, "bias", "white", &[("density", 3e-6)]),
        s(Accel, "bias", "white", &[("density", 1e-4)]),
        s(Gyro, "bias", "gauss_markov", &[("sigma", 1e-6), ("tau", 0.7)]),
        s(Accel, "bias", "gauss_markov", &[("sigma", 1e-3), ("tau", 100.0)]),
        s(Gyro, "bias", "random_walk", &[("density", 1e-7)]),
        s(Gyro, "scale_factor", "constant", &[("sigma", 1e-3)]),
        s(Accel, "bias", "second_order_gauss_markov", &[("sigma", 1e-3), ("tau", 3.0)]),
        s(Accel, "scale_factor", "white", &[("density", 1e-5)]),
    ])
    .unwrap()
}

/// A vehicle that turns, pitches and shakes: increments of step `k` of `dt`.
pub fn shaken(k: usize, dt: f64) -> Increments {
    let t = (k as f64 + 0.5) * dt;
    let dtheta = Vec3::<B>::new(
        0.1 * (3.0 * t).sin() + 0.02 * (60.0 * t).sin(),
        0.2 * (1.7 * t).cos(),
        0.3 + 0.1 * (0.9 * t).sin(),
    );
    let dv =
        Vec3::<B>::new(2.0 * (0.8 * t).sin(), 3.0 + 1.0 * (47.0 * t).cos(), -9.8 + 2.0 * (5.0 * t).sin());
    Increments { dtheta: dtheta * dt, dv: dv * dt }
}

/// A coordinated turn with climbs, as a transport aircraft flies it.
fn calm(k: usize, dt: f64) -> Increments {
    let t = (k as f64 + 0.5) * dt;
    let dtheta = Vec3::<B>::new(0.02 * (0.3 * t).sin(), 0.01 * (0.2 * t).cos(), 0.05);
    let dv = Vec3::<B>::new(0.5 * (0.1 * t).sin(), 0.3, -9.8 + 0.5 * (0.2 * t).sin());
    Increments { dtheta: dtheta * dt, dv: dv * dt }
}

fn start() -> Pva {
    Pva {
        position: Geodetic::new(0.785, 0.1, 500.0),
        v_t: Vec3::new(60.0, 40.0, -1.0),
        c_tb: Rot::from_euler(Euler::new(0.02, -0.03, 0.7)),
    }
}

/// Increments of a step of a length.
type Motion = fn(usize, f64) -> Increments;

/// Dense P after `steps` IMU steps: exact transition and noise of each at its middle.
fn dense<const N: usize>(
    (motion, dynamics): (Motion, ErrorDynamics),
    model: &Model<N>,
    p: &mut SMatrix<f64, N, N>,
    nav: &mut LocalLevel,
    from: usize,
    steps: usize,
    dt: f64,
) {
    for k in from..from + steps {
        let increments = motion(k, dt);
        let before = nav.pva();
        nav.step(&increments, dt);
        let after = nav.pva();
        let middle = middle(&before, &after);
        let f_b = increments.dv * (1.0 / dt);
        let system = model.form().system(&dynamics, &middle, f_b);
        let seen = Truth::increments(increments.dtheta.as_array(), increments.dv.as_array());
        let step = Propagation::exact(model, &system, &seen, dt);
        let phi = step.phi();
        *p = phi * *p * phi.transpose() + step.q();
    }
}

pub fn middle(a: &Pva, b: &Pva) -> Pva {
    let turn = (a.c_tb.inverse() * b.c_tb).as_rotation_vector() * 0.5;
    Pva {
        position: Geodetic::new(
            0.5 * (a.position.lat + b.position.lat),
            0.5 * (a.position.lon + b.position.lon),
            0.5 * (a.position.h + b.position.h),
        ),
        v_t: (a.v_t + b.v_t) * 0.5,
        c_tb: a.c_tb * Rot::from_rotation_vector(turn),
    }
}

/// Largest relative difference of the sigmas over `seconds` of motion, 20 steps a time update.
fn worst<const N: usize>(
    motion: Motion,
    form: Form,
    nav: NavStates,
    spec: &Spec,
    vertical: Vertical,
    seconds: f64,
) -> (f64, String) {
    let model = Model::<N>::new(form, nav, spec).unwrap();
    let dynamics = ErrorDynamics { gravity: GRAVITY, vertical };
    let dt = 0.01;
    let mut truth = LocalLevel::new(&start(), GRAVITY, vertical);
    let mut fast = LocalLevel::new(&start(), GRAVITY, vertical);
    let sigmas = [3.0, 3.0, 5.0, 0.1, 0.1, 0.1, 3e-4, 3e-4, 3e-3];
    let mut p = model.p0(&sigmas).unwrap();
    let mut q = p;
    let mut accumulator = Accumulator::new(&model, dynamics, &start());
    let mut worst = (0.0, String::new());
    for interval in 0..(seconds / dt) as usize / 20 {
        dense((motion, dynamics), &model, &mut p, &mut truth, interval * 20, 20, dt);
        for k in interval * 20..interval * 20 + 20 {
            fast.step(&motion(k, dt), dt);
            accumulator.step(&model, &fast.pva(), &motion(k, dt), dt);
        }
        let step = accumulator.close(&model);
        let mut in_two = q;
        step.apply(&mut q);
        step.transport(&mut in_two);
        step.diffuse(&mut in_two);
        assert_eq!(q, in_two);
        assert_eq!(q, q.transpose());
        for k in 0..model.len() {
            if p[(k, k)] > 0.0 {
                let off = ((q[(k, k)] / p[(k, k)]).sqrt() - 1.0).abs();
                if off > worst.0 {
                    worst = (off, format!("{} at {} s", model.name(k), (interval + 1) as f64 * 0.2));
                }
            } else {
                assert_eq!(q[(k, k)], 0.0);
            }
        }
    }
    worst
}

#[test]
fn accumulated_sigmas_are_those_of_the_dense_product() {
    let simple = sensors(1e-5, 1e-4, 1e-6, 1e-3);
    for (form, vertical) in
        [(Form::Phi, Vertical::Free), (Form::Psi, Vertical::Free), (Form::Phi, Vertical::Held)]
    {
        let (off, place) = worst::<15>(calm, form, NavStates::ALL, &simple, vertical, 60.0);
        assert!(off < 1e-8, "{form:?} {vertical:?}: {off:e} {place}");
        let (off, place) = worst::<15>(shaken, form, NavStates::ALL, &simple, vertical, 60.0);
        assert!(off < 1e-8, "{form:?} {vertical:?}: {off:e} {place}");
    }
    // Short correlation times and columns that change with the motion.
    for (nav, vertical) in [(NavStates::ALL, Vertical::Free), (NavStates::LEVEL, Vertical::Held)] {
        let (off, place) = worst::<32>(shaken, Form::Phi, nav, &mixed(), vertical, 20.0);
        assert!(off < 5e-7, "{vertical:?}: {off:e} {place}");
    }
}

/// A baro loop damps faster than all else: of its terms those of third order are left out.
#[test]
fn accumulated_sigmas_with_a_damped_vertical() {
    let baro = schuler_strapdown::BaroLoop::second_order(100.0, 3e-6, 500.0);
    let simple = sensors(1e-5, 1e-4, 1e-6, 1e-3);
    let (off, place) = worst::<15>(calm, Form::Phi, NavStates::ALL, &simple, Vertical::Damped(baro), 120.0);
    assert!(off < 5e-6, "{off:e} {place}");
}

/// A state that fades slowly is the same whether it is followed through the steps, as it is beside one that fades fast, or
/// comes from what the body does.
#[test]
fn slow_states_are_the_same_beside_fast_ones() {
    let bias = |i, tau: f64| {
        let given = [("sigma", 1e-3.into()), ("tau", tau.into())];
        Source::named(i, "bias", "gauss_markov", &given).unwrap()
    };
    let slow = [bias(Gyro, 60.0), bias(Accel, 80.0)];
    let alone = Spec::from_sources(slow).unwrap();
    let [gyro, accel] = slow;
    let beside = Spec::from_sources([gyro, accel, bias(Accel, 1.0)]).unwrap();
    let dynamics = ErrorDynamics { gravity: GRAVITY, vertical: Vertical::Free };
    let over = |spec: &Spec| {
        let model = Model::<18>::new(Form::Phi, NavStates::ALL, spec).unwrap();
        let mut accumulator = Accumulator::new(&model, dynamics, &start());
        let mut nav = LocalLevel::new(&start(), GRAVITY, Vertical::Free);
        for k in 0..20 {
            nav.step(&shaken(k, 0.01), 0.01);
            accumulator.step(&model, &nav.pva(), &shaken(k, 0.01), 0.01);
        }
        accumulator.close(&model).phi()
    };
    let (alone, beside) = (over(&alone), over(&beside));
    for (i, j) in (0..3).flat_map(|i| (9..15).map(move |j| (i, j))) {
        let column = |m: &SMatrix<f64, 18, 18>| m.fixed_view::<3, 1>(3 * i, j).into_owned();
        let off = (column(&alone) - column(&beside)).norm() / column(&beside).norm();
        // Attitude by a gyro and velocity by an accelerometer add up; all else comes with more powers of the interval.
        let limit = if (i == 2) == (j < 12) && i > 0 { 1e-9 } else { 1e-4 };
        assert!(off < limit, "rows of {i}, column {j}: {off:e}");
    }
}

/// A length of step that changes within an interval, and lanes that are not full: 9 + 3 states of one sort in room for 12.
#[test]
fn steps_of_another_length_go_on_where_the_others_ended() {
    let given = [("sigma", 1e-3.into()), ("tau", 0.5.into())];
    let spec = Spec::from_sources([Source::named(Accel, "bias", "gauss_markov", &given).unwrap()]).unwrap();
    let model = Model::<12>::new(Form::Phi, NavStates::ALL, &spec).unwrap();
    let dynamics = ErrorDynamics { gravity: GRAVITY, vertical: Vertical::Free };
    let rest = at_rest(0.8, 0.5);
    let mut accumulator = Accumulator::new(&model, dynamics, &rest);
    let (_, f) = felt(&rest);
    for dt in [0.02, 0.02, 0.01, 0.03, 0.02] {
        let increments = Increments { dtheta: Vec3::ZERO, dv: f * dt };
        accumulator.step(&model, &rest, &increments, dt);
    }
    let phi = accumulator.close(&model).phi();
    // Velocity by the integral of e^(-t/tau).
    let expected = 0.5 * (1.0 - (-0.1f64 / 0.5).exp());
    let gained = (phi[(3, 9)].powi(2) + phi[(4, 9)].powi(2)).sqrt();
    assert!((gained / expected - 1.0).abs() < 1e-9, "{gained} {expected}");
    assert!((phi[(9, 9)] - (-0.2f64).exp()).abs() < 1e-14);
}
