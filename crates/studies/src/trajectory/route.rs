//! Latitude, longitude and height as functions of time, and how a vehicle stands that follows them.

use schuler_frames::{Geodetic, Vec3, wgs84};

use super::{Impossible, Jet, Place, Stance};

/// Latitude up to which a route is described by its longitude.
pub const HIGHEST_LAT: f64 = 1.565;

/// Level speed below which a track has no heading, m/s.
const SLOWEST: f64 = 1e-3;

/// Motion over the Earth of a point whose latitude, longitude (rad) and height (m) have these derivatives.
pub struct Passing {
    pub place: Place,
    /// Velocity north, east and up, with three derivatives.
    velocity: [Jet<5>; 3],
}

impl Passing {
    pub fn new([lat, lon, h]: [Jet<5>; 3]) -> Self {
        let (s, c) = lat.sin_cos();
        let w = Jet::constant(1.0) / (s * s * -wgs84::E2 + 1.0).sqrt();
        let (r_n, r_m) = (w * wgs84::A, w * w * w * (wgs84::A * (1.0 - wgs84::E2)));
        let north = (r_m + h) * lat.derivative();
        let east = (r_n + h) * c * lon.derivative();
        let up = h.derivative();
        let position = Geodetic::new(lat.value(), lon.value(), h.value());
        let v_t = Vec3::new(north.value(), east.value(), -up.value());
        let v_dot = Vec3::new(north.rate(), east.rate(), -up.rate());
        Passing { place: Place::from_velocity(position, v_t, v_dot), velocity: [north, east, up] }
    }

    /// Nose along the track; banked by tan(bank) = level speed times rate of heading over `g` (m/s²), or level.
    pub fn stance(&self, g: Option<f64>) -> Stance {
        let [north, east, up] = self.velocity;
        let level = (north * north + east * east).sqrt();
        let (heading, climb) = (east.atan2(north), up.atan2(level));
        let roll = g.map_or(Jet::constant(0.0), |g| (level * heading.derivative() * (1.0 / g)).atan());
        Stance::from_euler(roll.truncated(), climb.truncated(), heading.truncated())
    }

    /// Refuses what has no speed or too much of it, or comes to a pole.
    pub fn possible(&self, heading: bool) -> Result<(), Impossible> {
        let [north, east, up] = self.velocity.map(|v| v.value());
        let level = north.hypot(east);
        Impossible::speed(level.hypot(up))?;
        if self.place.position.lat.abs() > HIGHEST_LAT {
            return Err(Impossible::new(
                "a latitude beyond 89.6 deg",
                "a track that stays away from the poles",
            ));
        }
        if heading && level < SLOWEST {
            return Err(Impossible::new(
                "the track stands still, or goes straight up or down, and so has no heading",
                "points and times that keep the vehicle moving; `segments` can stand",
            ));
        }
        Ok(())
    }
}
