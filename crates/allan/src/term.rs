use std::f64::consts::{LN_2, PI, TAU};

/// One noise of a rate sensor, with what its shape needs beyond one coefficient.
///
/// Every term has one coefficient c >= 0 (Q, N, B, K, R of IEEE Std 952; sigma of a Markov process; amplitude of a
/// sinusoid) and enters every second moment with its *power* c². The functions below are for power 1; tau and t in
/// s, f in Hz, spectra two-sided.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Term {
    /// White noise of the integrated quantity, standard deviation Q (rad, m/s).
    Quantization,
    /// White rate noise, density N (rad/√s, m/s/√s): angle or velocity random walk.
    White,
    /// Flicker of the rate, B (rad/s, m/s²): bias instability, spectrum B²/(2π|f|).
    Flicker,
    /// Random walk of the rate, K (rad/s/√s, m/s²/√s).
    RandomWalk,
    /// Linear ramp of the rate, R (rad/s², m/s³).
    Ramp,
    /// First-order Gauss-Markov rate, standard deviation sigma (rad/s, m/s²), correlation time `tau` (s).
    Markov {
        /// Correlation time (s).
        tau: f64,
    },
    /// Sinusoidal rate, amplitude A (rad/s, m/s²), frequency `f0` (Hz).
    Sinusoid {
        /// Frequency (Hz).
        f0: f64,
    },
}

impl Term {
    /// The five terms without a shape of their own, by falling slope.
    pub const POWER_LAWS: [Term; 5] =
        [Term::Quantization, Term::White, Term::Flicker, Term::RandomWalk, Term::Ramp];

    /// Name in tables and figures.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Term::Quantization => "quantization Q",
            Term::White => "random walk N",
            Term::Flicker => "bias instability B",
            Term::RandomWalk => "rate random walk K",
            Term::Ramp => "rate ramp R",
            Term::Markov { .. } => "Markov sigma",
            Term::Sinusoid { .. } => "sinusoid A",
        }
    }

    /// Allan variance at averaging time `tau` (s) for power 1.
    #[must_use]
    pub fn allan_variance(self, tau: f64) -> f64 {
        match self {
            Term::Quantization => 3.0 / (tau * tau),
            Term::White => 1.0 / tau,
            Term::Flicker => 2.0 * LN_2 / PI,
            Term::RandomWalk => tau / 3.0,
            Term::Ramp => tau * tau / 2.0,
            Term::Markov { tau: time } => {
                let x = tau / time;
                if x < 1e-3 {
                    // Series of the expression below, which loses its digits here.
                    return 2.0 * x * (1.0 / 3.0 - x / 4.0);
                }
                let e = (-x).exp();
                2.0 / x * (1.0 - (3.0 - 4.0 * e + e * e) / (2.0 * x))
            }
            Term::Sinusoid { f0 } => {
                let x = PI * f0 * tau;
                (x.sin().powi(2) / x).powi(2)
            }
        }
    }

    /// Two-sided spectrum of the rate at frequency `f` > 0 (Hz) for power 1, the rate averaged over `tau0` (s)
    /// where that matters; `None` for the terms that are not random.
    #[must_use]
    pub fn spectrum(self, f: f64, tau0: f64) -> Option<f64> {
        match self {
            Term::Quantization => Some(4.0 * (PI * f * tau0).sin().powi(2) / tau0),
            Term::White => Some(1.0),
            Term::Flicker => Some(1.0 / (TAU * f)),
            Term::RandomWalk => Some(1.0 / (TAU * f).powi(2)),
            Term::Markov { tau } => Some(2.0 * tau / (1.0 + (TAU * f * tau).powi(2))),
            Term::Ramp | Term::Sinusoid { .. } => None,
        }
    }

    /// Correlation time (s) or frequency (Hz), for the terms that have one.
    #[must_use]
    pub fn shape(self) -> Option<f64> {
        match self {
            Term::Markov { tau } => Some(tau),
            Term::Sinusoid { f0 } => Some(f0),
            _ => None,
        }
    }

    /// The same term with its correlation time or frequency multiplied by `factor`.
    pub(crate) fn scale_shape(self, factor: f64) -> Self {
        match self {
            Term::Markov { tau } => Term::Markov { tau: tau * factor },
            Term::Sinusoid { f0 } => Term::Sinusoid { f0: f0 * factor },
            other => other,
        }
    }

    /// Is the term random, or the same function of time throughout the log?
    pub(crate) fn is_random(self) -> bool {
        !matches!(self, Term::Ramp | Term::Sinusoid { .. })
    }

    /// Generalised autocovariance of the integrated quantity at lag `t` (s) for power 1: what its second
    /// differences have as covariance when differenced twice. Deterministic terms: mean over the log.
    pub(crate) fn phase_covariance(self, t: f64) -> f64 {
        let t = t.abs();
        match self {
            Term::Quantization => f64::from(t == 0.0),
            Term::White => -0.5 * t,
            Term::Flicker => {
                if t > 0.0 {
                    t * t * t.ln() / TAU
                } else {
                    0.0
                }
            }
            Term::RandomWalk => t.powi(3) / 12.0,
            Term::Ramp => t.powi(4) / 24.0,
            Term::Markov { tau } => -tau * tau * (t / tau + (-t / tau).exp_m1()),
            Term::Sinusoid { f0 } => (TAU * f0 * t).cos() / (2.0 * (TAU * f0).powi(2)),
        }
    }
}
