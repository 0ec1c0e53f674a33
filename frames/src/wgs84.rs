//! The WGS 84 ellipsoid: defining and derived constants, radii of curvature.
//!
//! Source: NIMA TR8350.2, third edition, chapter 3: semi-major axis, flattening, GM with the
//! atmosphere and Earth rate define the ellipsoid; normal gravity at the equator and the constant of
//! Somigliana's formula follow from them and are used as printed.

/// Semi-major axis a, m.
pub const A: f64 = 6_378_137.0;
/// Reciprocal of the flattening, 1/f.
pub const INVERSE_F: f64 = 298.257223563;
/// Flattening f = (a - b) / a.
pub const F: f64 = 1.0 / INVERSE_F;
/// Semi-minor axis b = a (1 - f), m.
pub const B: f64 = A * (1.0 - F);
/// Square of the first eccentricity, e² = f (2 - f).
pub const E2: f64 = F * (2.0 - F);
/// Square of the second eccentricity, e'² = e² / (1 - e²).
pub const EP2: f64 = E2 / (1.0 - E2);
/// Geocentric gravitational constant with the atmosphere, m³/s².
pub const GM: f64 = 3.986004418e14;
/// Earth rate, rad/s: the constant that defines the normal field, without polar motion or change of length of day.
pub const OMEGA: f64 = 7.292115e-5;
/// m = OMEGA² a² b / GM, about the centrifugal part of gravity at the equator.
pub const M: f64 = OMEGA * OMEGA * A * A * B / GM;
/// Normal gravity at the equator on the ellipsoid, m/s².
pub const GAMMA_E: f64 = 9.7803253359;
/// k of Somigliana's formula, (b gamma_p) / (a gamma_e) - 1.
pub const K: f64 = 0.00193185265241;

/// w = 1 / sqrt(1 - e² sin² L): the one irrational number from which both radii and gravity follow.
#[inline]
pub fn w(sin_lat: f64) -> f64 {
    1.0 / libm::sqrt(1.0 - E2 * sin_lat * sin_lat)
}

/// Meridian radius of curvature on the ellipsoid, R_M = a (1 - e²) w³, m. Add h for the radius at a height.
///
/// ```
/// // At the equator R_M = b²/a and R_N = a.
/// use schuler_frames::wgs84;
/// assert!((wgs84::r_m(0.0) - wgs84::B * wgs84::B / wgs84::A).abs() < 1e-8);
/// assert_eq!(wgs84::r_n(0.0), wgs84::A);
/// ```
#[inline]
pub fn r_m(sin_lat: f64) -> f64 {
    let w = w(sin_lat);
    A * (1.0 - E2) * w * w * w
}

/// Prime-vertical radius of curvature on the ellipsoid, R_N = a w, m. Add h for the radius at a height.
#[inline]
pub fn r_n(sin_lat: f64) -> f64 {
    A * w(sin_lat)
}
