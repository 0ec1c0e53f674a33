//! Attitude at rest from two averaged vectors.

use schuler_frames::earth::omega_ie_t;
use schuler_frames::{B, Dcm, Geodetic, Gravity, I, Rate, Rot, T, Vec3};

/// Why two vectors give no attitude.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TriadError {
    /// Without specific force there is no level.
    #[error("alignment needs a specific force of about 9.8 m/s², but its norm is {norm} m/s²")]
    NoForce {
        /// Norm of the averaged specific force, m/s².
        norm: f64,
    },
    /// At a pole the Earth rate is vertical: no direction is north.
    #[error("alignment needs a horizontal part of the Earth rate, but at latitude {lat} rad there is none")]
    Pole {
        /// Latitude, rad.
        lat: f64,
    },
    /// The measured angular rate is zero, or along the specific force: it tells nothing about north.
    #[error("alignment needs an angular rate across the specific force, but the sine between them is {sine}")]
    NoHeading {
        /// Sine of the angle between the measured vectors.
        sine: f64,
    },
}

/// Smallest norm of the specific force, m/s²: far below any gravity on the Earth, far above rounding.
const LEAST_FORCE: f64 = 1e-3;

/// Smallest sine between the two vectors; 1e-6 is 6 m from a pole.
const LEAST_SINE: f64 = 1e-6;

/// C_b^t of a vehicle at rest from mean specific force `f_b` (m/s²) and mean angular rate `omega_ib_b` (rad/s) at
/// `position`: TRIAD with the **specific force first**.
///
/// The orthonormal triad f, f × ω, f × (f × ω) of the measured vectors is laid upon that of -g^t and omega_ie^t. So
/// level comes from the accelerometers alone and the gyros give heading only (the other order, Earth rate first, and
/// the inverse of the three vectors without orthonormalising have other errors). The vectors' lengths do not enter,
/// nor, to first order, does the latitude.
///
/// To first order the attitude error (phi: C_computed = exp(-[phi ×]) C_true) of sensor errors nabla (m/s²) and
/// eps (rad/s) resolved in t, at latitude L, is
/// phi_N = nabla_E / g, phi_E = -nabla_N / g, phi_D = eps_E / (Ω cos L) - tan L nabla_E / g;
/// nothing else enters.
///
/// # Errors
/// [`TriadError`] if the vectors are too short or parallel, as they are at a pole.
///
/// ```
/// use schuler_frames::{B, Euler, Geodetic, Gravity, Rate, Rot, T, earth, phi_between};
/// use schuler_strapdown::align::triad;
/// let position = Geodetic::new(0.8, 0.1, 300.0);
/// let truth: Rot<T, B> = Rot::from_euler(Euler::new(0.02, -0.01, 1.5));
/// let f_b = truth.inverse() * -Gravity::Somigliana.gravity_t(position);
/// let omega_b = truth.inverse() * earth::omega_ie_t(0.8_f64.sin(), 0.8_f64.cos()).as_vec3();
/// let found = triad(f_b, Rate::claim(omega_b), position, Gravity::Somigliana).unwrap();
/// assert!(phi_between(found, truth).norm() < 1e-14);
/// ```
pub fn triad(
    f_b: Vec3<B>,
    omega_ib_b: Rate<B, I, B>,
    position: Geodetic,
    gravity: Gravity,
) -> Result<Rot<T, B>, TriadError> {
    let norm = f_b.norm();
    // Written so that NaN is refused too.
    if !(norm > LEAST_FORCE && norm.is_finite()) {
        return Err(TriadError::NoForce { norm });
    }
    let f_t = -gravity.gravity_t(position);
    let (s, c) = libm::sincos(position.lat);
    let reference =
        axes(f_t, omega_ie_t(s, c).as_vec3()).map_err(|_| TriadError::Pole { lat: position.lat })?;
    let measured = axes(f_b, omega_ib_b.as_vec3()).map_err(|sine| TriadError::NoHeading { sine })?;
    // Rows of `measured` are the axes of the triad in b: it takes b to the triad, and so does `reference` for t.
    let to_triad: Dcm<T, B> = Dcm::claim(measured);
    let c_tb = Dcm::<T, T>::claim(reference).transpose() * to_triad;
    Ok(Rot::from_dcm(c_tb))
}

/// Orthonormal axes along a, a × b and a × (a × b), by rows; the sine between the vectors where it is too small.
fn axes<F: schuler_frames::Frame>(a: Vec3<F>, b: Vec3<F>) -> Result<[[f64; 3]; 3], f64> {
    let first = a * (1.0 / a.norm());
    let across = first.cross(b);
    let (length, whole) = (across.norm(), b.norm());
    let sine = if whole > 0.0 { length / whole } else { 0.0 };
    if sine > LEAST_SINE {
        let second = across * (1.0 / length);
        Ok([first.as_array(), second.as_array(), first.cross(second).as_array()])
    } else {
        Err(sine)
    }
}
