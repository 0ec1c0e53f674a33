//! From segments to pieces.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::{
    Course, Segment, Sharpness, Turn,
    piece::{Change, Piece},
};
use crate::trajectory::{Impossible, quadrature, smooth};

/// Pieces so far, and how the vehicle goes at their end.
pub struct Plan {
    pieces: Vec<Piece>,
    end: f64,
    speed: f64,
    heading: f64,
    climb: f64,
    roll: f64,
    g: f64,
}

/// Steepest climb: the nose must have a heading.
const STEEPEST: f64 = 89.0 / 90.0 * FRAC_PI_2;

impl Plan {
    /// Begins with going on as it was, for times before zero; `g` is the gravity (m/s²) of a coordinated turn.
    pub fn new(start: &Course, g: f64) -> Result<Self, Impossible> {
        Impossible::speed(start.speed)?;
        let Course { speed, heading, climb, roll, .. } = *start;
        let plan = Plan { pieces: Vec::new(), end: 0.0, speed, heading, climb, roll, g };
        plan.steep(climb)?;
        Ok(plan)
    }

    /// The pieces, and all their begins and the last end.
    pub fn finish(mut self) -> (Vec<Piece>, Vec<f64>) {
        if self.pieces.is_empty() {
            // Straight on is a motion too.
            self.hold(1.0);
        }
        let mut joints: Vec<f64> = self.pieces.iter().map(|piece| piece.begin).collect();
        joints.push(self.end);
        (self.pieces, joints)
    }

    /// One segment more.
    pub fn add(&mut self, segment: &Segment) -> Result<(), Impossible> {
        match *segment {
            Segment::Stand { duration } => {
                if self.speed != 0.0 {
                    let problem = format!("it stands, but comes with {} m/s", self.speed);
                    return Err(Impossible::new(problem, "`accelerate: { to: 0 m/s, … }` before"));
                }
                self.lasting(duration)?;
                self.hold(duration);
            }
            Segment::Straight { duration } => {
                self.lasting(duration)?;
                self.hold(duration);
            }
            Segment::Distance { distance } => {
                let duration = distance / self.moving()?;
                self.lasting(duration)?;
                self.hold(duration);
            }
            Segment::Accelerate { to, duration } => {
                Impossible::speed(to)?;
                self.lasting(duration)?;
                let speed = Change { from: self.speed, to };
                self.push(Piece { speed, ..self.level(duration) });
            }
            Segment::Roll { to, duration } => {
                self.lasting(duration)?;
                let roll = Change { from: self.roll, to };
                self.push(Piece { roll, ..self.level(duration) });
            }
            Segment::Turn { angle, turn } => self.turn(angle, &turn)?,
            Segment::STurn { angle, turn } => {
                for part in [angle, -2.0 * angle, angle] {
                    self.turn(part, &turn)?;
                }
            }
            Segment::FigureOfEight { count, turn } => {
                for _ in 0..count {
                    self.turn(TAU, &turn)?;
                    self.turn(-TAU, &turn)?;
                }
            }
            Segment::Climb { height, angle, ramp } => self.climb(height, angle, ramp)?,
        }
        Ok(())
    }

