//! The fixed-interval smoother against batch least squares.

use nalgebra::{SMatrix, SVector};
use schuler_strapdown::filter::{Filter, Measurement, Now, Record, ZeroVelocity, measurement, smooth};

use crate::common::*;
use crate::simulation::{Noise, Truth};

/// Eight steps of ten states: all 90 unknowns and their covariance from one set of normal equations, in units of the
/// standard deviations at the start.
#[test]
fn smoothed_estimates_are_those_of_least_squares() {
    const STEPS: usize = 8;
    const ALL: usize = 10 * (STEPS + 1);
    let pva = at_rest(0.8, 0.3);
    let spec = sensors(0.003 * DEGPRTH, 10.0 * UG, 0.01 * DEGPH, 50.0 * UG);
    let mut model = ten_states(&spec);
    // Noise on every navigation error and a long step, so that Q has an inverse in these units.
    model.nav_noise = [0.0, 0.0, 0.0, 1e-6, 1e-6, 0.0, 1e-10, 1e-10, 1e-8];
    let mut step = at_rest_step(&model, &pva, 30.0);
    let sigmas = [0.0, 0.0, 0.0, 0.1, 0.1, 0.0, 1e-3, 1e-3, 1e-2];
    let mut filter = Filter::new(model, &sigmas).unwrap();
    let start = filter.p;
    let mut noise = Noise::new(5);
    let mut truth = Truth::new(&step, &start, &mut noise);
    let unit: Vec<f64> = (0..10).map(|k| start[(k, k)].sqrt()).collect();
    let mut information = SMatrix::<f64, ALL, ALL>::zeros();
    let mut right = SVector::<f64, ALL>::zeros();
    for k in 0..10 {
        information[(k, k)] += 1.0;
    }
    // Biases do not move, so their Q is nothing: for the sake of its inverse they drift a little, in both.
    let drift = 0.05;
    let mut records: Vec<Record<10>> = Vec::new();
    step.dt = 30.0;
    let full_q = {
        let mut q = step.q();
        for k in 5..10 {
            q[(k, k)] += (drift * unit[k]).powi(2);
        }
        q
    };
    for number in 1..=STEPS {
        truth.step(&mut noise);
        filter.propagate(&step);
        for k in 5..10 {
            filter.p[(k, k)] += (drift * unit[k]).powi(2);
        }
        let mut record = Record::predicted(&filter, &step);
        let still = ZeroVelocity { sigma: 0.02, axes: measurement::HORIZONTAL };
        let mut observation = still.observe(&Now::at(&pva));
        for axis in 0..2 {
            observation.z[axis] = truth.x[axis] + 0.02 * noise.normal();
        }
        filter.update_with(&observation, &Now::at(&pva)).unwrap();
        record.updated(&filter);
        records.push(record);

        let scaled =
            |m: SMatrix<f64, 10, 10>| SMatrix::<f64, 10, 10>::from_fn(|i, j| m[(i, j)] * unit[j] / unit[i]);
        let weight = SMatrix::<f64, 10, 10>::from_fn(|i, j| full_q[(i, j)] / (unit[i] * unit[j]))
            .try_inverse()
            .unwrap();
        let mut a = SMatrix::<f64, 10, ALL>::zeros();
        a.fixed_view_mut::<10, 10>(0, 10 * number).fill_with_identity();
        a.fixed_view_mut::<10, 10>(0, 10 * (number - 1)).copy_from(&-scaled(step.phi()));
        information += a.transpose() * weight * a;
        for axis in 0..2 {
            let k = 10 * number + axis;
            information[(k, k)] += (unit[axis] / 0.02).powi(2);
            right[k] += unit[axis] / 0.02 * observation.z[axis] / 0.02;
        }
    }
    let covariance = information.try_inverse().unwrap();
    let batch = covariance * right;

    let filtered = records.clone();
    smooth(&mut records, 10);
    for (number, record) in records.iter().enumerate() {
        let first = 10 * (number + 1);
        for i in 0..10 {
            let sigma = record.p[(i, i)].sqrt();
            let x = batch[first + i] * unit[i];
            assert!((record.x[i] - x).abs() < 1e-9 * sigma, "x{i} at {number}: {} {x}", record.x[i]);
            for j in 0..10 {
                let p = covariance[(first + i, first + j)] * unit[i] * unit[j];
                let size = sigma * record.p[(j, j)].sqrt();
                assert!((record.p[(i, j)] - p).abs() < 1e-9 * size, "P{i}{j} at {number}");
            }
            assert!(record.p[(i, i)] <= filtered[number].p[(i, i)] * (1.0 + 1e-12));
        }
        // Not only the variances: the difference is positive semidefinite.
        let gain = filtered[number].p - record.p;
        let scaled = SMatrix::<f64, 10, 10>::from_fn(|i, j| gain[(i, j)] / (unit[i] * unit[j]));
        let least = scaled.symmetric_eigen().eigenvalues.min();
        assert!(least > -1e-12, "{least:e} at {number}");
    }
}

/// Constant states without process noise, some known exactly at the start: all records end at the last estimate.
#[test]
fn constants_are_smoothed_to_the_last_estimate() {
    let pva = at_rest(0.8, 0.3);
    let model = ten_states(&sensors(1e-6, 1e-4, 0.01 * DEGPH, 50.0 * UG));
    let step = at_rest_step(&model, &pva, 1.0);
    let mut filter = Filter::new(model, &[0.0, 0.0, 0.0, 0.1, 0.1, 0.0, 1e-3, 1e-3, 0.0]).unwrap();
    filter.p.row_mut(9).fill(0.0);
    filter.p.column_mut(9).fill(0.0);
    let mut records = Vec::new();
    for k in 0..50 {
        filter.propagate(&step);
        let mut record = Record::predicted(&filter, &step);
        let mut observation =
            ZeroVelocity { sigma: 0.02, axes: measurement::HORIZONTAL }.observe(&Now::at(&pva));
        observation.z[0] = 0.01 * f64::from(k % 7) - 0.03;
        filter.update_with(&observation, &Now::at(&pva)).unwrap();
        record.updated(&filter);
        records.push(record);
    }
    smooth(&mut records, 10);
    let last = records.last().unwrap().clone();
    for record in &records {
        for k in 5..10 {
            let sigma = last.p[(k, k)].sqrt();
            assert!((record.x[k] - last.x[k]).abs() <= 1e-6 * sigma, "{k}");
            assert!((record.p[(k, k)] - last.p[(k, k)]).abs() <= 1e-6 * sigma * sigma, "{k}");
        }
    }
}
