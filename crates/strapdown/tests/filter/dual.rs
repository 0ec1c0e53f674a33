//! Covariance of the true errors of a filter with another model than the truth.

use schuler_imu::Instrument::{Accel, Gyro};
use schuler_imu::{Source, Spec};
use schuler_strapdown::filter::{
    Dual, Filter, Form, Measurement, Model, NavStates, Now, ZeroVelocity, measurement,
};

use crate::common::*;
use crate::simulation::{Noise, Truth};

const SIGMAS: [f64; 9] = [0.0, 0.0, 0.0, 0.1, 0.1, 0.0, 0.1 * DEG, 0.1 * DEG, DEG];

fn still(sigma: f64) -> ZeroVelocity {
    ZeroVelocity { sigma, axes: measurement::HORIZONTAL }
}

/// Equal lists: the true covariance is the filter's.
#[test]
fn equal_models_give_the_covariance_of_the_filter() {
    let pva = at_rest(0.8, 0.5);
    let model = ten_states(&sensors(0.003 * DEGPRTH, 10.0 * UG, 0.01 * DEGPH, 50.0 * UG));
    let step = at_rest_step(&model, &pva, 1.0);
    let filter = Filter::new(model.clone(), &SIGMAS).unwrap();
    let mut dual = Dual::new(model, &SIGMAS, filter).unwrap();
    let now = Now::at(&pva);
    for _ in 0..600 {
        dual.propagate(&step, &step);
        dual.update(&still(0.02).observe(&now), &now, [0.02 * 0.02; 3], &[]).unwrap();
    }
    for i in 0..10 {
        for j in 0..10 {
            let size = dual.filter.sigma(i) * dual.filter.sigma(j);
            let off = (dual.error_covariance(i, j) - dual.filter.p[(i, j)]).abs();
            assert!(off < 1e-7 * size, "({i}, {j}): {:e}", off / size);
        }
    }
}

/// Truth has Gauss-Markov gyro errors, correlated velocity noise and a worse start than the filter, whose list has
/// constants. 2000 simulated runs: each variance within four standard deviations of its estimate, sqrt(2/2000).
#[test]
fn mismatched_models_give_the_spread_of_simulated_runs() {
    let pva = at_rest(0.8, 0.5);
    let filter_model = ten_states(&sensors(0.003 * DEGPRTH, 10.0 * UG, 0.01 * DEGPH, 50.0 * UG));
    let source = |i, process, given: &[(&str, f64)]| {
        let given: Vec<_> = given.iter().map(|(name, value)| (*name, (*value).into())).collect();
        Source::named(i, "bias", process, &given).unwrap()
    };
    let truth_spec = Spec::from_sources([
        source(Gyro, "white", &[("density", 0.006 * DEGPRTH)]),
        source(Accel, "white", &[("density", 10.0 * UG)]),
        source(Gyro, "gauss_markov", &[("sigma", 0.05 * DEGPH), ("tau", 100.0)]),
        source(Accel, "constant", &[("sigma", 50.0 * UG)]),
        source(Gyro, "constant", &[("sigma", 0.02 * DEGPH)]),
    ])
    .unwrap();
    let mut truth_model = Model::<20>::new(Form::Phi, NavStates::LEVEL, &truth_spec).unwrap();
    let colour = gauss_markov(0.02, 10.0);
    let extra =
        ["velocity noise n", "velocity noise e"].map(|name| truth_model.add_extra(name, &colour).unwrap());
    let wide = SIGMAS.map(|s| 2.0 * s);
    let steps = (at_rest_step(&truth_model, &pva, 1.0), at_rest_step(&filter_model, &pva, 1.0));
    let now = Now::at(&pva);
    let extra = [(extra[0], [1.0, 0.0, 0.0]), (extra[1], [0.0, 1.0, 0.0])];
    let white = 0.005;

    let filter = Filter::new(filter_model, &SIGMAS).unwrap();
    let mut dual = Dual::new(truth_model.clone(), &wide, filter.clone()).unwrap();
    const RUNS: usize = 2000;
    const SECONDS: usize = 200;
    let observation = still(0.02).observe(&now);
    for _ in 0..SECONDS {
        dual.propagate(&steps.0, &steps.1);
        dual.update(&observation, &now, [white * white; 3], &extra).unwrap();
    }

    // The gains do not depend on the run: the covariance is made once, the runs by its gains.
    let mut squares = [0.0; 10];
    let p0 = truth_model.p0(&wide).unwrap();
    let twins: Vec<usize> = (0..10)
        .map(|k| if k < 5 { k } else { truth_model.index(&dual.filter.model().name(k).to_string()).unwrap() })
        .collect();
    let mut noise = Noise::new(77);
    let mut gains = Vec::new();
    {
        let mut f = filter.clone();
        for _ in 0..SECONDS {
            f.propagate(&steps.1);
            f.update_with(&observation, &now).unwrap();
            gains.push(f.p.fixed_view::<10, 2>(0, 0).into_owned() / (0.02 * 0.02));
        }
    }
    let phi = steps.1.phi();
    for _ in 0..RUNS {
        let mut truth = Truth::new(&steps.0, &p0, &mut noise);
        let mut x = nalgebra::SVector::<f64, 10>::zeros();
        for gain in &gains {
            truth.step(&mut noise);
            x = phi * x;
            let nu = nalgebra::Vector2::from_fn(|a, _| {
                truth.x[a] + truth.x[extra[a].0] + white * noise.normal() - x[a]
            });
            x += gain * nu;
        }
        for k in 0..10 {
            let error = x[k] - truth.x[twins[k]];
            squares[k] += error * error / RUNS as f64;
        }
    }
    for k in 0..10 {
        let ratio = squares[k] / dual.error_variance(k);
        let name = dual.filter.model().name(k).to_string();
        assert!((ratio - 1.0).abs() < 4.0 * (2.0 / RUNS as f64).sqrt(), "{name}: {ratio}");
    }
    // The filter knows nothing of it.
    assert!(dual.error_variance(4) > 2.0 * dual.filter.p[(4, 4)]);
}
