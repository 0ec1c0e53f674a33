//! Laws of every pair of term and process, generated from the registries: what the injector puts out
//! has the mean, the variance and the Allan variance that term and process promise, at several step
//! lengths, from t = 0 on.
//!
//! The law is agreement within 4 sigma of the estimate. There are 69 536 comparisons, and of so many a
//! correct program has about four beyond 4 sigma (6.3 in 100 000, both sides): that none were there would be
//! as wrong as twenty. So the bound of 4 sigma is kept by their number, which may exceed what is expected by
//! 4 sigma of its own, and none alone may lie beyond 5.5 sigma, where a correct program fails with one seed
//! in 400 (3.8 in 100 million each).

use schuler_imu::process::Step;
use schuler_imu::{Evolution, Imu, Input, Instrument, Process, Source, Spec, Stream, TERMS, Term, Truth};

use super::examples::processes;
use super::process_laws::{Moments, after, difference, start};

const RUNS: u64 = 192;
/// Step lengths, s.
const STEPS: [f64; 3] = [0.02, 0.3, 4.0];
/// Averaging times in steps.
const AVERAGES: [usize; 10] = [1, 2, 3, 5, 8, 13, 21, 34, 55, 89];

/// A motion that excites every term.
fn truth() -> Truth {
    Truth::rates([0.7, -1.3, 0.9], [2.0, -1.1, 0.6])
        .with_omega_dot([0.8, 0.5, -1.2])
        .with_temperature(295.15, 0.7)
        .with_vibration([0.5, 1.0, 2.0])
}

/// A zero-mean estimate of a variance from `n` squares, as a standard normal (Wilson and Hilferty).
fn chi_square_as_normal(sum_of_squares: f64, variance: f64, n: f64) -> f64 {
    let k = 2.0 / (9.0 * n);
    ((sum_of_squares / (variance * n)).cbrt() - (1.0 - k)) / k.sqrt()
}

/// Mean and variance of the coefficient's interval mean after `n` others.
fn interval_mean(e: &Evolution, dt: f64, n: usize) -> (f64, f64) {
    let (mut mean, mut variance) = (0.0, 0.0);
    for part in 0..e.kind.parts(&e.arguments) {
        let s: Step = e.kind.step(&e.arguments, part, dt);
        let mut m = start(e, part);
        for _ in 0..n {
            let (x, p) = after(&s, &m);
            m = Moments { mean: [x[0], x[1]], cov: [0, 1].map(|i| [p[i][0], p[i][1]]) };
        }
        let (x, p) = after(&s, &m);
        mean += x[2];
        variance += p[2][2];
    }
    (mean, variance)
}

/// What is compared: a sum of squares of deviations against a variance.
#[derive(Default)]
struct Check {
    name: String,
    worst: f64,
    count: usize,
    beyond_4: usize,
}

impl Check {
    fn normal(&mut self, z: f64, what: &str) {
        self.count += 1;
        self.worst = self.worst.max(z.abs());
        self.beyond_4 += usize::from(z.abs() > 4.0);
        assert!(z.abs() < 5.5, "{} {what}: {z:.2} sigma", self.name);
    }

    /// Sum over runs `sum` and sum of squares `squares` of values of known mean and variance.
    fn moments(&mut self, sum: f64, squares: f64, mean: f64, variance: f64, what: &str) {
        let n = RUNS as f64;
        let centred = squares - 2.0 * mean * sum + n * mean * mean;
        if variance <= 1e-20 * (1.0 + mean * mean) {
            // Nothing random: every run alike, within rounding.
            let scale = 1e-9 * n * (1.0 + mean * mean);
            assert!((sum - n * mean).abs() < scale && centred.abs() < scale, "{} {what}", self.name);
            return;
        }
        self.normal((sum - n * mean) / (n * variance).sqrt(), what);
        // The sinusoid of random phase is not normal; its squares scatter less, so the bound holds.
        self.normal(chi_square_as_normal(centred, variance, n), what);
    }
}

