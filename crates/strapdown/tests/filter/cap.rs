//! The cap of fading: where windup ends, and that what is observed fades as without it.

use nalgebra::{SMatrix, SVector};
use schuler_imu::process::LinearModel;
use schuler_strapdown::filter::strategy::{ExponentialFading, StrongTracking};
use schuler_strapdown::filter::{
    Filter, Form, Measurement, Model, NavStates, Now, Observability, ZeroVelocity, limit_covariance,
    measurement,
};

use crate::common::*;
use crate::simulation::Noise;

const LAT: f64 = 45.0 * DEG;
const SIGMAS: [f64; 9] = [0.0, 0.0, 0.0, 0.1, 0.1, 0.0, 0.1 * DEG, 0.1 * DEG, DEG];

/// Largest and smallest eigenvalue of P in units of the prior.
fn whitened(filter: &Filter<10>, prior: &SMatrix<f64, 10, 10>) -> [f64; 2] {
    let unit = |i: usize, j: usize| (prior[(i, i)] * prior[(j, j)]).sqrt();
    let w = SMatrix::<f64, 10, 10>::from_fn(|i, j| filter.p[(i, j)] / unit(i, j));
    let values = w.symmetric_eigenvalues();
    [values.max(), values.min()]
}

/// The limit covariance N (N' D⁻¹ N)⁻¹ N' is a projection in units of the prior D: its eigenvalues are one, and no fading
/// may go further. What is observed lies beside it and fades as without cap.
#[test]
fn windup_ends_at_the_limit_covariance() {
    let pva = at_rest(LAT, 0.0);
    let model = ten_states(&sensors(0.0, 0.0, 0.01 * DEGPH, 50.0 * UG));
    let p0 = model.p0(&SIGMAS).unwrap();
    let nothing_new = ZeroVelocity { sigma: 1e3, axes: measurement::HORIZONTAL }.observe(&Now::at(&pva));
    let mut observability = Observability::new(10, std::array::from_fn(|k| p0[(k, k)].sqrt()));
    let system = model.form().system(&HELD, &pva, felt(&pva).1);
    observability.add_observation(&model, &system, &seen(&pva), &nothing_new, &Now::at(&pva));
    let (null, nullity) = observability.null_space();
    let limit = limit_covariance(&null, nullity, &p0, 10);
    let step = at_rest_step(&model, &pva, 1e-6);
    // Beside it what is known a hundred times better than before: that fades alike.
    let known = (p0 - limit) * 1e-4;
    for cap in [true, false] {
        let mut filter = Filter::new(model.clone(), &SIGMAS).unwrap();
        filter.p = limit + known;
        if !cap {
            filter.cap = None;
        }
        for _ in 0..10 {
            let mut fading = ExponentialFading { lambda: 1.5 };
            filter.cycle(&mut fading, &step, &nothing_new, &Now::at(&pva)).unwrap();
        }
        let factor = 1.5f64.powi(10);
        let expected = limit * if cap { 1.0 } else { factor } + known * factor;
        for i in 0..10 {
            for j in 0..10 {
                let off = (filter.p[(i, j)] - expected[(i, j)]) / (p0[(i, i)] * p0[(j, j)]).sqrt();
                assert!(off.abs() < 1e-8 * factor, "({i}, {j}), cap {cap}: {off:e}");
            }
        }
    }
}

