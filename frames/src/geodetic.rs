//! Geodetic coordinates on WGS 84 and their exact relation to Earth-fixed Cartesian ones.

use crate::{E, Rot, T, Vec3, wgs84};

/// Geodetic position on WGS 84.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Geodetic {
    /// Geodetic latitude L, rad, north positive, within ±π/2.
    pub lat: f64,
    /// Longitude, rad, east positive. Any turn is accepted; what is computed lies within ±π.
    pub lon: f64,
    /// Height above the ellipsoid (not above the geoid), m, up positive.
    pub h: f64,
}

impl Geodetic {
    /// From latitude, longitude (rad) and ellipsoidal height (m).
    pub const fn new(lat: f64, lon: f64, h: f64) -> Self {
        Geodetic { lat, lon, h }
    }

    /// From an Earth-fixed position, m.
    ///
    /// Bowring's iteration on the parametric latitude, run to the rounding of `f64` (there and back: 5e-9 m
    /// on the ground, 9e-9 m at 10 000 km), from 5000 km below the ellipsoid upwards. The poles are no
    /// special case (there the longitude is 0). Points within 50 km of the Earth's centre have no unique
    /// geodetic coordinates: for them the result is meaningless.
    pub fn from_ecef(r_e: Vec3<E>) -> Self {
        let [x, y, z] = r_e.as_array();
        let p = libm::hypot(x, y);
        // Parametric latitude beta as (sin, cos) times some length; Bowring's first guess.
        let mut beta = (z * (1.0 - wgs84::F) * (1.0 + wgs84::EP2 * wgs84::B / libm::hypot(p, z)), p);
        let mut lat = (0.0, 0.0);
        // One round leaves 3e-13 rad on the ground, two leave rounding.
        for _ in 0..2 {
            let n = libm::hypot(beta.0, beta.1);
            let (s, c) = (beta.0 / n, beta.1 / n);
            lat = (z + wgs84::EP2 * wgs84::B * s * s * s, p - wgs84::E2 * wgs84::A * c * c * c);
            beta = (lat.0 * (1.0 - wgs84::F), lat.1);
        }
        let n = libm::hypot(lat.0, lat.1);
        let (s, c) = (lat.0 / n, lat.1 / n);
        // From the foot point on the ellipsoid, along the normal: an error of lat enters h squared only.
        let r_n = wgs84::r_n(s);
        let h = (p - r_n * c) * c + (z - (1.0 - wgs84::E2) * r_n * s) * s;
        Geodetic { lat: libm::atan2(lat.0, lat.1), lon: libm::atan2(y, x), h }
    }

    /// As an Earth-fixed position r_e, m.
    pub fn as_ecef(self) -> Vec3<E> {
        let (s, c) = libm::sincos(self.lat);
        let (sin_lon, cos_lon) = libm::sincos(self.lon);
        let r_n = wgs84::r_n(s);
        let p = (r_n + self.h) * c;
        Vec3::new(p * cos_lon, p * sin_lon, ((1.0 - wgs84::E2) * r_n + self.h) * s)
    }

    /// C_t^e, local north-east-down to Earth-fixed. Defined at the poles too, by the longitude given.
    pub fn c_et(self) -> Rot<E, T> {
        let (sin_lon, cos_lon) = libm::sincos(0.5 * self.lon);
        let (s, c) = libm::sincos(-0.5 * (core::f64::consts::FRAC_PI_2 + self.lat));
        // A turn by lon about z, then by -(π/2 + L) about the new y (east).
        Rot::claim([cos_lon * c, -sin_lon * s, cos_lon * s, sin_lon * c])
    }
}
