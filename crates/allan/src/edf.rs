use crate::Estimator;

/// Power laws of noise, as they appear in the rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoiseType {
    /// White noise of the integrated quantity: quantization (Q). Spectrum of the rate ~ f².
    Quantization,
    /// White rate noise: angle or velocity random walk (N). Spectrum flat.
    White,
    /// Flicker of the rate: bias instability (B). Spectrum ~ 1/f.
    Flicker,
    /// Random walk of the rate (K). Spectrum ~ 1/f².
    RandomWalk,
}

impl NoiseType {
    /// Exponent alpha of the rate spectrum S(f) ~ f^alpha.
    #[must_use]
    pub fn alpha(self) -> i32 {
        match self {
            NoiseType::Quantization => 2,
            NoiseType::White => 0,
            NoiseType::Flicker => -1,
            NoiseType::RandomWalk => -2,
        }
    }
}

/// Lags per averaging time in the sums below; a finer overlap changes the result by less than 0.1 %.
const OVERLAP: usize = 64;

/// Equivalent degrees of freedom of a variance estimated at factor `m` from `n_phase` phase samples, were the
/// noise of type `noise` throughout.
///
/// edf = 2 E² / Var of the estimate, from the autocovariance s(t) of the differences: with M of them,
/// `M / edf = 1 + 2 sum over j of (1 - j/M) (s(j)/s(0))²`. s follows from the generalised autocovariance of phase
/// (|t|, t² ln|t|, |t|³ for white, flicker, random walk of the rate), as in Greenhall and Riley, *Uncertainty of
/// stability variances based on finite differences*, PTTI 2003. Phase is taken as the exact integral of the rate,
/// which is what an inertial sensor gives. The total variance follows NIST SP 1065, table 9: b T/tau - c.
#[must_use]
pub fn edf(estimator: Estimator, noise: NoiseType, m: usize, n_phase: usize) -> f64 {
    let d = estimator.order();
    match estimator {
        Estimator::Total => total(noise, m, n_phase),
        Estimator::NonOverlapping | Estimator::HadamardNonOverlapping => {
            sum(noise, d, false, 1, (n_phase - 1) / m + 1 - d)
        }
        Estimator::Modified if m > 1 => sum(noise, d, true, m, (n_phase + 1).saturating_sub(3 * m)),
        _ => sum(noise, d, false, m, n_phase.saturating_sub(d * m)),
    }
}

/// Degrees of freedom of the estimates of [`crate::Pyramid`], whose differences start every m/8 samples.
#[must_use]
pub fn pyramid_edf(noise: NoiseType, m: usize, n_phase: usize) -> f64 {
    let stride = m.min(crate::pyramid::STRIDE);
    sum(noise, 2, false, stride, n_phase.saturating_sub(2 * m) * stride / m)
}

fn total(noise: NoiseType, m: usize, n_phase: usize) -> f64 {
    let ratio = (n_phase - 1) as f64 / m as f64;
    let (b, c) = match noise {
        NoiseType::White if m >= 8 => (1.50, 0.0),
        NoiseType::Flicker if m >= 8 => (1.17, 0.22),
        NoiseType::RandomWalk if m >= 8 => (0.93, 0.36),
        // At short times reflection adds nothing, and the law above would exceed the number of differences.
        _ => return edf(Estimator::Overlapping, noise, m.min((n_phase - 1) / 2), n_phase),
    };
    (b * ratio - c).max(1.0)
}

/// `stride` differences start in each averaging time; there are `count` of them.
fn sum(noise: NoiseType, d: usize, modified: bool, stride: usize, count: usize) -> f64 {
    let count = count.max(1) as f64;
    if noise == NoiseType::Quantization && !modified {
        // Phase itself is white: differences correlate only at whole averaging times.
        let weights = [binomials(d).as_slice(), &[0.0; 4]].concat();
        let s =
            |lag: usize| -> f64 { (0..4).map(|i| weights[i] * weights.get(i + lag).unwrap_or(&0.0)).sum() };
        let spread: f64 =
            (1..=d).map(|i| 2.0 * (1.0 - (i * stride) as f64 / count).max(0.0) * (s(i) / s(0)).powi(2)).sum();
        return count / (1.0 + spread);
    }
    // A coarser overlap with the same length in averaging times.
    let coarse = stride.min(OVERLAP);
    let count = count * coarse as f64 / stride as f64;
    let s0 = covariance(noise, d, modified, 0.0);
    let longest = ((d + 3) * coarse).min(count.floor() as usize);
    let spread: f64 = (1..=longest)
        .map(|j| {
            let s = covariance(noise, d, modified, j as f64 / coarse as f64) / s0;
            2.0 * (1.0 - j as f64 / count).max(0.0) * s * s
        })
        .sum();
    (count / (1.0 + spread)).max(1.0)
}

fn binomials(d: usize) -> [f64; 4] {
    if d == 2 { [1.0, -2.0, 1.0, 0.0] } else { [1.0, -3.0, 3.0, -1.0] }
}

/// Covariance of differences of order `d` at lag `t` in averaging times, up to a factor.
fn covariance(noise: NoiseType, d: usize, modified: bool, t: f64) -> f64 {
    let phase = |t: f64| {
        if modified {
            let g = |t: f64| generalised(noise.alpha(), t);
            2.0 * g(t) - g(t - 1.0) - g(t + 1.0)
        } else {
            generalised(noise.alpha() + 2, t)
        }
    };
    let w = binomials(d);
    let mut sum = 0.0;
    for (i, a) in w.iter().enumerate() {
        for (j, b) in w.iter().enumerate() {
            sum += a * b * phase(t + i as f64 - j as f64);
        }
    }
    sum
}

/// Generalised autocovariance of noise with spectrum ~ f^(alpha - 2), up to a factor; signs alternate so that the
/// differences have positive variance.
fn generalised(alpha: i32, t: f64) -> f64 {
    let t = t.abs();
    let log = if t > 0.0 { t.ln() } else { 0.0 };
    match alpha {
        2 => -t,
        1 => t * t * log,
        0 => t.powi(3),
        -1 => -t.powi(4) * log,
        _ => -t.powi(5),
    }
}