/// The combinations that are observed at rest (phi_N - nab_E/g, phi_E + nab_N/g and O c phi_D + O s phi_N - eps_E) fade with a
/// cap, and never more than without.
#[test]
fn what_is_observed_fades_beside_a_cap() {
    let pva = at_rest(LAT, 0.0);
    let model = ten_states(&sensors(0.003 * DEGPRTH, 10.0 * UG, 0.01 * DEGPH, 50.0 * UG));
    let step = at_rest_step(&model, &pva, 1.0);
    let still = ZeroVelocity { sigma: 0.02, axes: measurement::HORIZONTAL }.observe(&Now::at(&pva));
    let run = |cap: bool, lambda: f64| {
        let mut filter = Filter::new(model.clone(), &SIGMAS).unwrap();
        if !cap {
            filter.cap = None;
        }
        for _ in 0..600 {
            let mut fading = ExponentialFading { lambda };
            filter.cycle(&mut fading, &step, &still, &Now::at(&pva)).unwrap();
        }
        filter
    };
    let [plain, capped, free] = [run(true, 1.0), run(true, 1.01), run(false, 1.01)];
    let g = GRAVITY.gravity_t(pva.position)[2];
    let o = schuler_frames::wgs84::OMEGA;
    let (s, c) = LAT.sin_cos();
    let mut seen = [SVector::<f64, 10>::zeros(); 3];
    (seen[0][2], seen[0][6]) = (1.0, -1.0 / g);
    (seen[1][3], seen[1][5]) = (1.0, 1.0 / g);
    (seen[2][4], seen[2][2], seen[2][8]) = (o * c, o * s, -1.0);
    for h in seen {
        let variance = |filter: &Filter<10>| (h.transpose() * filter.p * h)[0];
        let [plain, capped, free] = [&plain, &capped, &free].map(variance);
        // What drifts at an unknown rate gains from a prior of that rate.
        assert!(capped > 1.5 * plain && capped < (1.0 + 1e-9) * free, "{plain:e} {capped:e} {free:e}");
    }
    let prior = model.p0(&SIGMAS).unwrap();
    let [most, _] = whitened(&capped, &prior);
    assert!(most < 1.0 + 1e-3, "{most}");
    // 1.01^600 = 391 along what is never observed.
    assert!((whitened(&free, &prior)[0] / 1.01f64.powi(600) - 1.0).abs() < 0.01);
}

/// Factors of their own for all states, as large as innovations of a thousand sigmas make them.
#[test]
fn no_inflation_leads_beyond_the_prior_or_makes_p_indefinite() {
    let pva = at_rest(LAT, 0.0);
    let model = ten_states(&sensors(0.003 * DEGPRTH, 10.0 * UG, 0.01 * DEGPH, 50.0 * UG));
    let step = at_rest_step(&model, &pva, 1.0);
    let prior = model.p0(&SIGMAS).unwrap();
    let mut noise = Noise::new(5);
    let mut filter = Filter::new(model, &SIGMAS).unwrap();
    let alpha = std::array::from_fn(|_| noise.normal().abs());
    let mut alone = filter.clone();
    let mut tracking = StrongTracking::with_weights(1.0, alpha);
    for second in 0..600 {
        let mut still = ZeroVelocity { sigma: 0.02, axes: measurement::HORIZONTAL }.observe(&Now::at(&pva));
        still.z = [20.0 * noise.normal(), 20.0 * noise.normal(), 0.0];
        filter.cycle(&mut tracking, &step, &still, &Now::at(&pva)).unwrap();
        let [most, least] = whitened(&filter, &prior);
        // Tilts make velocities: P grows by itself, which no cap has to hinder.
        alone.propagate(&step);
        let [limit, _] = whitened(&alone, &prior);
        assert!(most < limit && least > 0.0, "{second} s: {most} {limit} {least:e}");
        assert_eq!(filter.p, filter.p.transpose());
    }
}

/// A random walk that begins at zero has no prior; fading leaves it what it is, q t.
#[test]
fn a_state_without_prior_is_not_inflated() {
    let pva = at_rest(LAT, 0.0);
    let mut model =
        Model::<11>::new(Form::Phi, NavStates::LEVEL, &ten(&sensors(1e-6, 1e-4, 0.01 * DEGPH, 50.0 * UG)))
            .unwrap();
    let q = 0.04;
    let walk = model.add_extra("walk", &LinearModel::scalar(0.0, q, 0.0, 0.0)).unwrap();
    let step = at_rest_step(&model, &pva, 1.0);
    let still = ZeroVelocity { sigma: 0.02, axes: measurement::HORIZONTAL }.observe(&Now::at(&pva));
    let mut filter = Filter::new(model, &SIGMAS).unwrap();
    for _ in 0..100 {
        let mut fading = ExponentialFading { lambda: 1.1 };
        filter.cycle(&mut fading, &step, &still, &Now::at(&pva)).unwrap();
    }
    assert!((filter.p[(walk, walk)] / (100.0 * q) - 1.0).abs() < 1e-9, "{}", filter.p[(walk, walk)]);
}
