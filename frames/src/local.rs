//! Offsets in metres near a point: position errors by the radii, and exact local tangent coordinates.

use core::f64::consts::{PI, TAU};

use crate::{Dcm, E, Enu, Geodetic, T, Vec3, wgs84};

/// North-east-down to east-north-up, for the edges where others speak ENU. Its own transpose in numbers.
pub const C_ENU_T: Dcm<Enu, T> = Dcm::claim([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]);

/// Position error, m, north-east-down, computed minus true, by the radii at the true position:
/// ((R_M + h) dL, (R_N + h) cos L dlon, -dh).
///
/// First order in the error by definition: this is the unit in which errors are given, not a distance on
/// the Earth. The difference of longitudes is taken the short way round. For exact differences use
/// [`Geodetic::local_ned`].
pub fn position_error(computed: Geodetic, truth: Geodetic) -> Vec3<T> {
    let (north, east) = metres_per_rad(truth);
    let dlon = computed.lon - truth.lon;
    let dlon = dlon - TAU * libm::floor((dlon + PI) / TAU);
    Vec3::new(north * (computed.lat - truth.lat), east * dlon, truth.h - computed.h)
}

/// The computed position that has the position error `error` (m, north-east-down). Inverse of
/// [`position_error`]; not for use at the poles, where a metre to the east is no longitude.
pub fn with_position_error(truth: Geodetic, error: Vec3<T>) -> Geodetic {
    let (north, east) = metres_per_rad(truth);
    let [n, e, d] = error.as_array();
    Geodetic::new(truth.lat + n / north, truth.lon + e / east, truth.h - d)
}

/// (R_M + h, (R_N + h) cos L): metres a radian of latitude and of longitude.
fn metres_per_rad(p: Geodetic) -> (f64, f64) {
    let (s, c) = libm::sincos(p.lat);
    (wgs84::r_m(s) + p.h, (wgs84::r_n(s) + p.h) * c)
}

impl Geodetic {
    /// Position `r_e` (m) in the north-east-down axes of the tangent plane at this point, m. Exact at any distance.
    pub fn local_ned(self, r_e: Vec3<E>) -> Vec3<T> {
        self.c_et().inverse() * (r_e - self.as_ecef())
    }

    /// Earth-fixed position (m) of a point given north-east-down in the tangent plane at this point, m.
    /// Inverse of [`Geodetic::local_ned`].
    pub fn ecef_of_local(self, ned: Vec3<T>) -> Vec3<E> {
        self.as_ecef() + self.c_et() * ned
    }
}
