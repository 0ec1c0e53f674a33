//! The filter beside simulated truth: normalized errors and innovations in their bands, gates, and a long life.

use nalgebra::SMatrix;
use schuler_frames::{B, Euler, Rot, T, Vec3, with_phi};
use schuler_imu::Instrument::{Accel, Gyro};
use schuler_imu::Truth as Seen;
use schuler_strapdown::filter::{
    Accumulator, Filter, Form, Gate, Measurement, Model, NavStates, Now, Propagation, Row, ZeroVelocity,
    chi_square, measurement,
};
use schuler_strapdown::{Increments, LocalLevel, NavError, Pva, Vertical};

use crate::common::*;
use crate::simulation::{Noise, Truth};

/// Quantiles of the tables (Abramowitz and Stegun, table 26.8).
#[test]
fn chi_square_quantiles_are_those_of_the_tables() {
    for (p, dof, expected) in [
        (0.05, 1, 3.84146),
        (0.05, 2, 5.99147),
        (0.05, 3, 7.81473),
        (0.01, 10, 23.2093),
        (0.995, 10, 2.15585),
        (0.05, 100, 124.342),
        (0.001, 1, 10.8276),
        // Wilson and Hilferty's approximation, good to 1e-6 here.
        (0.05, 20_000, 20_330.0),
    ] {
        let found = chi_square::quantile(p, dof);
        assert!((found / expected - 1.0).abs() < 2e-5, "{p} {dof}: {found}");
        assert!((chi_square::exceedance(found, dof) - p).abs() < 1e-12);
    }
    assert_eq!(chi_square::quantile(0.0, 3), f64::INFINITY);
    assert_eq!(chi_square::quantile(1.0, 3), 0.0);
    assert_eq!(chi_square::exceedance(-1.0, 3), 1.0);
}

/// The 99 % band of a chi-square with many degrees of freedom.
fn in_band(sum: f64, dof: usize) -> bool {
    sum > chi_square::quantile(0.995, dof) && sum < chi_square::quantile(0.005, dof)
}

const SIGMAS: [f64; 9] = [0.0, 0.0, 0.0, 0.1, 0.1, 0.0, 0.1 * DEG, 0.1 * DEG, DEG];

fn spec() -> schuler_imu::Spec {
    sensors(0.003 * DEGPRTH, 10.0 * UG, 0.01 * DEGPH, 50.0 * UG)
}

/// Matched models, 200 runs of 300 s: all ten errors together, and all innovations.
#[test]
fn matched_filter_is_consistent() {
    let pva = at_rest(0.8, 0.5);
    let model = ten_states(&spec());
    let step: Propagation<10> = at_rest_step(&model, &pva, 1.0);
    let start = Filter::new(model, &SIGMAS).unwrap();
    let (mut nees, mut nis, mut rows) = (0.0, 0.0, 0);
    let mut noise = Noise::new(11);
    let all: Vec<usize> = (0..10).collect();
    for _ in 0..200 {
        let mut truth = Truth::new(&step, &start.p, &mut noise);
        let mut filter = start.clone();
        for _ in 0..300 {
            truth.step(&mut noise);
            filter.propagate(&step);
            let mut o = ZeroVelocity { sigma: 0.02, axes: measurement::HORIZONTAL }.observe(&Now::at(&pva));
            for axis in 0..2 {
                o.z[axis] = truth.x[axis] + 0.02 * noise.normal();
            }
            filter.update_with(&o, &Now::at(&pva)).unwrap();
        }
        nees += filter.nees(&all, truth.x.as_slice()).unwrap();
        nis += filter.tally().nis;
        rows += filter.tally().rows as usize;
    }
    assert!(in_band(nees, 2000), "{nees}");
    assert!(in_band(nis, rows), "{nis} of {rows}");
}

