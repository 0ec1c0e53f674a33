//! The temperature of a run.

use libm::{exp, expm1};

use crate::Truth;
use crate::error::Error;

/// Temperature as a function of time; temperatures in K, times in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Temperature<'a> {
    /// Always the same.
    Constant(f64),
    /// `start + rate t`.
    Ramp {
        /// Temperature at t = 0, K.
        start: f64,
        /// Rate, K/s.
        rate: f64,
    },
    /// Exponential warm-up: `end + (start - end) exp(-t/tau)`.
    WarmUp {
        /// Temperature at t = 0, K.
        start: f64,
        /// Temperature at last, K.
        end: f64,
        /// Time constant, s.
        tau: f64,
    },
    /// Points (time, temperature) with straight lines between them, constant outside of them.
    Table(&'a [(f64, f64)]),
}

impl Temperature<'_> {
    /// Checks all numbers.
    ///
    /// # Errors
    /// A number is not finite, a temperature is not above 0 K at its start, `tau` is not above zero, or
    /// the table is empty or its times do not increase.
    pub fn validate(&self) -> Result<(), Error> {
        let check = |condition: bool, name, value, need| {
            if condition { Ok(()) } else { Err(Error::Temperature { name, value, need }) }
        };
        let kelvin = |name, t: f64| check(t > 0.0 && t.is_finite(), name, t, "a temperature above 0 K");
        match *self {
            Temperature::Constant(t) => kelvin("constant", t),
            Temperature::Ramp { start, rate } => {
                kelvin("start", start)?;
                check(rate.is_finite(), "rate", rate, "a finite rate in K/s")
            }
            Temperature::WarmUp { start, end, tau } => {
                kelvin("start", start)?;
                kelvin("end", end)?;
                check(tau > 0.0 && tau.is_finite(), "tau", tau, "a time constant above 0 s")
            }
            Temperature::Table(points) => {
                check(!points.is_empty(), "table", 0.0, "a list of one point (time, temperature) or more")?;
                for (_, t) in points {
                    kelvin("table", *t)?;
                }
                let first = points.iter().map(|p| p.0).find(|t| !t.is_finite());
                let fall = points.windows(2).find(|w| w[0].0 >= w[1].0).map(|w| w[1].0);
                let bad = first.or(fall);
                check(bad.is_none(), "table", bad.unwrap_or(0.0), "a finite time after the one before")
            }
        }
    }

    /// Temperature at time `t`, K.
    pub fn at(&self, t: f64) -> f64 {
        match *self {
            Temperature::Constant(value) => value,
            Temperature::Ramp { start, rate } => start + rate * t,
            Temperature::WarmUp { start, end, tau } => end + (start - end) * exp(-t / tau),
            Temperature::Table(points) => {
                let next = points.partition_point(|p| p.0 <= t);
                match (next.checked_sub(1).map(|i| points[i]), points.get(next)) {
                    (Some((t0, a)), Some((t1, b))) => a + (b - a) * (t - t0) / (t1 - t0),
                    (Some((_, value)), None) => value,
                    (None, next) => next.map_or(Truth::TEMPERATURE, |p| p.1),
                }
            }
        }
    }

    /// Mean over the `dt` seconds that begin at time `t`, K.
    pub fn mean(&self, t: f64, dt: f64) -> f64 {
        match *self {
            Temperature::Constant(_) | Temperature::Ramp { .. } => self.at(t + 0.5 * dt),
            Temperature::WarmUp { start, end, tau } => {
                end - (start - end) * exp(-t / tau) * expm1(-dt / tau) * tau / dt
            }
            Temperature::Table(points) => {
                // Trapezoids between the ends of the interval and the points inside.
                let end = t + dt;
                let inside = points.iter().map(|p| p.0).filter(|p| *p > t && *p < end);
                let (sum, last) = inside.chain([end]).fold((0.0, t), |(sum, from), to| {
                    (sum + 0.5 * (to - from) * (self.at(from) + self.at(to)), to)
                });
                sum / (last - t)
            }
        }
    }

    /// Mean rate over the `dt` seconds that begin at time `t`, K/s.
    pub fn rate(&self, t: f64, dt: f64) -> f64 {
        match *self {
            Temperature::Constant(_) => 0.0,
            Temperature::Ramp { rate, .. } => rate,
            Temperature::WarmUp { start, end, tau } => (start - end) * exp(-t / tau) * expm1(-dt / tau) / dt,
            Temperature::Table(_) => (self.at(t + dt) - self.at(t)) / dt,
        }
    }
}

impl Truth {
    /// The same at the mean temperature of the `dt` seconds that begin at time `t`.
    pub fn at_temperature(self, temperature: &Temperature<'_>, t: f64, dt: f64) -> Truth {
        self.with_temperature(temperature.mean(t, dt), temperature.rate(t, dt))
    }
}
