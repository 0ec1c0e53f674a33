//! What theory expects of mean, standard deviation and extremes, for any sources under any motion.
//!
//! An error is e_k = Σ_c g_c,k y_c,k: regressor g times the interval mean y of coefficient c. Known
//! coefficients give the mean μ_k. Random ones give the covariance of y with the sum of all samples, carried
//! on exactly with the state of the process; so the mean of N samples has its exact variance Var(Σe)/N², and
//!
//! E[s²] = (Σ(μ_k² + Var e_k) - N μ̄² - Var(Σe)/N) / (N - 1).
//!
//! Noise that is white from sample to sample (variance V_k) spreads the sum of squares by
//! 2ΣV_k²(N-1)/N + 4ΣV_k(μ_k - μ̄)²; where other processes wander within the run no bound of the standard deviation
//! is given.

use schuler_imu::{
    Component, Evolution, Input, Instrument, Spec, Truth,
    process::{Polynomial, Step},
};

use std::f64::consts::SQRT_2;

use super::normal::{Z99, largest_of};

/// Share of wandering errors in the variance below which they do not matter.
const NEGLIGIBLE: f64 = 1e-9;

/// Expected value, low and high bound of each statistic; NaN where there is none.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// Of the mean.
    pub mean: [f64; 3],
    /// Of the standard deviation.
    pub deviation: [f64; 3],
    /// Of the largest distance from the mean over the standard deviation.
    pub largest: [f64; 3],
}

/// Carries moments of all errors through a run.
pub struct Theory {
    dt: f64,
    calibration: f64,
    k: u64,
    coefficients: Vec<(Component, Kind)>,
    /// Truth of the sample before, and the column of each coefficient under it.
    seen: Option<Truth>,
    columns: Vec<[f64; 3]>,
    axes: [[Axis; 3]; 2],
}

/// How a coefficient enters the sums.
enum Kind {
    /// A known function of time.
    Known(Polynomial),
    /// White from sample to sample: variance of the interval mean.
    White(f64),
    /// Anything else.
    Wandering(Box<Wandering>),
}

/// A process with states: their covariance, and per axis what joins them with the sum.
struct Wandering {
    step: Step,
    /// Expected state.
    x: [f64; 2],
    p: [[f64; 2]; 2],
    sums: [Sum; 3],
}

#[derive(Clone, Copy, Default)]
struct Sum {
    /// Covariance of the states with the sum.
    cross: [f64; 2],
    /// Variance of the sum.
    variance: f64,
    /// Sum of the variances.
    variances: f64,
}

/// Sums of one axis of one instrument: over μ, μ², V, V², Vμ, Vμ², with μ counted from that of the first
/// sample, so that a large constant costs no digits.
#[derive(Clone, Copy, Default)]
struct Axis {
    first: Option<f64>,
    mu: f64,
    mu2: f64,
    white: f64,
    white2: f64,
    white_mu: f64,
    white_mu2: f64,
}

impl Theory {
    /// Before the first sample.
    pub fn new(spec: &Spec, dt: f64) -> Self {
        let coefficients =
            spec.components().flat_map(|c| Kind::parts(&c, dt).map(move |kind| (c, kind))).collect();
        Theory {
            dt,
            calibration: spec.calibration_temperature,
            k: 0,
            coefficients,
            seen: None,
            columns: Vec::new(),
            axes: [[Axis::default(); 3]; 2],
        }
    }

    /// One sample more.
    pub fn add(&mut self, truth: &Truth) {
        if self.seen != Some(*truth) {
            let inputs = Instrument::ALL.map(|i| Input::new(i, truth, self.dt, self.calibration));
            self.seen = Some(*truth);
            self.columns.clear();
            self.columns.extend(self.coefficients.iter().map(|(component, _)| {
                let input = &inputs[component.instrument() as usize];
                component.term().regressor(input).columns()[component.coefficient()]
            }));
        }
        let middle = (self.k as f64 + 0.5) * self.dt;
        let mut mu = [[0.0; 3]; 2];
        let mut white = [[0.0; 3]; 2];
        for ((component, kind), &g) in self.coefficients.iter_mut().zip(&self.columns) {
            let i = component.instrument() as usize;
            match kind {
                // The interval mean of a first-degree polynomial is its value in the middle.
                Kind::Known(polynomial) => (0..3).for_each(|j| mu[i][j] += g[j] * polynomial.at(middle)),
                Kind::White(variance) => (0..3).for_each(|j| white[i][j] += g[j] * g[j] * *variance),
                Kind::Wandering(w) => {
                    carry(&w.step, &mut w.p, &mut w.sums, g);
                    let expected = w.expected();
                    (0..3).for_each(|j| mu[i][j] += g[j] * expected);
                }
            }
        }
        for i in 0..2 {
            for j in 0..3 {
                self.axes[i][j].add(mu[i][j], white[i][j]);
            }
        }
        self.k += 1;
    }

