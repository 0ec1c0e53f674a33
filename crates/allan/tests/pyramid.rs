use schuler_allan::{Curve, Estimator, Fitter, Grid, NoiseType, Phase, Pyramid, Term, edf, pyramid_edf};

use crate::support::{
    cases,
    series::lehmer,
    simulate::{Normals, Simulator},
};

/// Percent of variance that the pyramid pays well above eight samples: the sum of the squared autocorrelation of
/// second differences at every eighth of an averaging time over that at every 4000th, made apart from this crate with
/// phase covariances |t|, t² ln|t|, |t|³.
const PRICE: [(NoiseType, f64); 3] =
    [(NoiseType::White, 1.953), (NoiseType::Flicker, 0.038), (NoiseType::RandomWalk, 0.0004)];

fn walk(n: usize) -> Vec<f64> {
    let mut r = 0.0;
    lehmer(7, n)
        .iter()
        .map(|y| {
            r += (y - 0.5) / 16.0;
            y + r
        })
        .collect()
}

/// Up to m = 8 the pyramid takes every difference; above, those that start at multiples of m/8.
#[test]
fn a_pyramid_takes_exactly_the_differences_it_says() {
    for n in [3, 8, 9, 15, 16, 17, 33, 511, 512, 513, 4096, 70_001] {
        let rate = walk(n);
        let mut pyramid = Pyramid::new(0.01).unwrap();
        pyramid.push(&rate).unwrap();
        let curve = pyramid.curve().unwrap();
        let phase = Phase::from_rate(&rate, 0.01).unwrap();
        let full = Curve::estimate(&phase, Estimator::Overlapping, &Grid::Octave).unwrap();
        assert!(curve.points.iter().map(|p| p.m).eq(full.points.iter().map(|p| p.m)), "n={n}");
        for p in &curve.points {
            let step = (p.m / 8).max(1);
            let squares: Vec<f64> = (0..=n - 2 * p.m)
                .step_by(step)
                .map(|k| {
                    let x = phase.samples();
                    (x[k + 2 * p.m] - 2.0 * x[k + p.m] + x[k]).powi(2)
                })
                .collect();
            assert_eq!(p.terms, squares.len(), "n={n} m={}", p.m);
            let want = squares.iter().sum::<f64>() / (2.0 * p.tau * p.tau * p.terms as f64);
            assert!((p.variance / want - 1.0).abs() < 1e-11, "n={n} m={}", p.m);
        }
    }
}

#[test]
fn how_a_stream_is_cut_changes_no_bit() {
    let rate = walk(20_000);
    let mut whole = Pyramid::new(0.01).unwrap();
    whole.push(&rate).unwrap();
    for size in [1, 7, 512, 1000] {
        let mut cut = Pyramid::new(0.01).unwrap();
        for part in rate.chunks(size) {
            cut.push(part).unwrap();
        }
        // Asking on the way changes nothing either.
        assert!(cut.curve().is_ok());
        assert_eq!(cut.curve(), whole.curve(), "parts of {size}");
    }
}

/// 4000 logs of white noise: the variances of the two estimates, whose ratio is the price of memory. The two are
/// correlated by about 0.99, so that the ratio has a standard deviation of sqrt(4 (1 - 0.99²) / 4000) = 0.0045.
#[test]
fn the_price_in_variance_is_as_stated() {
    let (n, m, runs) = (1024, 64, 4000);
    let (mut full, mut sparse) = (Vec::new(), Vec::new());
    let mut normals = Normals::new(99);
    for _ in 0..runs {
        let rate: Vec<f64> = (0..n).map(|_| normals.normal()).collect();
        let phase = Phase::from_rate(&rate, 1.0).unwrap();
        full.push(
            Curve::estimate(&phase, Estimator::Overlapping, &Grid::Factors(vec![m])).unwrap().points[0]
                .variance,
        );
        let mut pyramid = Pyramid::new(1.0).unwrap();
        pyramid.push(&rate).unwrap();
        sparse.push(pyramid.curve().unwrap().points.iter().find(|p| p.m == m).unwrap().variance);
    }
    let spread = |v: &[f64]| {
        let mean = v.iter().sum::<f64>() / v.len() as f64;
        v.iter().map(|s| (s / mean - 1.0).powi(2)).sum::<f64>() / v.len() as f64
    };
    let got = spread(&sparse) / spread(&full);
    let want =
        edf(Estimator::Overlapping, NoiseType::White, m, n + 1) / pyramid_edf(NoiseType::White, m, n + 1);
    assert!(want > 1.0 && want < 1.03, "{want}");
    assert!((got - want).abs() < 4.0 * 0.0045, "{got}, theory {want}");
}

/// What the documentation of the pyramid says of its price, a long log.
#[test]
fn the_price_of_each_noise_is_as_documented() {
    let n = 1 << 24;
    for (noise, percent) in PRICE {
        for m in [64, 1024, 1 << 16] {
            let price = edf(Estimator::Overlapping, noise, m, n) / pyramid_edf(noise, m, n) - 1.0;
            assert!((100.0 * price - percent).abs() < 0.06, "{noise:?} {m}: {price}");
        }
    }
    // White phase: a difference that is left out is lost.
    let price = edf(Estimator::Overlapping, NoiseType::Quantization, 1024, n)
        / pyramid_edf(NoiseType::Quantization, 1024, n);
    assert!((price / 128.0 - 1.0).abs() < 0.01, "{price}");
}

/// A log that quantization rules up to a thousand samples, where the pyramid leaves out 127 of 128 differences: no
/// misfit is seen that is none, and intervals hold the truth. 60 intervals of 95 % hold it 57 ± 1.7 times.
#[test]
fn a_fit_knows_which_differences_a_pyramid_took() {
    let case = cases::cases().remove(5);
    let mut simulator = Simulator::new(case.truth, cases::SAMPLES, cases::TAU0);
    let (mut fitter, mut held, mut misfits) = (None, 0, 0);
    for run in 0..20 {
        let mut pyramid = Pyramid::new(cases::TAU0).unwrap();
        pyramid.push(&simulator.rate(case.seed + run)).unwrap();
        let curve = pyramid.curve().unwrap();
        let fit = fitter.get_or_insert_with(|| Fitter::new(&curve).unwrap()).fit(&curve).unwrap();
        misfits += usize::from(fit.misfit);
        held += [Term::Quantization, Term::White, Term::Flicker]
            .iter()
            .filter(|term| {
                let (low, high) = fit.parameter(**term).unwrap().interval;
                (low..=high).contains(&case.truth.value(**term))
            })
            .count();
    }
    assert!(misfits <= 1, "{misfits} misfits");
    assert!(held >= 50, "{held} of 60");
}
