//! Rotation vectors: the exponential map and its inverse.

use crate::{Frame, Rot, Vec3};

impl<To: Frame, From: Frame> Rot<To, From> {
    /// exp([v ×]): the turn by the angle |v| (rad, any size) about `v`. The components of `v` are the
    /// same in both frames. Accurate to rounding for small and large angles.
    ///
    /// Frame `From` is frame `To` turned by `v` (right-hand rule): for a body that turns at constant rate omega_tb,
    /// C_b^t(0)⁻¹ C_b^t(dt) = exp([omega_tb^b dt ×]).
    pub fn from_rotation_vector(v: Vec3<To>) -> Self {
        let angle = v.norm();
        let (s, c) = libm::sincos(0.5 * angle);
        // sin(x) / x is well-conditioned for every x but zero itself.
        let k = if angle == 0.0 { 0.5 } else { s / angle };
        Self::claim([c, v[0] * k, v[1] * k, v[2] * k])
    }

    /// The rotation vector, with an angle in 0..=π rad, accurate to rounding also for tiny angles. A half
    /// turn has two, `v` and `-v`; one of them is given.
    pub fn as_rotation_vector(self) -> Vec3<To> {
        let [w, x, y, z] = self.as_quaternion();
        log(w, Vec3::new(x, y, z))
    }
}

/// Rotation vector of the quaternion with scalar part `w` and vector part `v`.
pub(crate) fn log<F: Frame>(w: f64, v: Vec3<F>) -> Vec3<F> {
    let (w, v) = if w < 0.0 { (-w, -v) } else { (w, v) };
    let n = v.norm();
    // Below 1e-160 the square of the norm underflows; there the limit is exact.
    v * if n == 0.0 { 2.0 / w } else { 2.0 * libm::atan2(n, w) / n }
}
