//! The coefficients of IEEE Std 952 come back out of simulated samples.

use schuler_imu::{Imu, Source, Spec, Stream, Truth, Value};

use schuler_imu::Instrument::Gyro;

const RUNS: u64 = 200;

/// Root mean of the Allan variance at averages of `m` steps of `dt` over runs and axes.
fn allan_deviation(process: &str, given: &[(&str, Value<'_>)], dt: f64, m: usize, differences: usize) -> f64 {
    let spec = Spec::from_sources([Source::named(Gyro, "bias", process, given).unwrap()]).unwrap();
    let mut imu = Imu::new(&spec, Stream::default()).unwrap();
    let still = Truth::rates([0.0; 3], [0.0; 3]);
    let (mut sum, mut count) = (0.0, 0.0);
    for run in 0..RUNS {
        imu.restart(Stream { seed: 2026, run });
        let mut means = vec![[0.0; 3]; differences + 1];
        for mean in &mut means {
            for _ in 0..m {
                let e = imu.step(dt, &still).omega_error;
                (0..3).for_each(|i| mean[i] += e[i] / m as f64);
            }
        }
        for w in means.windows(2) {
            for i in 0..3 {
                sum += 0.5 * (w[1][i] - w[0][i]).powi(2);
                count += 1.0;
            }
        }
    }
    f64::sqrt(sum / count)
}

/// Two hundred runs give each coefficient within 2 %; the formulas are those of the standard.
#[test]
fn coefficients_come_back_within_two_percent() {
    let close = |name: &str, found: f64, expected: f64| {
        assert!((found / expected - 1.0).abs() < 0.02, "{name}: {found}, expected {expected}");
    };
    let n = allan_deviation("white", &[("density", 0.3.into())], 0.01, 10, 100) * 0.1_f64.sqrt();
    close("N", n, 0.3);
    let k =
        allan_deviation("random_walk", &[("density", 0.02.into())], 0.5, 10, 100) * (3.0_f64 / 5.0).sqrt();
    close("K", k, 0.02);
    let band = [("instability", 0.7.into()), ("tau_min", 1.0.into()), ("tau_max", 1000.0.into())];
    close("B", allan_deviation("flicker", &band, 1.0, 20, 50) / 0.664_283, 0.7);
    let q = allan_deviation("quantization", &[("q", 1e-4.into())], 0.01, 5, 100) * 0.05 / 3.0_f64.sqrt();
    close("Q", q, 1e-4);
    let r = allan_deviation("ramp", &[("rate", 1e-3.into())], 1.0, 10, 5) * 2.0_f64.sqrt() / 10.0;
    close("R", r, 1e-3);
    // Highest point of the Markov curve, 0.617364 sigma at 1.89262 tau.
    let markov = [("sigma", 0.05.into()), ("tau", 10.0.into())];
    close("Markov sigma", allan_deviation("gauss_markov", &markov, 1.89262, 10, 100) / 0.617_364, 0.05);
}
