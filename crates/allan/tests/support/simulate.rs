//! Exact discrete noise, independent of the library: the increments of an integrated power-law noise follow their
//! covariance exactly (circulant embedding, Davies and Harte 1987), whatever the length.
use std::f64::consts::{PI, TAU};

use realfft::{RealFftPlanner, num_complex::Complex};

/// Seeded normals: SplitMix64 (Steele, Lea, Flood 2014) and Box-Muller.
pub struct Normals {
    state: u64,
    spare: Option<f64>,
}

impl Normals {
    pub fn new(seed: u64) -> Self {
        // The first word of the plain seed, so that neighbouring seeds do not give shifted copies of one stream.
        let state = Self { state: seed, spare: None }.word();
        Self { state, spare: None }
    }

    fn word(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in (0, 1].
    pub fn uniform(&mut self) -> f64 {
        ((self.word() >> 11) + 1) as f64 / (1u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        if let Some(z) = self.spare.take() {
            return z;
        }
        let (r, angle) = ((-2.0 * self.uniform().ln()).sqrt(), TAU * self.uniform());
        self.spare = Some(r * angle.sin());
        r * angle.cos()
    }
}

/// The true noises of a simulated rate sensor; densities two-sided as in IEEE Std 952, SI.
#[derive(Debug, Clone, Copy, Default)]
pub struct Truth {
    pub quantization: f64,
    pub white: f64,
    pub flicker: f64,
    pub random_walk: f64,
    pub ramp: f64,
    /// (standard deviation, correlation time).
    pub markov: Option<(f64, f64)>,
    /// (amplitude, frequency).
    pub sinusoid: Option<(f64, f64)>,
}

/// Makes rates of one length and truth; the spectrum is computed once.
pub struct Simulator {
    truth: Truth,
    n: usize,
    tau0: f64,
    /// Square roots of the eigenvalues of the embedded covariance.
    root: Vec<f64>,
    planner: RealFftPlanner<f64>,
}

impl Simulator {
    /// `n` rate samples, each the mean over `tau0` seconds.
    pub fn new(truth: Truth, n: usize, tau0: f64) -> Self {
        // First differences of the rate are stationary for all of these.
        let half = n.next_power_of_two();
        let gamma: Vec<f64> = (0..=half).map(|k| truth.covariance(k as f64, tau0)).collect();
        let mut circle: Vec<f64> =
            gamma.iter().copied().chain(gamma[1..half].iter().rev().copied()).collect();
        let mut planner = RealFftPlanner::new();
        let forward = planner.plan_fft_forward(circle.len());
        let mut spectrum = forward.make_output_vec();
        forward.process(&mut circle, &mut spectrum).unwrap();
        let top = spectrum.iter().map(|c| c.re).fold(0.0, f64::max);
        assert!(spectrum.iter().all(|c| c.re >= -1e-9 * top), "the covariance does not embed");
        let root = spectrum.iter().map(|c| c.re.max(0.0).sqrt()).collect();
        Self { truth, n, tau0, root, planner }
    }

    /// One run.
    pub fn rate(&mut self, seed: u64) -> Vec<f64> {
        let mut normals = Normals::new(seed);
        let length = 2 * (self.root.len() - 1);
        let last = self.root.len() - 1;
        let mut spectrum: Vec<Complex<f64>> = self
            .root
            .iter()
            .enumerate()
            .map(|(k, r)| {
                if k == 0 || k == last {
                    Complex::new(r * normals.normal(), 0.0)
                } else {
                    Complex::new(normals.normal(), normals.normal()) * (r * 0.5f64.sqrt())
                }
            })
            .collect();
        let inverse = self.planner.plan_fft_inverse(length);
        let mut differences = inverse.make_output_vec();
        inverse.process(&mut spectrum, &mut differences).unwrap();
        let scale = 1.0 / (length as f64).sqrt();
        let phase = TAU * normals.uniform();
        let mut level = 0.0;
        (0..self.n)
            .map(|k| {
                level += differences[k] * scale;
                let t = (k as f64 + 0.5) * self.tau0;
                let mut rate = level + self.truth.ramp * t;
                if let Some((amplitude, f0)) = self.truth.sinusoid {
                    let x = PI * f0 * self.tau0;
                    rate += amplitude * (x.sin() / x) * (TAU * f0 * t + phase).sin();
                }
                rate
            })
            .collect()
    }
}

impl Truth {
    /// Covariance of the first differences of the rate at lag k: fourth difference of the generalised
    /// autocovariance of phase, over tau0². Term by term, because at long lags they cancel.
    fn covariance(&self, k: f64, tau0: f64) -> f64 {
        let fourth = |g: &dyn Fn(f64) -> f64| {
            let at = |j: f64| g((k + j).abs());
            6.0 * at(0.0) - 4.0 * (at(1.0) + at(-1.0)) + at(2.0) + at(-2.0)
        };
        let near = |g: &dyn Fn(f64) -> f64| if k > 2.0 { 0.0 } else { fourth(g) };
        let mut sum = self.quantization.powi(2) / tau0.powi(2) * near(&|t| f64::from(t == 0.0));
        sum -= self.white.powi(2) / (2.0 * tau0) * near(&|t| t);
        sum += self.random_walk.powi(2) * tau0 / 12.0 * near(&|t| t.powi(3));
        let square_log = |t: f64| if t > 0.0 { t * t * t.ln() } else { 0.0 };
        sum += self.flicker.powi(2) / TAU
            * if k > 100.0 {
                // d4 = D4 + D6/6 + D8/80 of t² ln t.
                -2.0 / k.powi(2) - 2.0 / k.powi(4) - 3.0 / k.powi(6)
            } else {
                fourth(&square_log)
            };
        if let Some((sigma, time)) = self.markov {
            let x = tau0 / time;
            // The linear part of the phase covariance has no fourth difference beyond lag 1.
            let linear = near(&|t| t * x);
            let tail = if k > 2.0 {
                (-x * k).exp() * (2.0 * x.cosh() - 2.0).powi(2)
            } else {
                fourth(&|t| (-x * t).exp_m1())
            };
            sum -= (sigma / x).powi(2) * (linear + tail);
        }
        sum
    }
}
