//! The rotation nearest to a matrix.

use nalgebra::{Matrix3, Matrix4};
use schuler_frames::{Frame, Rot};

/// The rotation R that makes `tr(Rᵀ M)` largest, and that trace: of all rotations the nearest to `m`.
///
/// With `m = sum w a bᵀ` over pairs of one vector resolved in `To` (a) and in `From` (b) it minimises
/// `sum w |a - R b|²` (Wahba's problem). The quaternion is the eigenvector to the largest eigenvalue of Davenport's matrix
///
/// ```text
/// K = | tr M          zᵀ          |      z = (M32 - M23, M13 - M31, M21 - M12)
///     |  z     M + Mᵀ - tr M  1   |
/// ```
///
/// Source: Markley and Crassidis, Fundamentals of Spacecraft Attitude Determination and Control (2014), section 5.3.1.
pub fn closest_rotation<To: Frame, From: Frame>(m: &Matrix3<f64>) -> (Rot<To, From>, f64) {
    let trace = m.trace();
    let mut k = Matrix4::zeros();
    k[(0, 0)] = trace;
    let z = [m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]];
    for i in 0..3 {
        (k[(0, i + 1)], k[(i + 1, 0)]) = (z[i], z[i]);
        for j in 0..3 {
            k[(i + 1, j + 1)] = m[(i, j)] + m[(j, i)] - if i == j { trace } else { 0.0 };
        }
    }
    // Iterations have no limit, so that what is not a number must not come in.
    let eigen = if k.iter().all(|x| x.is_finite()) { k } else { Matrix4::zeros() }.symmetric_eigen();
    let best = eigen.eigenvalues.imax();
    let q = eigen.eigenvectors.column(best);
    let sign = if q[0] < 0.0 { -1.0 } else { 1.0 };
    (Rot::claim([q[0], q[1], q[2], q[3]].map(|x| x * sign)).normalized(), eigen.eigenvalues[best])
}