/// A gate refuses good measurements as often as it was told, and one that is wrong.
#[test]
fn gates_refuse_what_they_should() {
    let pva = at_rest(0.8, 0.5);
    let model = Model::<9>::new(Form::Phi, NavStates::ALL, &schuler_imu::Spec::new()).unwrap();
    let start = Filter::new(model, &[1.0; 9]).unwrap();
    let mut noise = Noise::new(4);
    for (gate, rows) in [(Gate::scalar(0.05), 3), (Gate::vector(0.05), 1)] {
        let mut refused = 0;
        for _ in 0..20_000 {
            let mut filter = start.clone();
            filter.gate = gate;
            let mut o = ZeroVelocity::new(0.5).observe(&Now::at(&pva));
            for axis in 0..3 {
                o.z[axis] = noise.normal() + 0.5 * noise.normal();
            }
            let outcome = filter.update_with(&o, &Now::at(&pva)).unwrap();
            let count = outcome.accepted.iter().filter(|a| !**a).count();
            refused += count / (3 / rows);
            assert_eq!(filter.tally().refused as usize, count);
            assert_eq!(count == 3, filter.x == start.x && filter.p == start.p);
        }
        let n = (20_000 * rows) as f64;
        let sigma = (0.05 * 0.95 / n).sqrt();
        assert!((refused as f64 / n - 0.05).abs() < 4.0 * sigma, "{gate:?}: {refused} of {n}");
    }
    // One wrong row of three: the scalar gate takes the others.
    let mut filter = start.clone();
    filter.gate = Gate::scalar(1e-3);
    let mut o = ZeroVelocity::new(0.5).observe(&Now::at(&pva));
    o.z = [0.1, 50.0, -0.2];
    let outcome = filter.update_with(&o, &Now::at(&pva)).unwrap();
    assert_eq!(outcome.accepted, [true, false, true]);
    assert!(filter.p[(3, 3)] < 0.5 && filter.p[(4, 4)] == 1.0);
    // What makes no sense is an error, and nothing has changed.
    for (z, r) in [([f64::NAN, 0.0, 0.0], 0.25), ([0.0; 3], -0.25), ([0.0; 3], f64::INFINITY)] {
        let mut filter = start.clone();
        (o.z, o.r[1][1]) = (z, r);
        assert!(filter.update_with(&o, &Now::at(&pva)).is_err());
        assert_eq!(filter, start);
    }
}

/// A real navigator at rest with noisy sensors and constant biases, aligned in closed loop from a heading error of 5 deg
/// (1-sigma): twice thirty runs of 120 s, one form of the dynamics each; errors of velocity and attitude within the band
/// of their covariance.
#[test]
fn closed_loop_around_a_navigator_is_consistent() {
    const RUNS: usize = 30;
    let (arw, vrw, bias_g, bias_a) = (0.03 * DEGPRTH, 50.0 * UG, 0.3 * DEGPH, 200.0 * UG);
    let truth = at_rest(0.8, 0.7);
    let (omega, f) = felt(&truth);
    let (dt, sigma) = (0.05f64, 0.01);
    let model = Model::<16>::new(Form::Phi, NavStates::LEVEL, &sensors(arw, vrw, bias_g, bias_a)).unwrap();
    let start_sigmas = [0.0, 0.0, 0.0, 0.05, 0.05, 0.0, 0.2 * DEG, 0.2 * DEG, 5.0 * DEG];
    for form in [Form::Phi, Form::Psi] {
        let model = match form {
            Form::Phi => model.clone(),
            Form::Psi => Model::new(form, NavStates::LEVEL, &sensors(arw, vrw, bias_g, bias_a)).unwrap(),
        };
        let mut noise = Noise::new(9);
        let mut nees = 0.0;
        for _ in 0..RUNS {
            let mut filter = Filter::new(model.clone(), &start_sigmas).unwrap();
            let mut draw = |k: usize| noise.normal() * start_sigmas[k];
            let start = Pva {
                v_t: Vec3::new(draw(3), draw(4), 0.0),
                c_tb: with_phi(truth.c_tb, Vec3::new(draw(6), draw(7), draw(8))),
                ..truth
            };
            let bias: [f64; 6] =
                std::array::from_fn(|k| noise.normal() * if k < 3 { bias_g } else { bias_a });
            let mut nav = LocalLevel::new(&start, GRAVITY, Vertical::Held);
            let mut accumulator = Accumulator::new(&model, HELD, &start);
            for _ in 0..120 {
                for _ in 0..20 {
                    let mut pair = [omega, f].map(Vec3::as_array);
                    for axis in 0..3 {
                        pair[0][axis] += bias[axis] + arw / dt.sqrt() * noise.normal();
                        pair[1][axis] += bias[3 + axis] + vrw / dt.sqrt() * noise.normal();
                    }
                    let seen = Seen::rates(pair[0], pair[1]);
                    let (e_g, e_a) =
                        (filter.sensor_error(Gyro, &seen, dt), filter.sensor_error(Accel, &seen, dt));
                    let increments = Increments {
                        dtheta: (Vec3::<B>::claim(pair[0]) - Vec3::claim(e_g)) * dt,
                        dv: (Vec3::<B>::claim(pair[1]) - Vec3::claim(e_a)) * dt,
                    };
                    nav.step(&increments, dt);
                    accumulator.step(&model, &nav.pva(), &increments, dt);
                }
                filter.propagate(&accumulator.close(&model));
                let base = Vec3::<T>::new(noise.normal() * sigma, noise.normal() * sigma, 0.0);
                let measured = schuler_strapdown::filter::Velocity {
                    v_t: base,
                    sigma: [sigma; 3],
                    lever: Vec3::ZERO,
                    axes: measurement::HORIZONTAL,
                };
                filter.update(&measured, &Now::at(&nav.pva())).unwrap();
                // The position is known: it starts anew where the base is.
                let corrected = Pva { position: truth.position, ..filter.feedback(&nav.pva()) };
                nav = LocalLevel::new(&corrected, GRAVITY, Vertical::Held);
                accumulator.begin(&model, &corrected);
            }
            let e = NavError::between(&nav.pva(), &truth).as_array();
            let left = [e[3], e[4], e[6], e[7], e[8]];
            // What x, zero after feedback, does not know.
            nees += filter.nees(&[0, 1, 2, 3, 4], &left).unwrap();
        }
        assert!(in_band(nees, 5 * RUNS), "{form:?}: {nees} of {}", 5 * RUNS);
    }
}

