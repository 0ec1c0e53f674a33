//! Between the inertial and the Earth-fixed frame.

use core::f64::consts::TAU;

use crate::{E, I, Rot, Vec3, earth};

/// Earth rotation angle theta (rad, 0 to 2π) at a UT1 Julian date given as a sum of two parts, as in
/// (2451545.0, 0.25): split it at the day and no digit of the time of day is lost (1e-15 rad); in one
/// `f64` a Julian date resolves 40 µs, 3e-9 rad.
///
/// theta = 2π (0.7790572732640 + 1.00273781191135448 (JD - 2451545.0)).
/// Source: IERS Conventions (2010), equation 5.15 (IAU 2000).
///
/// ```
/// // J2000.0, 12 h UT1: 280.4606 deg.
/// let theta = schuler_frames::earth_rotation_angle(2451545.0, 0.0);
/// assert!((theta.to_degrees() - 280.4606184).abs() < 1e-7);
/// ```
pub fn earth_rotation_angle(jd: f64, jd_rest: f64) -> f64 {
    // Whole days turn the Earth by whole turns plus the small excess: only fractions are multiplied out.
    let days = (jd - 2_451_545.0) + jd_rest;
    let turns = jd % 1.0 + jd_rest % 1.0 + 0.7790572732640 + 0.00273781191135448 * days;
    TAU * (turns - libm::floor(turns))
}

/// C_e^i, Earth-fixed to inertial, at the Earth rotation angle `theta` (rad): a turn about the common z axis.
///
/// Within a run the angle must grow with the rate of the mechanization, theta(t) = theta(0) +
/// [`wgs84::OMEGA`](crate::wgs84::OMEGA) t: [`earth_rotation_angle`] serves for theta(0) only. Its own rate is
/// larger by 1.5e-12 rad/s, which is 0.8 m a day at the equator.
pub fn c_ie(theta: f64) -> Rot<I, E> {
    let (s, c) = libm::sincos(0.5 * theta);
    Rot::claim([c, 0.0, 0.0, s])
}

/// Velocity relative to i, in i axes (m/s), of a point at `r_e` (m) with the velocity `v_e` relative to the
/// Earth, in e axes (m/s): v_i = C_e^i (v_e + omega_ie × r_e).
pub fn velocity_i(c_ie: Rot<I, E>, r_e: Vec3<E>, v_e: Vec3<E>) -> Vec3<I> {
    c_ie * (v_e + earth::OMEGA_IE_E.as_vec3().cross(r_e))
}

/// Velocity relative to the Earth, in e axes (m/s), of a point at `r_i` (m) with the velocity `v_i` relative
/// to i, in i axes (m/s): the inverse of [`velocity_i`].
pub fn velocity_e(c_ie: Rot<I, E>, r_i: Vec3<I>, v_i: Vec3<I>) -> Vec3<E> {
    c_ie.inverse() * (v_i - earth::OMEGA_IE_I.as_vec3().cross(r_i))
}
