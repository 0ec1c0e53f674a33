//! Attitude at rest from two averaged vectors.

use nalgebra::{Matrix3, Vector3};
use schuler_frames::earth::omega_ie_t;
use schuler_frames::{B, Dcm, Geodetic, Gravity, I, Rate, Rot, T, Vec3};

use super::closest_rotation;

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
    #[error(
        "alignment needs an angular rate across the specific force, but the sine between them is {sine:.2e}"
    )]
    NoHeading {
        /// Sine of the angle between the measured vectors.
        sine: f64,
    },
}

/// Smallest norm of the specific force, m/s²: far below any gravity on the Earth, far above rounding.
const LEAST_FORCE: f64 = 1e-3;

/// Smallest sine between the two vectors; 1e-6 is 6 m from a pole.
const LEAST_SINE: f64 = 1e-6;

/// How mean specific force f and mean angular rate ω become an attitude. The three differ in what sensor errors do.
///
/// To first order, with nabla (m/s²) and eps (rad/s) the sensor errors resolved in t, at latitude L
/// (phi: C_computed = exp(-[phi ×]) C_true; Ω the Earth rate), all have
/// `phi_N = nabla_E / g` and `phi_D = eps_E / (Ω cos L) - tan L nabla_E / g`, and
///
/// | order | phi_E |
/// |---|---|
/// | `ForceFirst` | `-nabla_N / g` |
/// | `RateFirst` | `-(eps_N sin L + eps_D cos L) / Ω` |
/// | `Inverse` | `(-nabla_N / g + tan L nabla_D / g - eps_D / (Ω cos L)) / 2` |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Vectors {
    /// The triad f, f × ω, f × (f × ω): level by the accelerometers alone.
    #[default]
    ForceFirst,
    /// The triad ω, ω × f, ω × (ω × f): the polar axis by the gyros alone. A gyro of 0.01 deg/h then
    /// tilts by arc minutes.
    RateFirst,
    /// The matrix that takes the measured f, ω, f × ω to the true ones, and the rotation nearest to it: it
    /// averages the two. Its lengths enter.
    Inverse,
}

impl Vectors {
    /// C_b^t of a vehicle at rest from mean specific force `f_b` (m/s²) and mean angular rate `omega_ib_b` (rad/s) at
    /// `position`.
    ///
    /// # Errors
    /// [`TriadError`] if the vectors are too short or parallel, as they are at a pole.
    pub fn attitude(
        self,
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
        let (s, c) = libm::sincos(position.lat);
        let (f_t, omega_t) = (-gravity.gravity_t(position), omega_ie_t(s, c).as_vec3());
        let omega_b = omega_ib_b.as_vec3();
        let pole = |_| TriadError::Pole { lat: position.lat };
        let no_heading = |sine| TriadError::NoHeading { sine };
        let (reference, measured) = match self {
            Vectors::RateFirst => {
                (axes(omega_t, f_t).map_err(pole)?, axes(omega_b, f_b).map_err(no_heading)?)
            }
            Vectors::ForceFirst | Vectors::Inverse => {
                (axes(f_t, omega_t).map_err(pole)?, axes(f_b, omega_b).map_err(no_heading)?)
            }
        };
        if self == Vectors::Inverse {
            let columns = |f: [f64; 3], omega: [f64; 3]| {
                let (f, omega) = (Vector3::from(f), Vector3::from(omega));
                Matrix3::from_columns(&[f, omega, f.cross(&omega)])
            };
            let to = columns(f_t.as_array(), omega_t.as_array());
            let from = columns(f_b.as_array(), omega_b.as_array());
            // The sines above are not zero, so that there is an inverse.
            let inverse = from.try_inverse().ok_or(TriadError::NoHeading { sine: 0.0 })?;
            return Ok(closest_rotation(&(to * inverse)).0);
        }
        // Rows of `measured` are the axes of the triad in b: it takes b to the triad, and so does `reference` for t.
        let to_triad: Dcm<T, B> = Dcm::claim(measured);
        Ok(Rot::from_dcm(Dcm::<T, T>::claim(reference).transpose() * to_triad))
    }
}

/// [`Vectors::ForceFirst`]: C_b^t of a vehicle at rest from mean specific force `f_b` (m/s²) and mean angular rate
/// `omega_ib_b` (rad/s) at `position`.
///
/// The orthonormal triad f, f × ω, f × (f × ω) of the measured vectors is laid upon that of -g^t and omega_ie^t. So
/// level comes from the accelerometers alone and the gyros give heading only. The vectors' lengths do not enter,
/// nor, but for the deflection of gravity, does the latitude.
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
    Vectors::ForceFirst.attitude(f_b, omega_ib_b, position, gravity)
}

/// Orthonormal axes along a, a × b and a × (a × b), by rows; the sine between the vectors where it is too small.
pub(super) fn axes<F: schuler_frames::Frame>(a: Vec3<F>, b: Vec3<F>) -> Result<[[f64; 3]; 3], f64> {
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
