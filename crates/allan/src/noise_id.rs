use crate::{NoiseType, Phase};

/// Fewer averages than this tell nothing about their autocorrelation.
const FEWEST: usize = 30;

/// The dominant noise at averaging factor `m`, from the lag-1 autocorrelation of the rate averaged over `m` samples;
/// `None` where fewer than 30 averages are left.
///
/// For noise with spectrum f^-2δ between -1/2 and 1/4 the lag-1 autocorrelation is r = δ/(1 - δ); averages are
/// differenced until that holds, each difference worth 2 in the exponent (W. Riley, C. Greenhall, *Power law
/// noise identification using the lag 1 autocorrelation*, EFTF 2004).
#[must_use]
pub fn identify(phase: &Phase, m: usize) -> Option<NoiseType> {
    let x: Vec<f64> = phase.samples().iter().step_by(m).copied().collect();
    let mut y: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let mut exponent = 0.0;
    for differences in 0..3 {
        if y.len() < FEWEST {
            return None;
        }
        let r = lag_1(&y);
        let delta = r / (1.0 + r);
        if delta < 0.25 || differences == 2 {
            exponent -= 2.0 * delta;
            break;
        }
        exponent -= 2.0;
        y = y.windows(2).map(|w| w[1] - w[0]).collect();
    }
    Some(match exponent.round() {
        a if a > 0.5 => NoiseType::Quantization,
        a if a > -0.5 => NoiseType::White,
        a if a > -1.5 => NoiseType::Flicker,
        _ => NoiseType::RandomWalk,
    })
}

fn lag_1(y: &[f64]) -> f64 {
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let at_0: f64 = y.iter().map(|v| (v - mean).powi(2)).sum();
    let at_1: f64 = y.windows(2).map(|w| (w[0] - mean) * (w[1] - mean)).sum();
    if at_0 > 0.0 { at_1 / at_0 } else { 0.0 }
}