    fn turn(&mut self, angle: f64, turn: &Turn) -> Result<(), Impossible> {
        self.lasting(turn.ramp)?;
        let positive = |value: f64, what: &str| match value > 0.0 {
            true => Ok(value),
            false => Err(Impossible::new(format!("{what} of zero or less"), "more than zero")),
        };
        let rate = match turn.sharpness {
            // On the spot, like a tracked vehicle.
            Sharpness::Rate(rate) if turn.flat => rate,
            Sharpness::Rate(rate) => {
                self.moving()?;
                rate
            }
            Sharpness::Radius(radius) => {
                self.moving()? * libm::cos(self.climb) / positive(radius, "a radius")?
            }
            Sharpness::Bank(bank) if bank < FRAC_PI_2 => {
                libm::tan(bank) * self.g / (self.moving()? * libm::cos(self.climb))
            }
            Sharpness::Bank(_) => {
                return Err(Impossible::new("a bank of 90 deg or more", "less than 90 deg"));
            }
        };
        positive(rate, "a rate")?;
        // A small turn is over before its rate is reached.
        let rate = rate.min(angle.abs() / turn.ramp).copysign(angle);
        let hold = (angle / rate - turn.ramp).max(0.0);
        let banked = (!turn.flat).then_some(self.g);
        let changes = [(0.0, rate, turn.ramp), (rate, rate, hold), (rate, 0.0, turn.ramp)];
        let heading = self.heading + angle;
        for (from, to, duration) in changes {
            if duration > 1e-9 && angle != 0.0 {
                let rate = Change { from, to };
                self.push(Piece { rate, banked, ..self.level(duration) });
            }
        }
        self.heading = heading;
        Ok(())
    }

    fn climb(&mut self, height: f64, angle: f64, ramp: f64) -> Result<(), Impossible> {
        let speed = self.moving()?;
        self.lasting(ramp)?;
        self.steep(angle)?;
        let climb = angle.copysign(height);
        let pulls = [Change { from: self.climb, to: climb }, Change { from: climb, to: 0.0 }];
        // What the pulls themselves gain, by quadrature.
        let gained: f64 = pulls
            .iter()
            .map(|pull| {
                let mut gained = 0.0;
                quadrature::nodes(
                    0.0,
                    ramp,
                    |_| smooth::frequency(ramp),
                    &[],
                    |t, weight| {
                        let part = smooth::step(t / ramp, ramp).value();
                        gained += speed * libm::sin(pull.from + (pull.to - pull.from) * part) * weight;
                    },
                );
                gained
            })
            .sum();
        let hold = (height - gained) / (speed * libm::sin(climb));
        if hold.is_nan() || hold < 0.0 {
            let problem = format!("the pulls of the climb gain {gained:.1} m already");
            return Err(Impossible::new(problem, "a larger height, a smaller angle or a shorter ramp"));
        }
        let changes = [pulls[0], Change::none(climb), pulls[1]];
        for (climb, duration) in changes.into_iter().zip([ramp, hold, ramp]) {
            if duration > 1e-9 {
                self.push(Piece { climb, ..self.level(duration) });
            }
        }
        Ok(())
    }

    fn hold(&mut self, duration: f64) {
        self.push(self.level(duration));
    }

    /// On as it goes.
    fn level(&self, duration: f64) -> Piece {
        Piece {
            begin: self.end,
            duration,
            speed: Change::none(self.speed),
            climb: Change::none(self.climb),
            heading: self.heading,
            rate: Change::none(0.0),
            roll: Change::none(self.roll),
            banked: None,
        }
    }

    fn push(&mut self, piece: Piece) {
        self.end = piece.end();
        self.speed = piece.speed.to;
        self.climb = piece.climb.to;
        self.heading = piece.turned();
        self.roll = piece.roll.to;
        self.pieces.push(piece);
    }

    fn moving(&self) -> Result<f64, Impossible> {
        if self.speed > 0.0 {
            return Ok(self.speed);
        }
        Err(Impossible::new("it needs a speed and has none", "`accelerate: { to: 10 m/s, … }` before"))
    }

    fn lasting(&self, duration: f64) -> Result<(), Impossible> {
        if duration > 0.0 && duration.is_finite() {
            return Ok(());
        }
        Err(Impossible::new(format!("it takes {duration} s"), "more than zero"))
    }

    fn steep(&self, climb: f64) -> Result<(), Impossible> {
        if climb.abs() <= STEEPEST && climb.is_finite() {
            return Ok(());
        }
        let problem = format!("a climb angle of {:.2} deg", climb.to_degrees());
        Err(Impossible::new(problem, "less than 89 deg: the nose must have a heading"))
    }
}
