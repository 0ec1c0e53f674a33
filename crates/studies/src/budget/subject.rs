//! What a budget is about: the errors that its pictures, the order of its summary and its first remark are of.

use std::f64::consts::PI;

use nalgebra::Matrix2;

use super::Contribution;
use super::radius::horizontal;
use super::report::{band, total};
use super::scene::Scene;
use super::source::Nine;
use crate::figure::Quantity;
use crate::scenario::{Expect, Required};

/// Speed below which the base of an alignment stands, m/s.
const STANDS: f64 = 1.0;

/// The errors that matter, the first of them the one that leads: what the requirement limits, in its order; without one the heading
/// of an alignment at rest (a filter on a base that stands), else the horizontal position; then what is expected.
///
/// The horizontal position of an alignment at rest is that of its measurements, and is left out unless it is named. Errors that
/// are nowhere, such as those of a channel that is held, are left out as well.
pub fn subjects(scene: &Scene, expected: &[Expect], contributions: &[Contribution]) -> Vec<Required> {
    let mut all: Vec<Required> = Vec::new();
    if let Some(requirement) = &scene.study.requirement {
        all.extend(requirement.limits.iter().map(|(of, _)| *of));
    }
    let stands = scene.states.iter().all(|pva| pva.v_t.norm() < STANDS);
    all.push(if scene.study.filter.is_some() && stands { Required::Heading } else { Required::Horizontal });
    all.extend(expected.iter().filter_map(|e| named(&e.quantity)));
    let lead = all[0];
    let mut subjects: Vec<Required> = Vec::new();
    for of in all {
        let there = total(contributions).iter().any(|p| size(of, p) > 0.0);
        if there && !subjects.contains(&of) {
            subjects.push(of);
        }
    }
    if subjects.is_empty() {
        subjects.push(lead);
    }
    subjects
}

/// The errors that a column of `budget.csv` is of.
fn named(column: &str) -> Option<Required> {
    match column {
        "dn_m" | "de_m" | "horizontal_m" | "cep_m" | "r95_m" | "share_ratio" => Some(Required::Horizontal),
        "dd_m" => Some(Required::Down),
        "dv_n_mps" | "dv_e_mps" => Some(Required::Velocity),
        "phi_n_rad" | "phi_e_rad" => Some(Required::Tilt),
        "phi_d_rad" | "heading_share_ratio" => Some(Required::Heading),
        _ => None,
    }
}

/// The covariance of these errors in the plane; those along a line with nothing across it.
pub fn plane(of: Required, p: &Nine) -> Matrix2<f64> {
    let block = |k: usize| p.fixed_view::<2, 2>(k, k).into_owned();
    let line = |k: usize| Matrix2::from_diagonal(&[p[(k, k)], 0.0].into());
    match of {
        Required::Horizontal => horizontal(p),
        Required::Velocity => block(3),
        Required::Tilt => block(6),
        Required::Down => line(2),
        Required::Heading => line(8),
    }
}

/// Standard deviation: in the plane the root of the sum of both variances.
pub fn size(of: Required, p: &Nine) -> f64 {
    plane(of, p).trace().max(0.0).sqrt()
}

/// Part of the total variance; zero where there is none.
pub fn share(of: Required, p: &Nine, total: &Nine) -> f64 {
    let whole = plane(of, total).trace();
    if whole > 0.0 { plane(of, p).trace().max(0.0) / whole } else { 0.0 }
}

/// Ends of the 99 % confidence interval of the size, from a mean square `p` over so many runs.
pub fn interval(of: Required, p: &Nine, runs: u64) -> [f64; 2] {
    let [low, high] = band(freedom(of, p, runs));
    [size(of, p) / high.sqrt(), size(of, p) / low.sqrt()]
}

/// Normal errors of one dimension that scatter about their mean square as much as these: as many as there are runs along a
/// line, up to twice as many in the plane (Satterthwaite, Biometrics Bulletin 2, 1946).
fn freedom(of: Required, p: &Nine, runs: u64) -> u64 {
    let p = plane(of, p);
    let squares = (p * p).trace();
    if squares > 0.0 { (runs as f64 * p.trace() * p.trace() / squares).round() as u64 } else { runs }
}

/// What these errors are measured in.
pub fn quantity(of: Required) -> Quantity {
    match of {
        Required::Horizontal | Required::Down => Quantity::Length,
        Required::Velocity => Quantity::Velocity,
        Required::Tilt | Required::Heading => Quantity::Angle,
    }
}

/// In words.
pub fn words(of: Required) -> &'static str {
    match of {
        Required::Horizontal => "horizontal position",
        Required::Down => "height",
        Required::Velocity => "horizontal velocity",
        Required::Tilt => "tilt",
        Required::Heading => "heading",
    }
}

/// The unit that a reader of a summary expects.
pub struct Unit {
    /// As written behind a number.
    pub symbol: &'static str,
    /// Shown number per SI number.
    pub per_si: f64,
}

/// Metres, metres per second, minutes of arc.
pub fn unit(of: Required) -> Unit {
    match quantity(of) {
        Quantity::Velocity => Unit { symbol: "m/s", per_si: 1.0 },
        Quantity::Angle => Unit { symbol: "arcmin", per_si: 10_800.0 / PI },
        _ => Unit { symbol: "m", per_si: 1.0 },
    }
}

/// The unit of a picture whose largest number is `largest` (SI): symbol, shown number per SI number. Angles are in minutes of arc
/// whatever their size, as in the summary.
pub fn shown(of: Required, largest: f64) -> (&'static str, f64) {
    match quantity(of) {
        Quantity::Angle => (unit(of).symbol, unit(of).per_si),
        other => {
            let shown = other.shown(largest);
            (shown.symbol, shown.per_si)
        }
    }
}

/// A number (SI) in the unit that a reader expects, with that.
pub fn written(of: Required, x: f64) -> String {
    let unit = unit(of);
    format!("{:.4} {}", x * unit.per_si, unit.symbol)
}
