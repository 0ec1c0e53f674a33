//! From 0 to 1 with derivatives that vanish at both ends.

use super::Jet;

/// The quintic from 0 to 1 whose first and second derivatives vanish at both ends, at the part `u` (0 to 1,
/// held beyond) of a passage that takes `duration` (s).
///
/// s = 10 u³ - 15 u⁴ + 6 u⁵; its steepest slope is 15/8 in the middle.
pub fn step(u: f64, duration: f64) -> Jet {
    if u <= 0.0 {
        return Jet::constant(0.0);
    }
    if u >= 1.0 {
        return Jet::constant(1.0);
    }
    let per = 1.0 / duration;
    let v = 1.0 - u;
    Jet([
        u * u * u * (10.0 - u * (15.0 - 6.0 * u)),
        30.0 * u * u * v * v * per,
        30.0 * u * v * (v - u) * per * per,
    ])
}

/// Steepest slope of [`step`] a unit of the part.
pub const STEEPEST: f64 = 1.875;

/// Angular frequency that stands for a passage of `duration` (s) in [`Trajectory::fastest`](super::Trajectory::fastest).
pub fn frequency(duration: f64) -> f64 {
    2.0 * std::f64::consts::PI / duration
}
