use crate::{NoiseType, Phase};

/// Fewer averages than this tell nothing about their autocorrelation.
const FEWEST: usize = 30;

/// The dominant noise at averaging factor `m`, from the lag-1 autocorrelation of the rate averaged over `m` samples;
/// `None` where fewer than 30 averages are left.
///
/// The idea is that of W. Riley and C. Greenhall, *Power law noise identification using the lag 1 autocorrelation*,
/// EFTF 2004, with the exact values for interval means in place of point samples. Differences of adjacent averages
/// have the autocorrelation -2/3 (quantization), -1/2 (white), -0.217 (flicker: (9 ln 3 - 16 ln 2)/(8 ln 2)) and
/// 1/4 (random walk); averages themselves -1/2 and 0 for the first two. The nearest value decides.
#[must_use]
pub fn identify(phase: &Phase, m: usize) -> Option<NoiseType> {
    let x: Vec<f64> = phase.samples().iter().step_by(m).copied().collect();
    let averages: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    if averages.len() < FEWEST {
        return None;
    }
    let differences: Vec<f64> = averages.windows(2).map(|w| w[1] - w[0]).collect();
    let r = lag_1(&differences);
    Some(if r > 0.0165 {
        NoiseType::RandomWalk
    } else if r > -0.3585 {
        NoiseType::Flicker
    } else if lag_1(&averages) > -0.25 {
        NoiseType::White
    } else {
        NoiseType::Quantization
    })
}

fn lag_1(y: &[f64]) -> f64 {
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let at_0: f64 = y.iter().map(|v| (v - mean).powi(2)).sum();
    let at_1: f64 = y.windows(2).map(|w| (w[0] - mean) * (w[1] - mean)).sum();
    if at_0 > 0.0 { at_1 / at_0 } else { 0.0 }
}
