use std::f64::consts::{LN_2, PI};

use schuler_allan::{Curve, Estimator, Grid, NoiseType, Phase, edf};

use crate::support::simulate::{Simulator, Truth};

const N: usize = 1024;
const RUNS: usize = 1000;
const TAU0: f64 = 0.1;

/// Allan variance over tau.
type Law<'a> = &'a dyn Fn(f64) -> f64;

/// Estimates at m = 1, 8, 64 of each run.
fn estimates(truth: Truth, estimator: Estimator) -> Vec<[f64; 3]> {
    let mut simulator = Simulator::new(truth, N, TAU0);
    (0..RUNS)
        .map(|run| {
            let phase = Phase::from_rate(&simulator.rate(run as u64), TAU0).unwrap();
            let curve = Curve::estimate(&phase, estimator, &Grid::Factors(vec![1, 8, 64])).unwrap();
            [0, 1, 2].map(|i| curve.points[i].variance)
        })
        .collect()
}

fn mean(runs: &[[f64; 3]], i: usize) -> f64 {
    runs.iter().map(|r| r[i]).sum::<f64>() / RUNS as f64
}

/// Two things at once: simulated logs have the Allan variance of the closed forms, and their estimates scatter
/// with the degrees of freedom that theory gives.
#[test]
fn simulated_logs_have_the_variances_and_the_scatter_of_theory() {
    let (q, n, b, k) = (0.3, 0.2, 0.5, 0.7);
    let laws: [(Truth, NoiseType, Law); 4] = [
        (Truth { quantization: q, ..Truth::default() }, NoiseType::Quantization, &|t| 3.0 * (q / t).powi(2)),
        (Truth { white: n, ..Truth::default() }, NoiseType::White, &|t| n * n / t),
        (Truth { flicker: b, ..Truth::default() }, NoiseType::Flicker, &|_| 2.0 * LN_2 / PI * b * b),
        (Truth { random_walk: k, ..Truth::default() }, NoiseType::RandomWalk, &|t| k * k * t / 3.0),
    ];
    for (truth, noise, law) in laws {
        for estimator in [Estimator::Overlapping, Estimator::NonOverlapping] {
            let runs = estimates(truth, estimator);
            for (i, m) in [1, 8, 64].into_iter().enumerate() {
                let edf = edf(estimator, noise, m, N + 1);
                let (got, want) = (mean(&runs, i), law(m as f64 * TAU0));
                let sigma = (2.0 / edf / RUNS as f64).sqrt();
                assert!(
                    (got / want - 1.0).abs() < 4.0 * sigma,
                    "{estimator:?} {noise:?} m={m}: {got}, {want}"
                );

                let scatter = runs.iter().map(|r| (r[i] / want - 1.0).powi(2)).sum::<f64>() / RUNS as f64;
                // Kurtosis of a chi-square: 3 + 12/edf.
                let sigma = ((2.0 + 12.0 / edf) / RUNS as f64).sqrt();
                let ratio = scatter * edf / 2.0;
                assert!((ratio - 1.0).abs() < 4.0 * sigma, "{estimator:?} {noise:?} m={m}: scatter {ratio}");
            }
        }
    }
}

/// Markov: (q T)²/tau [1 - T/(2 tau)(3 - 4 e^(-tau/T) + e^(-2 tau/T))] with q² T / 2 = sigma².
#[test]
fn simulated_markov_and_sinusoid_have_the_variances_of_theory() {
    let (sigma, tau_c) = (0.4, 2.0);
    let runs = estimates(Truth { markov: Some((sigma, tau_c)), ..Truth::default() }, Estimator::Overlapping);
    for (i, m) in [1, 8, 64].into_iter().enumerate() {
        let tau = m as f64 * TAU0;
        let x = tau / tau_c;
        let want = 2.0 * sigma * sigma / x * (1.0 - (3.0 - 4.0 * (-x).exp() + (-2.0 * x).exp()) / (2.0 * x));
        // The scatter lies below that of white noise at m = 64 and of random walk at m = 1: about 10 %.
        assert!((mean(&runs, i) / want - 1.0).abs() < 0.04, "m={m}: {}, {want}", mean(&runs, i));
    }
    let (amplitude, f0) = (0.3, 0.57);
    let runs =
        estimates(Truth { sinusoid: Some((amplitude, f0)), ..Truth::default() }, Estimator::Overlapping);
    for (i, m) in [1, 8, 64].into_iter().enumerate() {
        let x = PI * f0 * m as f64 * TAU0;
        let want = (amplitude * x.sin().powi(2) / x).powi(2);
        assert!((mean(&runs, i) / want - 1.0).abs() < 0.02, "m={m}: {}, {want}", mean(&runs, i));
    }
}
