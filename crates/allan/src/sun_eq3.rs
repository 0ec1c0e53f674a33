use nalgebra::{DMatrix, DVector};

use crate::{AllanError, Curve, Term};

/// The fit of Sun, Li, Zhang, Wang, *Numerical Simulation on Inertial Measurement Unit Errors*, equation (3), for
/// comparison: plain least squares of the variance on tau^n, n = -2 .. 2 (the sum is misprinted as n = 2 .. 2).
///
/// It has no weights, no Markov term, no sinusoid and no bound on the signs. A negative coefficient is the
/// square of an imaginary parameter; it is reported as it comes.
#[derive(Debug, Clone, PartialEq)]
pub struct SunEq3 {
    /// C_-2, C_-1, C_0, C_1, C_2: 3 Q², N², 2 B² ln 2/π, K²/3, R²/2.
    pub coefficients: [f64; 5],
    /// Q, N, B, K, R; `None` where the coefficient is negative.
    pub parameters: [Option<f64>; 5],
}

/// Fits equation (3) to all points of a curve.
///
/// # Errors
/// Fewer than five points.
pub fn sun_eq3(curve: &Curve) -> Result<SunEq3, AllanError> {
    let n = curve.points.len();
    if n < 5 {
        return Err(AllanError::TooShort {
            got: n,
            need: 5,
            what: "equation (3), five coefficients (averaging times)",
        });
    }
    let mut a = DMatrix::from_fn(n, 5, |i, p| curve.points[i].tau.powi(p as i32 - 2));
    // Columns of equal length: the powers differ by many decades, which is no part of the method.
    let lengths: Vec<f64> = a.column_iter().map(|c| c.norm()).collect();
    for (mut column, length) in a.column_iter_mut().zip(&lengths) {
        column /= *length;
    }
    let y = DVector::from_iterator(n, curve.points.iter().map(|p| p.variance));
    let x = a.svd(true, true).solve(&y, 1e-14).map_err(|_| AllanError::Fit(n))?;
    let coefficients = std::array::from_fn(|p| x[p] / lengths[p]);
    let parameters = std::array::from_fn(|p| {
        // Allan variance of the term at 1 s is its coefficient for power 1.
        let power = coefficients[p] / Term::POWER_LAWS[p].allan_variance(1.0);
        (power >= 0.0).then(|| power.sqrt())
    });
    Ok(SunEq3 { coefficients, parameters })
}
