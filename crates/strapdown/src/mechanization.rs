//! What every navigator can do, whatever frame it computes in.

use crate::{BodyMotion, Increments, Pva};

/// A strapdown navigator.
///
/// Navigators in different frames solve the same equations of motion: given the same increments and
/// [`Gravity`](schuler_frames::Gravity) they give the same position, velocity and attitude to the error of their step.
pub trait Mechanization {
    /// One step over the interval `dt` (s) in which the body moved by `motion`.
    fn advance(&mut self, motion: &BodyMotion, dt: f64);

    /// Position, velocity and attitude now.
    fn pva(&self) -> Pva;

    /// One step over the interval `dt` (s) that the `increments` of one sample cover
    /// ([`Coning::One`](crate::Coning::One)).
    #[inline]
    fn step(&mut self, increments: &Increments, dt: f64) {
        self.advance(&BodyMotion::of(increments), dt);
    }
}
