//! The attitude error phi of a computed rotation.

use crate::rotation_vector::log;
use crate::{Frame, Rot, Vec3};

/// Attitude error phi (rad) of a computed rotation: C_computed = exp(-[phi ×]) C_true, resolved in
/// `To` (in t for `c_tb`), with an angle in 0..=π.
///
/// Exact for tiny angles: the result has full relative precision with respect to the two quaternions
/// given, whose own rounding is 1e-16 rad.
///
/// ```
/// use schuler_frames::{B, Euler, Rot, T, Vec3, phi_between, with_phi};
/// let truth: Rot<T, B> = Rot::from_euler(Euler::new(0.1, -0.2, 2.0));
/// let phi = Vec3::new(1e-9, -2e-9, 3e-9);
/// assert!((phi_between(with_phi(truth, phi), truth) - phi).norm() < 1e-15);
/// ```
pub fn phi_between<To: Frame, From: Frame>(computed: Rot<To, From>, truth: Rot<To, From>) -> Vec3<To> {
    let (q, [w, x, y, z]) = (computed.as_quaternion(), truth.as_quaternion());
    // q and -q are the same rotation; take the sign nearer to the truth.
    let sign = if q[0] * w + q[1] * x + q[2] * y + q[3] * z < 0.0 { -1.0 } else { 1.0 };
    // With q = truth + d, the error q truth⁻¹ = 1 + d truth⁻¹. For near rotations d is an exact
    // difference, where the vector part of q truth⁻¹ itself would cancel to 1e-16 absolute.
    let [dw, dx, dy, dz] = [sign * q[0] - w, sign * q[1] - x, sign * q[2] - y, sign * q[3] - z];
    let scalar = 1.0 + (dw * w + dx * x + dy * y + dz * z);
    let vector = Vec3::new(
        dx * w - dw * x - dy * z + dz * y,
        dy * w - dw * y - dz * x + dx * z,
        dz * w - dw * z - dx * y + dy * x,
    );
    -log(scalar, vector)
}

/// The computed rotation that has the attitude error `phi` (rad, any size): exp(-[phi ×]) C_true.
/// Inverse of [`phi_between`].
pub fn with_phi<To: Frame, From: Frame>(truth: Rot<To, From>, phi: Vec3<To>) -> Rot<To, From> {
    Rot::<To, To>::from_rotation_vector(-phi) * truth
}
