//! Earth rotation angle of a `hifitime` epoch: an edge, for the start of a scenario, never in a loop.

use crate::earth_rotation_angle;

/// Earth rotation angle (rad, 0 to 2π) at an epoch of any time scale, taking UT1 = UTC.
///
/// UT1 - UTC stays below 0.9 s, so the angle is right within 6.6e-5 rad. Only where the x axis of i points
/// among the stars depends on it; positions relative to the Earth do not.
pub fn earth_rotation_angle_at(epoch: hifitime::Epoch) -> f64 {
    const DAY: i128 = 86_400 * 1_000_000_000;
    let ns = epoch.to_jde_utc_duration().total_nanoseconds();
    earth_rotation_angle(ns.div_euclid(DAY) as f64, ns.rem_euclid(DAY) as f64 / DAY as f64)
}