    /// What is expected of an axis (0, 1, 2) of an instrument (0 gyro, 1 accelerometer).
    pub fn expected(&self, instrument: usize, axis: usize) -> Expected {
        let n = self.k as f64;
        let a = &self.axes[instrument][axis];
        let (mut variance, mut variances) = (0.0, 0.0);
        for (component, kind) in &self.coefficients {
            if let Kind::Wandering(w) = kind
                && component.instrument() as usize == instrument
            {
                variance += w.sums[axis].variance;
                variances += w.sums[axis].variances;
            }
        }
        let mean = a.mu / n;
        let mean_sd = (a.white + variance).max(0.0).sqrt() / n;
        let known = (a.mu2 - a.mu * mean).max(0.0);
        let wandering = (variances - variance / n).max(0.0);
        let squares = known + a.white * (1.0 - 1.0 / n) + wandering;
        let deviation = (squares / (n - 1.0)).sqrt();
        let spread = 2.0 * a.white2 * (1.0 - 1.0 / n)
            + 4.0 * (a.white_mu2 - 2.0 * mean * a.white_mu + mean * mean * a.white);
        // Of the root: half the relative spread of the square.
        let half = 0.5 * Z99 * spread.max(0.0).sqrt() / squares;
        let bounded = a.white > 0.0 && wandering <= NEGLIGIBLE * squares;
        // All samples alike: white noise of one size and nothing else.
        let alike = bounded
            && known <= NEGLIGIBLE * squares
            && a.white2 * n <= a.white * a.white * (1.0 + NEGLIGIBLE);
        let none = f64::NAN;
        let mean = mean + a.first.unwrap_or(0.0);
        Expected {
            // Where nothing is random there is nothing to bound.
            mean: match a.white + variances > 0.0 {
                true => [mean, mean - Z99 * mean_sd, mean + Z99 * mean_sd],
                false => [mean, none, none],
            },
            deviation: match bounded {
                true => [deviation, deviation * (1.0 - half), deviation * (1.0 + half)],
                false => [deviation, none, none],
            },
            largest: match alike {
                true => [0.5, 0.005, 0.995].map(|p| largest_of(n, p)),
                false => [none; 3],
            },
        }
    }
}

impl Axis {
    fn add(&mut self, mu: f64, white: f64) {
        let mu = mu - *self.first.get_or_insert(mu);
        self.mu += mu;
        self.mu2 += mu * mu;
        self.white += white;
        self.white2 += white * white;
        self.white_mu += white * mu;
        self.white_mu2 += white * mu * mu;
    }
}

impl Kind {
    /// The independent parts of a coefficient.
    fn parts(component: &Component, dt: f64) -> impl Iterator<Item = Kind> + use<> {
        let evolution = component.evolution();
        let known = evolution.deterministic();
        let parts = if known.is_some() { 1 } else { evolution.kind.parts(&evolution.arguments) };
        (0..parts).map(move |part| known.map_or_else(|| Kind::part(&evolution, part, dt), Kind::Known))
    }

    fn part(evolution: &Evolution, part: usize, dt: f64) -> Self {
        let mut step = evolution.kind.step(&evolution.arguments, part, dt);
        step.mean = step.mean.map(|m| m * evolution.gain);
        step.noise[2] = step.noise[2].map(|m| m * evolution.gain);
        if step.mean == [0.0; 2] {
            return Kind::White(step.noise[2].iter().map(|n| n * n).sum());
        }
        // Four points have the moments of two normals up to the third degree: exact for a start that is known,
        // linear in them, or of random direction.
        let starts = [[SQRT_2, 0.0], [-SQRT_2, 0.0], [0.0, SQRT_2], [0.0, -SQRT_2]]
            .map(|normals| evolution.kind.initial(&evolution.arguments, part, normals));
        let x = [0, 1].map(|r| starts.iter().map(|s| s[r]).sum::<f64>() / 4.0);
        let moment =
            |r: usize, c: usize| starts.iter().map(|s| (s[r] - x[r]) * (s[c] - x[c])).sum::<f64>() / 4.0;
        let p = [0, 1].map(|r| [0, 1].map(|c| moment(r, c)));
        Kind::Wandering(Box::new(Wandering { step, x, p, sums: [Sum::default(); 3] }))
    }
}

impl Wandering {
    /// Expected interval mean; the expected state goes on to the next.
    fn expected(&mut self) -> f64 {
        let Step { phi, mean, .. } = &self.step;
        let [x1, x2] = self.x;
        self.x = [0, 1].map(|r| phi[r][0] * x1 + phi[r][1] * x2);
        mean[0] * x1 + mean[1] * x2
    }
}

