//! The radius that holds a share of plane normal errors, and what it owes to each source.

use std::f64::consts::PI;

use nalgebra::{Matrix2, Vector2};

use super::source::Nine;

/// Directions of the quadrature over half a turn.
const DIRECTIONS: usize = 720;

/// The radius that holds the share `probability` (between 0 and 1) of the errors (x, y) of covariance `p`, to rounding; zero
/// where there are none.
///
/// With x = P^½ rho (cos a, sin a), rho of the Rayleigh distribution and a uniform, r² = rho² q(a), q = u' P u along the unit
/// vector u(a): the error is longer than r with probability exp(-r²/(2 q)), averaged over all directions,
///
/// ```text
/// P(> r) = 1/(2 pi) ∫ exp(-r²/(2 u(a)' P u(a))) da
/// ```
///
/// by the midpoint rule, which on a whole period converges faster than any power; q = 0 (errors along one line only)
/// needs no special case. Its ends: exp(-r²/(2 s²)) for a circle, erfc(r/(s √2)) for a line.
pub fn radius(p: &Matrix2<f64>, probability: f64) -> f64 {
    let squares: Vec<f64> = directions().map(|u| (u.transpose() * p * u)[0]).filter(|q| *q > 0.0).collect();
    let largest = squares.iter().copied().fold(0.0, f64::max);
    if largest <= 0.0 {
        return 0.0;
    }
    // How much more than wanted is beyond r, and minus its slope.
    let excess = |r: f64| {
        let (mut value, mut slope) = (0.0, 0.0);
        for q in &squares {
            let e = (-0.5 * r * r / q).exp();
            value += e;
            slope += e * r / q;
        }
        let n = DIRECTIONS as f64;
        (value / n - (1.0 - probability), slope / n)
    };
    // Newton's steps within a bracket; at its upper end each direction alone leaves no more than is wanted.
    let (mut low, mut high) = (0.0, (-2.0 * largest * (1.0 - probability).ln()).sqrt());
    let mut r = 0.5 * high;
    for _ in 0..100 {
        let (value, slope) = excess(r);
        if value > 0.0 {
            low = r
        } else {
            high = r
        }
        let newton = r + value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - r).abs() <= 4.0 * f64::EPSILON * r {
            return next;
        }
        r = next;
    }
    r
}

/// How the radius `r` of a fixed probability grows with the relative size of a part `part` of the covariance `p`, m: with
/// P = rest + a² part at a = 1. Over all parts of a whole the derivatives sum to r, which is of first degree in the sizes.
pub fn derivative(p: &Matrix2<f64>, part: &Matrix2<f64>, r: f64) -> f64 {
    let weight = |q: f64| (-0.5 * r * r / q).exp() / (q * q);
    let by_part = mean(p, |q, u| if q > 0.0 { weight(q) * r * (u.transpose() * part * u)[0] } else { 0.0 });
    let by_radius = mean(p, |q, _| if q > 0.0 { weight(q) * q } else { 0.0 });
    if by_radius > 0.0 { by_part / by_radius } else { 0.0 }
}

/// By what factor the part may grow until the radius of `probability` is `limit`: infinite for a part that does nothing,
/// zero where the rest alone is beyond the limit.
pub fn may_grow(p: &Matrix2<f64>, part: &Matrix2<f64>, probability: f64, limit: f64) -> f64 {
    let rest = p - part;
    let at = |a: f64| radius(&(rest + part * (a * a)), probability);
    if part.trace() <= 0.0 {
        return if radius(p, probability) <= limit { f64::INFINITY } else { 0.0 };
    }
    if at(0.0) >= limit {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while at(high) < limit {
        low = high;
        high *= 2.0;
        if high > 1e9 {
            return f64::INFINITY;
        }
    }
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if at(middle) < limit { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// North and east of a covariance.
pub fn horizontal(p: &Nine) -> Matrix2<f64> {
    p.fixed_view::<2, 2>(0, 0).into_owned()
}

/// Mean over all directions u of `f(u' P u, u)`.
fn mean(p: &Matrix2<f64>, f: impl Fn(f64, Vector2<f64>) -> f64) -> f64 {
    directions().map(|u| f((u.transpose() * p * u)[0], u)).sum::<f64>() / DIRECTIONS as f64
}

/// Unit vectors over half a turn; the other half gives the same.
fn directions() -> impl Iterator<Item = Vector2<f64>> {
    (0..DIRECTIONS).map(|k| {
        let (s, c) = libm::sincos(PI * (k as f64 + 0.5) / DIRECTIONS as f64);
        Vector2::new(c, s)
    })
}
