use schuler_allan::{Estimator, NoiseType, Phase, edf, identify, quantile, variance_factors};

use crate::estimators::estimator;
use crate::support::{
    series::table,
    simulate::{Simulator, Truth},
};

/// scipy 1.17.1, `scipy.stats.chi2.ppf(p, edf)` for p = 0.025, 0.15865, 0.5, 0.84135, 0.975.
#[test]
fn quantiles_of_chi_square_agree_with_scipy() {
    let p = [0.025, 0.15865, 0.5, 0.84135, 0.975];
    for (nu, want) in [
        (
            1.0,
            [
                0.0009820691171752555,
                0.04006681511396314,
                0.454936423119572,
                1.9870468495776195,
                5.023886187314888,
            ],
        ),
        (
            2.5,
            [
                0.11862294210006345,
                0.5742407648752801,
                1.8738477677808791,
                4.449310754657472,
                8.392295266912964,
            ],
        ),
        (
            5.0,
            [0.8312116134866625, 2.055952804886232, 4.351460191095526, 7.956488340503097, 12.832501994030027],
        ),
        (
            25.3,
            [
                13.336401204278264,
                18.281595353894012,
                24.636547026945973,
                32.32084067526401,
                41.03006127663413,
            ],
        ),
        (
            2527.2,
            [2389.761597168926, 2456.11357095805, 2526.5333646071444, 2598.286510395049, 2668.42679895778],
        ),
        (
            1.5e5,
            [
                148928.37907366268,
                149452.26679594623,
                149999.3333338601,
                150547.73326235163,
                151075.40953446625,
            ],
        ),
    ] {
        for (p, want) in p.into_iter().zip(want) {
            let got = quantile(nu, p).unwrap();
            assert!((got / want - 1.0).abs() < 1e-9, "nu={nu} p={p}: {got}, scipy {want}");
        }
    }
}

/// At edf 5 the 95 % interval of the deviation is -38 % .. +145 %: sqrt(5/12.8325), sqrt(5/0.83121).
#[test]
fn an_interval_at_five_degrees_of_freedom() {
    let (low, high) = variance_factors(5.0, 0.95).unwrap();
    assert!((low.sqrt() - 0.6242).abs() < 1e-4 && (high.sqrt() - 2.4526).abs() < 1e-4);
    assert!(variance_factors(5.0, 95.0).is_err());
    assert!(variance_factors(0.0, 0.95).is_err());
}

/// allantools follows Greenhall and Riley with its tables above 100 lags (1 to 2 % off the sum, they say) and
/// takes phase as averaged below m = 33, where the closed forms below serve; see tests/data/allan/README.md.
#[test]
fn degrees_of_freedom_agree_with_greenhall_and_riley() {
    for row in table("allan/allantools_edf.csv") {
        let noise = match row[1].as_str() {
            "0" => NoiseType::White,
            "-1" => NoiseType::Flicker,
            _ => NoiseType::RandomWalk,
        };
        let (m, want): (usize, f64) = (row[2].parse().unwrap(), row[3].parse().unwrap());
        if m < 33 {
            continue;
        }
        let got = edf(estimator(&row[0]), noise, m, 5001);
        assert!((got / want - 1.0).abs() < 0.025, "{} {noise:?} m={m}: {got}, reference {want}", row[0]);
    }
}

/// The closed forms for the overlapping Allan variance (NIST SP 1065, section 5.4.1) are approximate.
#[test]
fn degrees_of_freedom_agree_with_the_closed_forms() {
    let n_phase = 5001;
    let n = n_phase as f64;
    for m in [2, 8, 32, 128, 512, 1024] {
        let k = m as f64;
        let white = 4.0 * k * k / (4.0 * k * k + 5.0) * (3.0 * (n - 1.0) / (2.0 * k) - 2.0 * (n - 2.0) / n);
        let flicker = 5.0 * n * n / (4.0 * k * (n + 3.0 * k));
        let walk =
            (n - 2.0) / k * ((n - 1.0).powi(2) - 3.0 * k * (n - 1.0) + 4.0 * k * k) / (n - 3.0).powi(2);
        for (noise, want) in
            [(NoiseType::White, white), (NoiseType::Flicker, flicker), (NoiseType::RandomWalk, walk)]
        {
            let got = edf(Estimator::Overlapping, noise, m, n_phase);
            assert!((got / want - 1.0).abs() < 0.25, "{noise:?} m={m}: {got}, closed form {want}");
        }
    }
}

/// White phase at every factor: differences 1 -2 1 correlate by -2/3 and 1/6 at one and two averaging times,
/// so M / edf tends to 1 + 2 (4/9 + 1/36) = 35/18.
#[test]
fn degrees_of_freedom_of_quantization() {
    for m in [1, 16] {
        let got = edf(Estimator::Overlapping, NoiseType::Quantization, m, 1_000_001);
        assert!((got / (1e6 * 18.0 / 35.0) - 1.0).abs() < 1e-4);
    }
}

/// Hundred logs of each noise, 1024 samples: at m = 4 the type is told right nearly always (256 averages; the
/// lag-1 autocorrelation scatters by 1/16 or less, and half the distance between types is 0.14 at least).
#[test]
fn noise_types_are_told_apart() {
    for (truth, noise) in [
        (Truth { quantization: 1.0, ..Truth::default() }, NoiseType::Quantization),
        (Truth { white: 1.0, ..Truth::default() }, NoiseType::White),
        (Truth { flicker: 1.0, ..Truth::default() }, NoiseType::Flicker),
        (Truth { random_walk: 1.0, ..Truth::default() }, NoiseType::RandomWalk),
    ] {
        let mut simulator = Simulator::new(truth, 1024, 1.0);
        let right = (0..100)
            .filter(|run| identify(&Phase::from_rate(&simulator.rate(*run), 1.0).unwrap(), 4) == Some(noise))
            .count();
        assert!(right >= 95, "{noise:?}: {right} of 100");
        let short = Phase::from_rate(&simulator.rate(0), 1.0).unwrap();
        assert_eq!(identify(&short, 64), None);
    }
}

/// The total variance has more degrees of freedom than the overlapping one at the longest times (NIST SP 1065,
/// table 9: 1.5 T/tau for white noise), and the same at short ones.
#[test]
fn the_total_variance_gains_at_long_times() {
    let at = |e, m| edf(e, NoiseType::White, m, 1025);
    assert!((at(Estimator::Total, 512) - 3.0).abs() < 1e-12);
    assert!(at(Estimator::Total, 512) > 1.5 * at(Estimator::Overlapping, 512));
    assert!((at(Estimator::Total, 16) / at(Estimator::Overlapping, 16) - 1.0).abs() < 0.05);
}
