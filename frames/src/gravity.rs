//! Gravity of the ellipsoid in two models, each one physical field in i, e and t.

mod normal;
pub mod somigliana;

use crate::{E, Geodetic, I, T, Vec3, wgs84};

/// The gravity model. Gravity is what a plumb line feels: gravitation plus the centrifugal
/// acceleration of the rotating Earth, m/s².
///
/// Each method gives the same field in another frame or with another part, so that mechanizations in
/// i, e and t that use the same variant feel the same force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gravity {
    /// The exact field of the level ellipsoid WGS 84 in closed form, with its north component above the
    /// ellipsoid (-8e-6 m/s² at 45 deg and 1 km). Harmonic outside the ellipsoid; valid from 100 km below
    /// the ellipsoid to any height. Source: Heiskanen and Moritz, Physical Geodesy (1967), chapter 2.
    Normal,
    /// Somigliana's formula on the ellipsoid and a second-order series in height, straight down at
    /// any height: what most references use. See [`somigliana::gamma`]. Good to 1e-6 m/s² in
    /// magnitude up to 10 km, and no field for orbits: the series ends at h².
    Somigliana,
}

impl Gravity {
    /// Gravity g^t, m/s², in local north-east-down axes.
    pub fn gravity_t(self, position: Geodetic) -> Vec3<T> {
        match self {
            Gravity::Normal => position.c_et().inverse() * self.gravity_e(position.as_ecef()),
            Gravity::Somigliana => {
                let s = libm::sin(position.lat);
                Vec3::new(0.0, 0.0, somigliana::gamma(s * s, position.h, wgs84::w(s)))
            }
        }
    }

    /// Change of gravity g^t with latitude, m/s² per rad, and with height, 1/s²:
    /// `(dg/dL, dg/dh)`, each in local axes that move along.
    ///
    /// Analytic for `Somigliana`; for `Normal` central differences of the exact field over 300 m
    /// of latitude and 30 m of height to either side, good to 1e-8 of its largest values.
    pub fn gradient_t(self, position: Geodetic) -> (Vec3<T>, Vec3<T>) {
        match self {
            Gravity::Normal => {
                // Each where rounding of g and the curvature of its change cost about the same.
                const LAT_STEP: f64 = 300.0 / wgs84::A;
                const H_STEP: f64 = 30.0;
                let Geodetic { lat, lon, h } = position;
                let at = |lat: f64, h: f64| self.gravity_t(Geodetic::new(lat, lon, h));
                let dlat = at(lat + LAT_STEP, h) - at(lat - LAT_STEP, h);
                let dh = at(lat, h + H_STEP) - at(lat, h - H_STEP);
                (dlat * (0.5 / LAT_STEP), dh * (0.5 / H_STEP))
            }
            Gravity::Somigliana => {
                let (s, c) = libm::sincos(position.lat);
                let (dlat, dh) = somigliana::gradient(s, c, position.h, wgs84::w(s));
                (Vec3::new(0.0, 0.0, dlat), Vec3::new(0.0, 0.0, dh))
            }
        }
    }

    /// Gravity g^e, m/s², at the Earth-fixed position `r_e` (m).
    pub fn gravity_e(self, r_e: Vec3<E>) -> Vec3<E> {
        match self {
            Gravity::Normal => self.gravitation_e(r_e) + centrifugal(r_e),
            Gravity::Somigliana => {
                let position = Geodetic::from_ecef(r_e);
                position.c_et() * self.gravity_t(position)
            }
        }
    }

    /// Gravitation (without the centrifugal part) in Earth-fixed axes, m/s², at `r_e` (m).
    pub fn gravitation_e(self, r_e: Vec3<E>) -> Vec3<E> {
        match self {
            Gravity::Normal => Vec3::claim(normal::gravitation(r_e.as_array())),
            Gravity::Somigliana => self.gravity_e(r_e) - centrifugal(r_e),
        }
    }

    /// Gravitation in inertial axes, m/s², at the inertial position `r_i` (m). Time does not enter:
    /// the field is symmetric about the axis that i and e share.
    pub fn gravitation_i(self, r_i: Vec3<I>) -> Vec3<I> {
        Vec3::claim(self.gravitation_e(Vec3::claim(r_i.as_array())).as_array())
    }
}

/// Centrifugal acceleration of a point at rest in e, -omega × (omega × r), m/s².
fn centrifugal(r_e: Vec3<E>) -> Vec3<E> {
    let [x, y, _] = r_e.as_array();
    const OMEGA2: f64 = wgs84::OMEGA * wgs84::OMEGA;
    Vec3::new(OMEGA2 * x, OMEGA2 * y, 0.0)
}
