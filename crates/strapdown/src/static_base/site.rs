//! What the closed forms need to know of the place.

use schuler_frames::{Geodetic, Gravity, wgs84};

/// A place at rest on the ellipsoid: the constants of the static error equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// sin L.
    pub sin_lat: f64,
    /// cos L.
    pub cos_lat: f64,
    /// Gravity along the plumb line, m/s².
    pub g: f64,
    /// Meridian radius plus height, m.
    pub r_m: f64,
    /// Prime-vertical radius plus height, m.
    pub r_n: f64,
    /// Earth rate, rad/s.
    pub omega_ie: f64,
}

impl Site {
    /// The place at `position` in the field `gravity`, of which the magnitude counts.
    pub fn new(position: Geodetic, gravity: Gravity) -> Self {
        let (sin_lat, cos_lat) = libm::sincos(position.lat);
        Site {
            sin_lat,
            cos_lat,
            g: gravity.gravity_t(position).norm(),
            r_m: wgs84::r_m(sin_lat) + position.h,
            r_n: wgs84::r_n(sin_lat) + position.h,
            omega_ie: wgs84::OMEGA,
        }
    }

    /// The two exact Schuler-Foucault rates, the larger first, rad/s:
    /// `w² = (B ± D)/2`, `B = g/R_M + g/R_N + 4 Omega² sin² L`, `D² = B² - 4 g²/(R_M R_N)`.
    pub fn schuler_foucault_rates(&self) -> (f64, f64) {
        let (wm2, wn2) = (self.g / self.r_m, self.g / self.r_n);
        let a2 = 4.0 * (self.omega_ie * self.sin_lat) * (self.omega_ie * self.sin_lat);
        let b = wm2 + wn2 + a2;
        let d = libm::sqrt((wm2 - wn2) * (wm2 - wn2) + a2 * (2.0 * (wm2 + wn2) + a2));
        (libm::sqrt((b + d) / 2.0), libm::sqrt((b - d) / 2.0))
    }
}
