//! Through given points.

use schuler_frames::{Geodetic, Gravity, wgs84};

use super::{
    Impossible, Kinematics, Trajectory,
    route::{HIGHEST_LAT, Passing},
    smooth,
    spline::Interpolation,
};

/// When a point is passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Passage {
    /// At this time, s.
    Time(f64),
    /// With this mean speed on the straight way from the point before, m/s.
    Speed(f64),
}

/// A point to pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waypoint {
    /// Where.
    pub position: Geodetic,
    /// When.
    pub passage: Passage,
}

/// Looks at a track between two points.
const LOOKS: u32 = 32;

/// A vehicle that passes points on time: latitude, longitude and height are natural quintic splines in time (four continuous
/// derivatives), the nose points along the track, and in turns it banks so that no lateral force over ground is felt.
#[derive(Clone, Debug, PartialEq)]
pub struct Waypoints {
    spline: Interpolation,
    times: Vec<f64>,
    /// Gravity that the bank balances, m/s²; none where the vehicle stays level.
    g: Option<f64>,
    fastest: f64,
}

impl Waypoints {
    /// From `start` at t = 0 through `points`; `flat` keeps the roll at zero.
    ///
    /// # Errors
    /// Times that do not increase, a speed beyond reason or of zero, a pole; each with the point it leads to.
    pub fn new(
        start: Geodetic,
        points: &[Waypoint],
        flat: bool,
        gravity: Gravity,
    ) -> Result<Self, Impossible> {
        if points.is_empty() {
            return Err(Impossible::new("no point to go to", "one or more"));
        }
        let (mut times, mut values) = (vec![0.0], vec![[start.lat, start.lon, start.h]]);
        let (mut before, mut now) = (start, 0.0);
        for (k, point) in points.iter().enumerate() {
            let Geodetic { lat, lon, h } = point.position;
            if lat.abs() > HIGHEST_LAT {
                let fault = Impossible::new("a point beyond 89.6 deg of latitude", "a lower latitude");
                return Err(fault.at(k));
            }
            // The short way round.
            let turns = ((lon - before.lon) / std::f64::consts::TAU).round();
            let position = Geodetic::new(lat, lon - turns * std::f64::consts::TAU, h);
            let way = distance(before, position);
            let then = match point.passage {
                Passage::Time(t) => t,
                Passage::Speed(speed) => now + way / speed,
            };
            let increases = then > now && then.is_finite();
            if !increases {
                let problem = format!("the time {then} s does not come after {now} s");
                return Err(Impossible::new(problem, "times that increase, from the start at 0 s").at(k));
            }
            Impossible::speed(way / (then - now)).map_err(|fault| fault.at(k))?;
            times.push(then);
            values.push([position.lat, position.lon, h]);
            (before, now) = (position, then);
        }
        let shortest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let mut route = Waypoints {
            spline: Interpolation::new(&times, &values),
            times,
            g: (!flat).then(|| gravity.gravity_t(start).norm()),
            fastest: 0.0,
        };
        let mut turning = 0f64;
        for k in 0..points.len() {
            let [begin, end] = [route.times[k], route.times[k + 1]];
            for look in 0..=LOOKS {
                let t = begin + (end - begin) * f64::from(look) / f64::from(LOOKS);
                let passing = Passing::new(route.spline.at(t));
                passing.possible(true).map_err(|fault| fault.at(k))?;
                turning = turning.max(passing.stance(route.g).omega_tb_b.norm());
            }
        }
        route.fastest = turning * 2.0 + smooth::frequency(shortest);
        Ok(route)
    }
}

/// Straight way between two places, m, by the radii in the middle.
fn distance(a: Geodetic, b: Geodetic) -> f64 {
    let (lat, h) = (0.5 * (a.lat + b.lat), 0.5 * (a.h + b.h));
    let (s, c) = libm::sincos(lat);
    let north = (wgs84::r_m(s) + h) * (b.lat - a.lat);
    let east = (wgs84::r_n(s) + h) * c * (b.lon - a.lon);
    north.hypot(east).hypot(b.h - a.h)
}

impl Trajectory for Waypoints {
    fn at(&self, t: f64) -> Kinematics {
        let passing = Passing::new(self.spline.at(t));
        Kinematics::new(passing.place, passing.stance(self.g))
    }

    fn joints(&self) -> &[f64] {
        &self.times
    }

    fn duration(&self) -> Option<f64> {
        self.times.last().copied()
    }

    fn fastest(&self, _: f64) -> f64 {
        self.fastest
    }
}