/// A million IMU steps of a swaying base in 50 000 time updates, each with two measurements, one of them exact: P stays
/// symmetric to the last bit and positive.
#[test]
fn covariance_lives_long() {
    let model = Model::<15>::new(Form::Phi, NavStates::ALL, &sensors(1e-6, 1e-4, 1e-7, 1e-4)).unwrap();
    let free = schuler_strapdown::ErrorDynamics { vertical: Vertical::Free, ..HELD };
    let rest = at_rest(0.8, 0.5);
    let (_, f) = felt(&rest);
    let mut filter = Filter::new(model.clone(), &[10.0, 10.0, 10.0, 1.0, 1.0, 1.0, 1e-2, 1e-2, 0.1]).unwrap();
    let start = filter.p;
    let mut accumulator = Accumulator::new(&model, free, &rest);
    let row = Row::from_pairs([(2, 1.0)]);
    for update in 0..50_000usize {
        for k in 0..20 {
            let phase = (update * 20 + k) as f64 * 0.01;
            let sway =
                Euler::new(0.03 * phase.sin(), 0.02 * (1.3 * phase).sin(), 0.5 + 0.1 * (0.1 * phase).sin());
            let pva = Pva { c_tb: Rot::from_euler(sway), ..rest };
            accumulator.step(&model, &pva, &Increments { dtheta: Vec3::ZERO, dv: f * 0.01 }, 0.01);
        }
        filter.propagate(&accumulator.close(&model));
        filter.update(&ZeroVelocity::new(0.01), &Now::at(&rest)).unwrap();
        if update % 10 == 0 {
            filter.update_scalar(&row, 0.0, 0.0).unwrap();
        }
        if update % 5000 == 4999 {
            assert_eq!(filter.p, filter.p.transpose());
            let scaled = SMatrix::<f64, 15, 15>::from_fn(|i, j| {
                filter.p[(i, j)] / (start[(i, i)] * start[(j, j)]).sqrt()
            });
            let least = scaled.symmetric_eigen().eigenvalues.min();
            assert!(least > -1e-14, "{least:e} after {update}");
            assert!((0..15).all(|k| filter.p[(k, k)] > 0.0 || k == 2), "after {update}");
        }
    }
}
