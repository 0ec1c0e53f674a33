//! Drives and flights put together from segments.

mod piece;
mod plan;

use schuler_frames::{Geodetic, Gravity};

use super::{Impossible, Kinematics, Place, Stance, Track, Trajectory};
use piece::Piece;
use plan::Plan;

/// How a vehicle begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Where.
    pub position: Geodetic,
    /// Speed along the nose, m/s, not negative.
    pub speed: f64,
    /// Heading of nose and track, rad.
    pub heading: f64,
    /// Climb angle, which is the pitch, rad.
    pub climb: f64,
    /// Roll, rad.
    pub roll: f64,
}

/// How sharp a turn is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sharpness {
    /// Rate of heading in its middle, rad/s, positive.
    Rate(f64),
    /// Radius in its middle, m, positive.
    Radius(f64),
    /// Bank in its middle, rad, positive: `tan(bank) = v² / (g radius)`.
    Bank(f64),
}

/// A turn: the rate of heading comes and goes by quintics over `ramp`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// How sharp.
    pub sharpness: Sharpness,
    /// Time in which it comes to its rate, s. A turn too small for it stays slower.
    pub ramp: f64,
    /// Whether the vehicle keeps its roll, like a car; else it banks so that no lateral force is felt.
    pub flat: bool,
}

/// A part of a drive or flight. Speed, climb angle and roll pass from value to value by quintics, so velocity and
/// attitude are C2 at the joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    /// Nothing moves.
    Stand {
        /// s.
        duration: f64,
    },
    /// To another speed; brakes too.
    Accelerate {
        /// Speed at its end, m/s.
        to: f64,
        /// s.
        duration: f64,
    },
    /// On as it goes.
    Straight {
        /// s.
        duration: f64,
    },
    /// On as it goes, by a distance.
    Distance {
        /// m.
        distance: f64,
    },
    /// To another heading.
    Turn {
        /// To the right positive, rad; several turns are fine.
        angle: f64,
        /// How.
        turn: Turn,
    },
    /// To the right, twice as far to the left, and back to the line.
    STurn {
        /// To the right positive, rad.
        angle: f64,
        /// How.
        turn: Turn,
    },
    /// Full circles, one to the right and one to the left in turn.
    FigureOfEight {
        /// How many eights.
        count: u32,
        /// How.
        turn: Turn,
    },
    /// To another height, and level again.
    Climb {
        /// Change of height, negative for a descent, m.
        height: f64,
        /// Climb angle on the way, rad, positive.
        angle: f64,
        /// Time of each pull, s.
        ramp: f64,
    },
    /// To another roll, beside that of turns.
    Roll {
        /// Roll at its end, rad.
        to: f64,
        /// s.
        duration: f64,
    },
}

/// A drive or flight: the nose along the track, pitch the climb angle, and in a coordinated turn the bank of no lateral
/// force over ground (the Earth's rotation adds 1e-3 g at 100 m/s, which stays).
#[derive(Clone, Debug, PartialEq)]
pub struct Segments {
    pieces: Vec<Piece>,
    track: Track,
    joints: Vec<f64>,
}

impl Segments {
    /// The `segments` one after the other from `start`. Before and after them the vehicle goes straight on.
    ///
    /// # Errors
    /// A segment cannot be flown as it is asked for: says which, and why.
    pub fn new(start: Course, segments: &[Segment], gravity: Gravity) -> Result<Self, Impossible> {
        let g = gravity.gravity_t(start.position).norm();
        let mut plan = Plan::new(&start, g)?;
        for (k, segment) in segments.iter().enumerate() {
            plan.add(segment).map_err(|fault| fault.at(k))?;
        }
        let (pieces, joints) = plan.finish();
        let at = |t: f64| piece(&pieces, t).at(t).velocity().0;
        let track = Track::new(start.position, &joints, at)?;
        Ok(Segments { pieces, track, joints })
    }
}

fn piece(pieces: &[Piece], t: f64) -> &Piece {
    let begun = pieces.partition_point(|piece| piece.begin <= t);
    &pieces[begun.saturating_sub(1)]
}

impl Trajectory for Segments {
    fn at(&self, t: f64) -> Kinematics {
        let flown = piece(&self.pieces, t).at(t);
        let (v_t, v_dot) = flown.velocity();
        let place = Place::from_velocity(self.track.at(t), v_t, v_dot);
        Kinematics::new(place, Stance::from_euler(flown.roll, flown.climb, flown.heading))
    }

    fn joints(&self) -> &[f64] {
        &self.joints
    }

    fn duration(&self) -> Option<f64> {
        self.joints.last().copied()
    }

    fn fastest(&self, t: f64) -> f64 {
        piece(&self.pieces, t).fastest()
    }
}
