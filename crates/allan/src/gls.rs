use nalgebra::{Cholesky, DMatrix, DVector};

/// Generalised least squares of y = A theta + e, Cov e = V.
pub(crate) struct Solution {
    pub theta: DVector<f64>,
    /// Covariance of theta, (A' V^-1 A)^-1.
    pub covariance: DMatrix<f64>,
    /// r' V^-1 r.
    pub chi2: f64,
    /// ln det V.
    pub log_det: f64,
}

/// `None` where V or the normal matrix is not positive definite.
pub(crate) fn solve(a: &DMatrix<f64>, y: &DVector<f64>, v: DMatrix<f64>) -> Option<Solution> {
    let factor = Cholesky::new(v)?;
    let l = factor.l_dirty();
    let (mut wa, mut wy) = (a.clone(), y.clone());
    if !(l.solve_lower_triangular_mut(&mut wa) && l.solve_lower_triangular_mut(&mut wy)) {
        return None;
    }
    let covariance = Cholesky::new(wa.tr_mul(&wa))?.inverse();
    let theta = &covariance * wa.tr_mul(&wy);
    let chi2 = (&wy - &wa * &theta).norm_squared();
    let log_det = 2.0 * (0..y.len()).map(|i| l[(i, i)].ln()).sum::<f64>();
    Some(Solution { theta, covariance, chi2, log_det })
}
