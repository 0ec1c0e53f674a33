//! Rates that the Earth imposes: its own, and that of the local level frame carried over it.

use crate::{E, Geodetic, I, Rate, Real, T, Vec3, wgs84};

/// Earth rate omega_ie^e, rad/s.
pub const OMEGA_IE_E: Rate<E, I, E> = Rate::claim(Vec3::new(0.0, 0.0, wgs84::OMEGA));

/// Earth rate omega_ie^i, rad/s: e turns about the axis that it shares with i.
pub const OMEGA_IE_I: Rate<E, I, I> = Rate::claim(Vec3::new(0.0, 0.0, wgs84::OMEGA));

/// Earth rate omega_ie^t = OMEGA (cos L, 0, -sin L), rad/s, from sine and cosine of the latitude.
#[inline(always)]
pub fn omega_ie_t<S: Real>(sin_lat: S, cos_lat: S) -> Rate<E, I, T, S> {
    Rate::claim(Vec3::new(cos_lat * wgs84::OMEGA, sin_lat.lift(0.0), -(sin_lat * wgs84::OMEGA)))
}

/// Transport rate omega_et^t, rad/s: how the local level frame turns over the Earth at velocity
/// `v_t` (m/s, relative to the Earth, north-east-down):
/// (v_E / (R_N + h), -v_N / (R_M + h), -v_E tan L / (R_N + h)).
///
/// The third component grows without bound towards the poles, where north has no meaning.
#[inline]
pub fn omega_et_t(v_t: Vec3<T>, position: Geodetic) -> Rate<T, E, T> {
    let (s, c) = libm::sincos(position.lat);
    let per_r_m = 1.0 / (wgs84::r_m(s) + position.h);
    let per_r_n = 1.0 / (wgs84::r_n(s) + position.h);
    transport(v_t, per_r_m, per_r_n, s / c)
}

/// [`omega_et_t`] for hot loops, from 1 / (R_M + h), 1 / (R_N + h) (1/m) and tan L.
#[inline(always)]
pub fn transport<S: Real>(v_t: Vec3<T, S>, per_r_m: S, per_r_n: S, tan_lat: S) -> Rate<T, E, T, S> {
    let [v_n, v_e, _] = v_t.as_array();
    let east = v_e * per_r_n;
    Rate::claim(Vec3::new(east, -(v_n * per_r_m), -(east * tan_lat)))
}
