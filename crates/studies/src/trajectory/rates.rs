//! Increments from instantaneous rates.

use schuler_frames::{B, Vec3};
use schuler_strapdown::Increments;

/// Weights of the samples before, at the begin, at the end and after an interval.
const INSIDE: [f64; 4] = [-1.0 / 24.0, 13.0 / 24.0, 13.0 / 24.0, -1.0 / 24.0];
/// Of the four samples that begin with the interval.
const FIRST: [f64; 4] = [9.0 / 24.0, 19.0 / 24.0, -5.0 / 24.0, 1.0 / 24.0];
/// Of the four samples that end with it.
const LAST: [f64; 4] = [1.0 / 24.0, -5.0 / 24.0, 19.0 / 24.0, 9.0 / 24.0];

/// Increments over the intervals between `samples` of angular rate (rad/s) and specific force (m/s²) that are taken at
/// one time each, every `dt` (s): the integral of the cubic through the four samples about each interval. One less than samples, none
/// from fewer than four.
///
/// A sine of angular frequency omega is integrated with a relative error of 11/720 (omega dt)⁴: 4e-6 for 2 Hz at
/// 100 Hz. The trapezium rule has (omega dt)²/12, 1e-3, and with an angle in phase to a force that becomes a drift.
pub fn increments_of_rates(samples: &[[Vec3<B>; 2]], dt: f64) -> Vec<Increments> {
    let windows = samples.len().saturating_sub(3);
    let intervals = if windows == 0 { 0 } else { samples.len() - 1 };
    let of = |k: usize| {
        // The window of four whose middle the interval is, as far as there is one.
        let begin = k.saturating_sub(1).min(windows - 1);
        let weights = match k - begin {
            0 => FIRST,
            1 => INSIDE,
            _ => LAST,
        };
        let mut sums = [Vec3::ZERO; 2];
        for (sample, weight) in samples[begin..begin + 4].iter().zip(weights) {
            for (sum, value) in sums.iter_mut().zip(sample) {
                *sum += *value * (weight * dt);
            }
        }
        Increments { dtheta: sums[0], dv: sums[1] }
    };
    (0..intervals).map(of).collect()
}
