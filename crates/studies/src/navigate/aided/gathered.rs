//! Increments of several samples as one step of the filter's transition.

use schuler_frames::{B, Vec3};
use schuler_strapdown::Increments;

/// Length (s) and turn (rad) up to which samples are one step. The transition takes a step's attitude half way; with the turn
/// within the step taken to first order below, what is left out is (turn)²/24 of the force, 1e-4, and less of all else.
const LONGEST: f64 = 0.1;
const TURN: f64 = 0.05;

/// Samples gathered so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gathered {
    theta: Vec3<B>,
    /// Velocity increments along the axes at the begin, to first order in the turn.
    dv: Vec3<B>,
    /// Length so far, s.
    pub t: f64,
}

impl Gathered {
    #[inline]
    pub fn push(&mut self, sample: &Increments, dt: f64) {
        self.dv += sample.dv + (self.theta + sample.dtheta * 0.5).cross(sample.dv);
        self.theta += sample.dtheta;
        self.t += dt;
    }

    /// Whether the next sample, as long as this one of `dt` (s), would be too much.
    #[inline]
    pub fn is_full(&self, dt: f64) -> bool {
        self.t > LONGEST - 0.5 * dt || self.theta.norm_squared() > TURN * TURN
    }

    /// The increments, of velocity along the axes half way, and their length (s). Begins anew.
    pub fn take(&mut self) -> (Increments, f64) {
        let Gathered { theta, dv, t } = std::mem::take(self);
        (Increments { dtheta: theta, dv: dv - theta.cross(dv) * 0.5 }, t)
    }
}
