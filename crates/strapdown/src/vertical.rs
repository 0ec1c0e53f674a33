//! What is done about the unstable vertical channel.

use schuler_frames::Real;

use crate::Pva;

/// The vertical channel. Left alone it diverges by e every 570 s, so that a choice must be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Vertical {
    /// As the equations are.
    Free,
    /// Height and vertical velocity stay as they start; the vertical accelerometer is not used.
    Held,
    /// A loop that feeds back the difference to a reference height.
    Damped(BaroLoop),
}

impl Vertical {
    /// Rate at which height is taken back that the velocity of a navigator at `pva` alone would bring it, m/s.
    pub(crate) fn taken_back(&self, pva: &Pva) -> f64 {
        match self {
            Vertical::Free => 0.0,
            Vertical::Held => -pva.v_t[2],
            Vertical::Damped(baro) => baro.k1 * (pva.position.h - baro.height),
        }
    }
}

/// Gains of a baro-inertial loop, with up positive and d = h - h_reference:
/// `h' = v_up - k1 d`, `v_up' = (as computed) - k2 d - a`, `a' = k3 d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaroLoop {
    /// Gain on height, 1/s.
    pub k1: f64,
    /// Gain on vertical velocity, 1/s².
    pub k2: f64,
    /// Gain on the estimated vertical acceleration error, 1/s³; zero in a second-order loop.
    pub k3: f64,
    /// The reference (barometric) height, m.
    pub height: f64,
}

impl BaroLoop {
    /// Second-order loop with both poles at `-1/tau`. `instability` is -dg/dh (2 g/R, 1/s²), which k2 must
    /// overcome first. A constant accelerometer error b leaves the height wrong by `b tau²`.
    pub fn second_order(tau: f64, instability: f64, height: f64) -> Self {
        BaroLoop { k1: 2.0 / tau, k2: 1.0 / (tau * tau) + instability, k3: 0.0, height }
    }

    /// Third-order loop with its three poles at `-1/tau`: a constant accelerometer error leaves no height error.
    pub fn third_order(tau: f64, instability: f64, height: f64) -> Self {
        let per_tau = 1.0 / tau;
        BaroLoop {
            k1: 3.0 * per_tau,
            k2: 3.0 * per_tau * per_tau + instability,
            k3: per_tau * per_tau * per_tau,
            height,
        }
    }
}

/// What a loop does in one step, at the middle of it.
pub(crate) struct Feedback<S> {
    /// Change of height taken back, m.
    pub back: S,
    /// Acceleration fed back, down, m/s².
    pub down: S,
    /// The loop's vertical acceleration error at the end, up, m/s².
    pub baro_a: S,
}

impl BaroLoop {
    /// The feedback over `dt` (s) for an excess of height `d` (m) in the middle of the step as it would be without the
    /// loop, and for the loop's own `baro_a` (m/s²) at the start: second order in the step.
    #[inline(always)]
    pub(crate) fn at_middle<S: Real>(&self, d: S, baro_a: S, dt: f64) -> Feedback<S> {
        let half = 0.5 * dt;
        let d = d - d * (self.k1 * half);
        let middle = baro_a + d * (self.k3 * half);
        Feedback { back: d * (self.k1 * dt), down: d * self.k2 + middle, baro_a: baro_a + d * (self.k3 * dt) }
    }
}
