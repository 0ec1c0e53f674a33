//! Place, time, attitude and velocity at t = 0.

use std::{f64::consts::FRAC_PI_2, str::FromStr};

use hifitime::Epoch;
use schuler_frames::{Euler, Geodetic};
use schuler_imu::Unit;

use super::{
    de::At,
    document::{Document, Spot},
    quantity::Range,
    valid, written,
};
use crate::Diagnostic;

const VELOCITY: Unit = Unit::METRE.over(Unit::SECOND);
/// Nothing that navigates here is deeper or higher, m.
const HEIGHTS: std::ops::RangeInclusive<f64> = -20e3..=100e6;

impl Document {
    pub(super) fn start(&self, start: &At<written::Start>) -> Result<valid::Start, Diagnostic> {
        let start = &start.value;
        let attitude = start.attitude.as_ref().map(|a| self.attitude(&a.value)).transpose()?;
        let velocity = start.velocity.as_ref().map(|v| self.velocity(&v.value)).transpose()?;
        Ok(valid::Start {
            epoch: start.epoch.as_ref().map(|e| self.epoch(e)).transpose()?,
            position: self.position(&start.position)?,
            attitude: attitude.unwrap_or_default(),
            velocity: velocity.unwrap_or_default(),
        })
    }

    fn epoch(&self, text: &At<String>) -> Result<Epoch, Diagnostic> {
        Epoch::from_str(&text.value).map_err(|_| {
            self.diagnostic(Spot::Node(text.node), "no date and time")
                .expected("date, time and time scale (UTC, GPST, TAI, TT, …)")
                .found(format!("`{}`", text.value))
                .example("2026-01-01T00:00:00 UTC")
        })
    }

    fn position(&self, position: &At<written::Position>) -> Result<Geodetic, Diagnostic> {
        let written::Position { lat, lon, h, x, y, z } = &position.value;
        let position = match (lat, lon, h, x, y, z) {
            (Some(lat), Some(lon), Some(h), None, None, None) => {
                let lat = self.within(lat, FRAC_PI_2, "latitude", "-90 deg to 90 deg", "45 deg")?;
                let lon = self.within(lon, 4.0 * FRAC_PI_2, "longitude", "-360 deg to 360 deg", "7.5 deg")?;
                Geodetic::new(lat, lon, self.quantity(h, Unit::METRE, Range::Any)?)
            }
            (None, None, None, Some(x), Some(y), Some(z)) => {
                let metres = |q| self.quantity(q, Unit::METRE, Range::Any);
                let (x, y, z) = (metres(x)?, metres(y)?, metres(z)?);
                let (lat, lon, h) = map_3d::ecef2geodetic(x, y, z, map_3d::Ellipsoid::WGS84);
                Geodetic::new(lat, lon, h)
            }
            _ => {
                return Err(self
                    .diagnostic(Spot::Node(position.node), "neither a geodetic nor an Earth-fixed position")
                    .expected("`lat`, `lon` and `h`, or `x`, `y` and `z`")
                    .example("{ lat: 45 deg, lon: 0 deg, h: 0 m }"));
            }
        };
        if !HEIGHTS.contains(&position.h) {
            let spot = Spot::Node(h.as_ref().map_or(position_node(x), |h| h.node));
            return Err(self
                .diagnostic(spot, "height out of range")
                .expected("-20 km to 100 000 km above the ellipsoid")
                .found(format!("{:.3} km", position.h / 1e3))
                .example("380 m"));
        }
        Ok(position)
    }

    /// An angle within ± `limit`, rad.
    fn within(
        &self,
        angle: &written::Quantity,
        limit: f64,
        what: &str,
        range: &str,
        example: &str,
    ) -> Result<f64, Diagnostic> {
        let value = self.quantity(angle, Unit::RADIAN, Range::Any)?;
        if value.abs() <= limit {
            return Ok(value);
        }
        Err(self
            .diagnostic(Spot::Node(angle.node), format!("{what} out of range"))
            .expected(range)
            .found(format!("{} deg", value.to_degrees()))
            .example(example))
    }

    fn attitude(&self, attitude: &written::Attitude) -> Result<Euler, Diagnostic> {
        let turn = |angle, what| self.within(angle, 4.0 * FRAC_PI_2, what, "-360 deg to 360 deg", "10 deg");
        Ok(Euler {
            roll: turn(&attitude.roll, "roll")?,
            pitch: self.within(&attitude.pitch, FRAC_PI_2, "pitch", "-90 deg to 90 deg", "2 deg")?,
            yaw: turn(&attitude.yaw, "yaw")?,
        })
    }

    fn velocity(&self, velocity: &written::Velocity) -> Result<[f64; 3], Diagnostic> {
        let component = |q| self.quantity(q, VELOCITY, Range::Any);
        Ok([component(&velocity.n)?, component(&velocity.e)?, component(&velocity.d)?])
    }

    pub(super) fn initial_errors(
        &self,
        errors: Option<&At<written::InitialErrors>>,
    ) -> Result<Vec<valid::Initial>, Diagnostic> {
        let Some(errors) = errors.map(|e| &e.value) else { return Ok(Vec::new()) };
        let zero = [0.0; 3];
        let tilt = errors.tilt.as_ref().map_or(Ok([0.0; 2]), |t| self.quantities(t, Unit::RADIAN))?;
        let heading =
            errors.heading.as_ref().map_or(Ok(0.0), |h| self.quantity(h, Unit::RADIAN, Range::Any))?;
        let velocity = errors.velocity.as_ref().map_or(Ok(zero), |v| self.quantities(v, VELOCITY))?;
        let position = errors.position.as_ref().map_or(Ok(zero), |p| self.quantities(p, Unit::METRE))?;
        let along = |axis: usize, value: f64| {
            let mut vector = zero;
            vector[axis] = value;
            vector
        };
        let phi = |name, axis, value| valid::Initial {
            name,
            phi: along(axis, value),
            velocity: zero,
            position: zero,
        };
        let v = |name, axis, value| valid::Initial {
            name,
            phi: zero,
            velocity: along(axis, value),
            position: zero,
        };
        let r = |name, axis, value| valid::Initial {
            name,
            phi: zero,
            velocity: zero,
            position: along(axis, value),
        };
        let all = [
            (tilt[0], phi("initial.tilt.n", 0, tilt[0])),
            (tilt[1], phi("initial.tilt.e", 1, tilt[1])),
            (heading, phi("initial.heading.d", 2, heading)),
            (velocity[0], v("initial.velocity.n", 0, velocity[0])),
            (velocity[1], v("initial.velocity.e", 1, velocity[1])),
            (velocity[2], v("initial.velocity.d", 2, velocity[2])),
            (position[0], r("initial.position.n", 0, position[0])),
            (position[1], r("initial.position.e", 1, position[1])),
            (position[2], r("initial.position.d", 2, position[2])),
        ];
        Ok(all.into_iter().filter(|(value, _)| *value != 0.0).map(|(_, initial)| initial).collect())
    }
}

/// Where to point when a position made of x, y, z is out of range.
fn position_node(x: &Option<written::Quantity>) -> super::document::NodeId {
    x.as_ref().map_or(super::document::NodeId(0), |x| x.node)
}
