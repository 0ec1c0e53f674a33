use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::AllanError;

/// Factors on a variance estimate that bound the true variance with probability `confidence`, both tails equal:
/// edf s² / chi²(1 - a/2) .. edf s² / chi²(a/2), a = 1 - `confidence`.
///
/// # Errors
/// A confidence outside (0, 1); degrees of freedom that are not positive.
pub fn variance_factors(edf: f64, confidence: f64) -> Result<(f64, f64), AllanError> {
    if !(confidence > 0.0 && confidence < 1.0) {
        return Err(AllanError::Confidence(confidence));
    }
    let tail = (1.0 - confidence) / 2.0;
    Ok((edf / quantile(edf, 1.0 - tail)?, edf / quantile(edf, tail)?))
}

/// Quantile of chi-square with any positive number of degrees of freedom.
///
/// # Errors
/// Degrees of freedom that are not positive.
pub fn quantile(edf: f64, p: f64) -> Result<f64, AllanError> {
    let law = ChiSquared::new(edf).map_err(|_| AllanError::DegreesOfFreedom(edf))?;
    // By bisection on the logarithm: `inverse_cdf` of statrs 0.18 gives NaN in the left tail of one degree of freedom.
    let (mut low, mut high) = (-200.0, (edf + 40.0 * edf.sqrt() + 1e3).ln());
    for _ in 0..64 {
        let middle: f64 = 0.5 * (low + high);
        if law.cdf(middle.exp()) < p { low = middle } else { high = middle }
    }
    Ok(high.exp())
}
