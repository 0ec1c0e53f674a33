//! A piece of a drive or flight in which speed, climb angle, rate of heading and roll pass smoothly from one value to another.

use schuler_frames::{T, Vec3};

use super::super::{Jet, smooth};

/// Value at the begin and at the end of a piece; between them a quintic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    pub from: f64,
    pub to: f64,
}

impl Change {
    pub fn none(value: f64) -> Self {
        Change { from: value, to: value }
    }

    fn at(&self, step: Jet) -> Jet {
        step * (self.to - self.from) + self.from
    }
}

/// A piece: all four pass at the same time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    pub begin: f64,
    pub duration: f64,
    pub speed: Change,
    /// Climb angle, which is the pitch.
    pub climb: Change,
    /// Heading at the begin.
    pub heading: f64,
    /// Rate of heading.
    pub rate: Change,
    /// Roll, to which a coordinated turn adds its bank.
    pub roll: Change,
    /// Gravity that the bank of a coordinated turn balances, m/s²; none where it stays flat.
    pub banked: Option<f64>,
}

/// Speed, climb angle, heading and roll at one time.
pub struct Flown {
    pub speed: Jet,
    pub climb: Jet,
    pub heading: Jet,
    pub roll: Jet,
}

impl Piece {
    pub fn end(&self) -> f64 {
        self.begin + self.duration
    }

    /// Heading at the end.
    pub fn turned(&self) -> f64 {
        self.heading + 0.5 * (self.rate.from + self.rate.to) * self.duration
    }

    /// Angular frequency of what happens in it.
    pub fn fastest(&self) -> f64 {
        let changes = [self.speed, self.climb, self.rate, self.roll];
        let passage =
            if changes.iter().any(|c| c.from != c.to) { smooth::frequency(self.duration) } else { 0.0 };
        passage + self.rate.from.abs().max(self.rate.to.abs())
    }

    pub fn at(&self, t: f64) -> Flown {
        let tau = t - self.begin;
        let u = tau / self.duration;
        let step = smooth::step(u, self.duration);
        let rate = self.rate.at(step);
        // The integral of the quintic, 5/2 u⁴ - 3 u⁵ + u⁶ in units of the duration; held values go on beyond the piece.
        let part = u.clamp(0.0, 1.0);
        let passed = part * part * part * part * (2.5 - part * (3.0 - part)) + (u - 1.0).max(0.0);
        let heading =
            self.heading + self.rate.from * tau + (self.rate.to - self.rate.from) * passed * self.duration;
        let (speed, climb) = (self.speed.at(step), self.climb.at(step));
        let mut roll = self.roll.at(step);
        if let Some(g) = self.banked {
            // tan(bank) = V cos(climb) heading' / g: no lateral force but of the Earth's rotation.
            let cos = if self.climb.from == 0.0 && self.climb.to == 0.0 {
                Jet::constant(1.0)
            } else {
                climb.sin_cos().1
            };
            roll = roll + (speed * cos * rate * (1.0 / g)).atan();
        }
        Flown { speed, climb, heading: rate.integral(heading), roll }
    }
}

impl Flown {
    /// v_t (m/s) and the derivatives of its components (m/s²).
    pub fn velocity(&self) -> (Vec3<T>, Vec3<T>) {
        let ((sin, cos), (s, c)) = (libm::sincos(self.climb.value()), libm::sincos(self.heading.value()));
        let (level, up) = (self.speed.value() * cos, self.speed.value() * sin);
        let faster = self.speed.rate() * cos - up * self.climb.rate();
        let across = level * self.heading.rate();
        let higher = self.speed.rate() * sin + level * self.climb.rate();
        (
            Vec3::new(level * c, level * s, -up),
            Vec3::new(faster * c - across * s, faster * s + across * c, -higher),
        )
    }
}