/// Runs the pair and compares.
fn pair(instrument: Instrument, term: &'static dyn Term, name: &str, process: Process) -> Check {
    let source = Source::new(instrument, term, process).unwrap();
    let spec = Spec::from_sources([source]).unwrap();
    let e = source.components().next().unwrap().evolution();
    let truth = truth();
    let input = Input::new(instrument, &truth, 1.0, Truth::TEMPERATURE);
    let regressor = term.regressor(&input);
    // The coefficients are independent and of the same law: means add up, variances in squares.
    let gain = [0, 1, 2].map(|i| regressor.columns().iter().map(|g| g[i]).sum::<f64>());
    let power = [0, 1, 2].map(|i| regressor.columns().iter().map(|g| g[i] * g[i]).sum::<f64>());
    let mut check = Check { name: format!("{instrument} {} {name}", term.name()), ..Check::default() };
    let last = 2 * AVERAGES[AVERAGES.len() - 1];
    let mut imu = Imu::new(&spec, Stream::default()).unwrap();
    for (seed, dt) in STEPS.iter().enumerate() {
        let mut first = [[0.0; 2]; 3];
        let mut late = [[0.0; 2]; 3];
        let mut allan = [[[0.0; 2]; 3]; AVERAGES.len()];
        for run in 0..RUNS {
            imu.restart(Stream { seed: seed as u64 + 1, run });
            // Integral of the error, by which every average is one difference.
            let mut integral = vec![[0.0; 3]];
            for k in 0..last {
                let sample = imu.step(*dt, &truth);
                let error = match instrument {
                    Instrument::Gyro => sample.omega_error,
                    Instrument::Accel => sample.f_error,
                };
                let sum = integral[k];
                integral.push([0, 1, 2].map(|i| sum[i] + error[i]));
                for i in 0..3 {
                    let values = [error[i], error[i] * error[i]];
                    for (of, at) in [(&mut first, 0), (&mut late, last - 1)] {
                        if k == at {
                            (0..2).for_each(|v| of[i][v] += values[v]);
                        }
                    }
                }
            }
            for (sums, m) in allan.iter_mut().zip(AVERAGES) {
                for i in 0..3 {
                    let [a, b, c] = [0, m, 2 * m].map(|k| integral[k][i]);
                    let d = (c - 2.0 * b + a) / m as f64;
                    sums[i][0] += d;
                    sums[i][1] += d * d;
                }
            }
        }
        for i in 0..3 {
            for (sums, n) in [(first, 0), (late, last - 1)] {
                let (mean, variance) = interval_mean(&e, *dt, n);
                check.moments(
                    sums[i][0],
                    sums[i][1],
                    gain[i] * mean,
                    power[i] * variance,
                    &format!("value {n} of step {dt}"),
                );
            }
            for (sums, m) in allan.iter().zip(AVERAGES) {
                // Refinement changes nothing: m short steps are one long one.
                let (mean, variance) = difference(&e, *dt * m as f64, 0);
                check.moments(
                    sums[i][0],
                    sums[i][1],
                    gain[i] * mean,
                    power[i] * variance,
                    &format!("Allan of {m} steps {dt}"),
                );
            }
        }
    }
    check
}

/// Every term on every instrument that can have it, with `of` of `parts` parts of the processes.
fn all_pairs(of: usize, parts: usize) {
    let (mut count, mut worst, mut beyond_4) = (0, 0.0_f64, 0);
    for (name, process) in processes().skip(of).step_by(parts) {
        for term in TERMS {
            for instrument in term.instruments() {
                let check = pair(*instrument, *term, &name, process);
                count += check.count;
                worst = worst.max(check.worst);
                beyond_4 += check.beyond_4;
            }
        }
    }
    println!("{count} comparisons, the worst at {worst:.2} sigma, {beyond_4} beyond 4 sigma");
    // Neighbouring averages of one run share most of its data, so exceedances come in groups of about
    // three, and the variance of their number is three times that of a Poisson distribution.
    let expected = 6.3e-5 * count as f64;
    let bound = expected + 4.0 * (3.0 * expected).sqrt();
    assert!((beyond_4 as f64) < bound, "{beyond_4} beyond 4 sigma, {expected} expected");
}

#[test]
fn every_pair_of_term_and_process_keeps_its_promise_1() {
    all_pairs(0, 2);
}

#[test]
fn every_pair_of_term_and_process_keeps_its_promise_2() {
    all_pairs(1, 2);
}
