//! The readout against closed forms.

use schuler_imu::readout::{Bandwidth, Channel, Faults, Lsb, Output, Sampling, Timing};
use schuler_imu::{Imu, Readout, Sample, Spec, Stream, Truth};

fn imu(gyro: Channel) -> Imu {
    let mut spec = Spec::new();
    spec.readout = Some(Readout { gyro, accel: Channel::default() });
    Imu::new(&spec, Stream { seed: 3, run: 4 }).unwrap()
}

fn rate(x: f64) -> Truth {
    Truth::rates([x, 0.5 * x, -x], [1.0, 2.0, 3.0])
}

fn run(imu: &mut Imu, dt: f64, inputs: impl IntoIterator<Item = f64>) -> Vec<Sample> {
    inputs.into_iter().map(|x| imu.step(dt, &rate(x))).collect()
}

#[test]
fn the_default_passes_everything_through() {
    for s in run(&mut imu(Channel::default()), 0.01, [1.0, -2.0, 0.3]) {
        assert_eq!(s.dv, [0.01, 0.02, 0.03]);
        assert!(s.omega_error.iter().all(|e| e.abs() < 1e-15));
    }
}

/// Step response of a second-order low pass, from the textbook, for each kind of damping.
#[test]
fn bandwidth_has_the_step_response_of_its_order() {
    let (f0, dt) = (8.0, 0.003);
    let w = f0 * std::f64::consts::TAU;
    for damping in [0.3, std::f64::consts::FRAC_1_SQRT_2, 1.0, 2.5] {
        let response = |t: f64| -> f64 {
            let (a, b) = (damping * w, w * (1.0 - damping * damping).abs().sqrt());
            match damping {
                d if d < 1.0 => 1.0 - (-a * t).exp() * ((b * t).cos() + a / b * (b * t).sin()),
                d if d > 1.0 => 1.0 - (-a * t).exp() * ((b * t).cosh() + a / b * (b * t).sinh()),
                _ => 1.0 - (-w * t).exp() * (1.0 + w * t),
            }
        };
        for sampling in [Sampling::Mean, Sampling::Point] {
            let bandwidth = Some(Bandwidth { natural_frequency: f0, damping });
            let mut imu = imu(Channel { bandwidth, sampling, ..Channel::default() });
            // Settled on zero, then one.
            run(&mut imu, dt, [0.0]);
            for (k, s) in run(&mut imu, dt, [1.0; 100]).iter().enumerate() {
                let t = k as f64 * dt;
                let expected = match sampling {
                    Sampling::Point => response(t + dt),
                    // Simpson's rule.
                    Sampling::Mean => {
                        let h = dt / 400.0;
                        let weight = |j: i32| match j {
                            0 | 400 => 1.0,
                            j if j % 2 == 1 => 4.0,
                            _ => 2.0,
                        };
                        (0..=400).map(|j| weight(j) * response(t + f64::from(j) * h)).sum::<f64>() / 1200.0
                    }
                };
                assert!((s.omega()[0] - expected).abs() < 1e-11, "{damping} {sampling:?} {k}");
            }
        }
    }
}

#[test]
fn point_sampling_needs_a_bandwidth() {
    let gyro = Channel { sampling: Sampling::Point, ..Channel::default() };
    let error = Readout { gyro, ..Readout::default() }.validate().unwrap_err();
    assert!(error.to_string().contains("white noise has no point value"), "{error}");
}

#[test]
fn out_of_range_is_clamped_and_flagged() {
    let mut imu = imu(Channel { range: Some([(-1.0, 1.0), (-0.4, 2.0), (-5.0, 5.0)]), ..Channel::default() });
    let s = run(&mut imu, 0.01, [-1.5])[0];
    assert_eq!(s.gyro.saturated, [true, true, false]);
    for (found, expected) in s.omega().iter().zip([-1.0, -0.4, 1.5]) {
        assert!((found - expected).abs() < 1e-15);
    }
    assert_eq!(run(&mut imu, 0.01, [0.7])[0].gyro.saturated, [false; 3]);
}

/// With the remainder carried the sum of increments is off by half a bit at most; without, a rate
/// below half a bit per sample is never seen (theory of the dead zone).
#[test]
fn least_significant_bits() {
    let size = [1e-3; 3];
    for carry in [true, false] {
        let mut imu = imu(Channel { lsb: Some(Lsb { size, carry }), ..Channel::default() });
        let mut sum = 0.0;
        for (k, s) in run(&mut imu, 0.01, [0.04; 1000]).iter().enumerate() {
            sum += s.dtheta[0];
            let truth = 0.04 * 0.01 * (k + 1) as f64;
            if carry {
                assert!((sum - truth).abs() <= 0.5e-3 + 1e-12);
                let bits = s.dtheta[0] / 1e-3;
                assert!((bits - bits.round()).abs() < 1e-9);
            } else {
                assert_eq!(s.dtheta[0], 0.0);
            }
        }
    }
    // Rates are rounded as rates.
    let lsb = Some(Lsb { size: [0.25; 3], carry: false });
    let mut imu = imu(Channel { lsb, output: Output::Rates, ..Channel::default() });
    assert!((run(&mut imu, 0.01, [0.6])[0].omega()[0] - 0.5).abs() < 1e-15);
}