/// Carries state covariance and sums over one step.
fn carry(step: &Step, p: &mut [[f64; 2]; 2], sums: &mut [Sum; 3], g: [f64; 3]) {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let through = |v: [f64; 2]| [0, 1].map(|r| step.phi[r][0] * v[0] + step.phi[r][1] * v[1]);
    let [m1, m2] = step.mean;
    let pm = [0, 1].map(|r| p[r][0] * m1 + p[r][1] * m2);
    let variance = m1 * pm[0] + m2 * pm[1] + dot(step.noise[2], step.noise[2]);
    let moved = through(pm);
    let with_mean = [0, 1].map(|r| moved[r] + dot(step.noise[r], step.noise[2]));
    for (sum, g) in sums.iter_mut().zip(g) {
        sum.variance += 2.0 * g * (m1 * sum.cross[0] + m2 * sum.cross[1]) + g * g * variance;
        sum.variances += g * g * variance;
        let moved = through(sum.cross);
        sum.cross = [0, 1].map(|r| moved[r] + g * with_mean[r]);
    }
    // Phi P Phi' + Q.
    let columns = [0, 1].map(|c| through([p[0][c], p[1][c]]));
    let rows = [0, 1].map(|r| through([columns[0][r], columns[1][r]]));
    *p = [0, 1].map(|r| [0, 1].map(|c| rows[r][c] + dot(step.noise[r], step.noise[c])));
}

#[cfg(test)]
mod tests {
    use schuler_imu::{Instrument::Gyro, Source};

    use super::*;

    fn expected(sources: &[(&str, &[(&str, schuler_imu::Value)])], n: u64, dt: f64) -> Expected {
        let sources = sources
            .iter()
            .map(|(process, given)| Source::named(Gyro, "bias", process, given).expect("valid"));
        let mut theory = Theory::new(&Spec::from_sources(sources).expect("few"), dt);
        (0..n).for_each(|_| theory.add(&Truth::rates([0.0; 3], [0.0; 3])));
        theory.expected(0, 1)
    }

    #[track_caller]
    fn near(found: f64, value: f64) {
        assert!((found / value - 1.0).abs() < 1e-12, "{found} is not {value}");
    }

    /// White noise of density N has the deviation N/sqrt(dt) a sample; bounds of the textbook.
    #[test]
    fn white_noise_and_a_bias() {
        let e = expected(
            &[("constant", &[("value", 0.02.into())]), ("white", &[("density", 3e-5.into())])],
            10_000,
            0.01,
        );
        near(e.mean[0], 0.02);
        near(e.mean[2] - e.mean[0], Z99 * 3e-4 / 100.0);
        near(e.deviation[0], 3e-4);
        near(e.deviation[2], 3e-4 * (1.0 + Z99 / 19_998f64.sqrt()));
    }

    /// A random walk K from 0: the mean of a path has the variance K² T/3, its expected variance about its
    /// own mean is K² T (1/2 - 1/3); interval means change both by order dt/T.
    #[test]
    fn a_random_walk() {
        let (n, dt) = (4000u64, 0.01);
        let t = n as f64 * dt;
        let e = expected(&[("random_walk", &[("density", 1e-3.into())])], n, dt);
        assert!(((e.mean[2] / Z99).powi(2) / (1e-6 * t / 3.0) - 1.0).abs() < 1e-9);
        assert!((e.deviation[0].powi(2) / (1e-6 * t / 6.0) - 1.0).abs() < 2.0 / n as f64);
        assert!(e.deviation[1].is_nan());
    }

    /// A stationary Gauss-Markov process of time constant T: the mean over t has the variance
    /// 2 sigma² T²/t² (t/T - 1 + exp(-t/T)).
    #[test]
    fn a_gauss_markov_process() {
        let (n, dt, tau) = (500u64, 0.1, 20.0);
        let u = n as f64 * dt / tau;
        let e = expected(&[("gauss_markov", &[("sigma", 2.0.into()), ("tau", tau.into())])], n, dt);
        near((e.mean[2] / Z99).powi(2), 2.0 * 4.0 / (u * u) * (u - 1.0 + (-u).exp()));
    }

    /// A sinusoid of random phase has the variance A²/2 about nothing, one of known phase A cos(0) = A at once.
    #[test]
    fn a_sinusoid_over_whole_periods() {
        let (n, dt) = (1000u64, 0.01);
        let random = [("amplitude", 3.0.into()), ("frequency", 2.0.into())];
        let e = expected(&[("sinusoid", &random)], n, dt);
        // An interval mean is smaller than the value by sin(x)/x, x = pi f dt.
        let x = std::f64::consts::PI * 2.0 * dt;
        assert!((e.deviation[0] / (3.0 * x.sin() / x / SQRT_2) - 1.0).abs() < 1.0 / n as f64);
        // Whole periods cancel in the mean; what is left is the root of rounding.
        assert!(e.mean[0].abs() < 1e-12 && e.mean[2].abs() < 1e-5);
    }

    /// A turn-on bias moves the mean and not the deviation.
    #[test]
    fn a_turn_on_bias() {
        let e = expected(
            &[("constant", &[("sigma", 0.5.into())]), ("white", &[("density", 1.0.into())])],
            100,
            1.0,
        );
        near((e.mean[2] / Z99).powi(2), 0.25 + 0.01);
        near(e.deviation[0], 1.0);
        assert!(e.deviation[1] > 0.5);
    }
}