/// A delay of a sample and a half averages neighbours; the sum of increments lags by the delay.
#[test]
fn a_delay_shifts_the_window() {
    let dt = 0.01;
    let mut delayed = imu(Channel { timing: Timing { delay: 1.5 * dt, jitter: 0.0 }, ..Channel::default() });
    let inputs: Vec<f64> = (0..50).map(|k| (0.3 * f64::from(k)).sin()).collect();
    let samples = run(&mut delayed, dt, inputs.iter().copied());
    for k in 2..50 {
        let expected = 0.5 * (inputs[k - 1] + inputs[k - 2]);
        assert!((samples[k].omega()[0] - expected).abs() < 1e-13, "{k}");
        assert_eq!(samples[k].dv, [dt, 2.0 * dt, 3.0 * dt]);
    }
}

/// Under a constant rate jitter of the window shows as noise of the increments, of twice the variance
/// of the delay times the rate, and their sum stays bounded.
#[test]
fn jitter_is_noise_of_increments_but_not_of_the_sum() {
    let (dt, jitter, n) = (0.01, 1e-4, 20_000);
    let mut imu = imu(Channel { timing: Timing { delay: 0.002, jitter }, ..Channel::default() });
    let samples = run(&mut imu, dt, vec![2.0; n]);
    let deviations: Vec<f64> = samples[1..].iter().map(|s| s.dtheta[0] - 2.0 * dt).collect();
    let variance = deviations.iter().map(|d| d * d).sum::<f64>() / deviations.len() as f64;
    let expected = 2.0 * (2.0 * jitter) * (2.0 * jitter);
    // Squares of neighbouring differences are correlated by 1/4: 4 sigma of the estimate.
    assert!((variance / expected - 1.0).abs() < 4.0 * (2.0 / n as f64 * 1.5).sqrt(), "{variance:e}");
    assert!(deviations.iter().sum::<f64>().abs() < 10.0 * 2.0 * jitter);
}

#[test]
fn faults_come_as_often_as_stated() {
    let faults = Faults { drop: 0.02, repeat: 0.03, stick: 0.001, stuck_samples: 5 };
    let mut imu = imu(Channel { faults, ..Channel::default() });
    let n = 100_000;
    let samples = run(&mut imu, 0.01, (0..n).map(f64::from));
    let count = |of: &dyn Fn(&Sample) -> bool| samples.iter().filter(|s| of(s)).count() as f64;
    let free = 1.0 - count(&|s| s.gyro.stuck) / f64::from(n);
    for (found, p) in [(count(&|s| s.gyro.dropped), 0.02), (count(&|s| s.gyro.repeated), 0.03)] {
        let expected = f64::from(n) * p * free;
        assert!((found - expected).abs() < 4.0 * expected.sqrt(), "{found} {expected}");
    }
    let expected = f64::from(n) * 0.001 * 5.0;
    assert!((count(&|s| s.gyro.stuck) - expected).abs() < 4.0 * 5.0 * (expected / 5.0).sqrt());
    for w in samples.windows(2) {
        if w[1].gyro.repeated && !w[0].gyro.dropped {
            assert_eq!(w[0].dtheta, w[1].dtheta);
        }
        if w[1].gyro.dropped {
            assert_eq!(w[1].dtheta, [0.0; 3]);
        }
        assert_eq!(w[1].accel, Default::default());
    }
}

#[test]
fn nonsense_is_refused() {
    let refused = |gyro: Channel| Readout { gyro, ..Readout::default() }.validate().unwrap_err().to_string();
    let low_pass = Some(Bandwidth { natural_frequency: 0.0, damping: 0.7 });
    assert_eq!(
        refused(Channel { bandwidth: low_pass, ..Channel::default() }),
        "readout: `bandwidth.natural_frequency` is 0, but must be above zero"
    );
    assert_eq!(
        refused(Channel { range: Some([(1.0, -1.0); 3]), ..Channel::default() }),
        "readout: `range` is 1, but must be below the upper end of its axis"
    );
    let faults = Faults { drop: 0.7, repeat: 0.7, ..Faults::default() };
    assert!(refused(Channel { faults, ..Channel::default() }).contains("sum is 1 at most"));
}
