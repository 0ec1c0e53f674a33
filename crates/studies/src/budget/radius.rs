//! The radius that holds a share of normal errors in the plane or in space, and what it owes to each source.

use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::LazyLock;

use nalgebra::{Matrix2, Matrix3, Vector2};

use super::source::Nine;

/// Directions of the quadrature over half a turn.
const DIRECTIONS: usize = 720;

/// Directions over the quarter of a turn between two main axes.
const QUARTER: usize = 240;

/// Directions in space: along the longest axis, and about it over a quarter of a turn.
const ALONG: usize = 40;
const ABOUT: usize = 16;

/// Part of the largest variance below which one in space counts as none.
const FLAT: f64 = 1e-10;

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
/// by the midpoint rule between the main axes, which on a whole period converges faster than any power; q = 0 (errors
/// along one line only) needs no special case. Its ends: exp(-r²/(2 s²)) for a circle, erfc(r/(s √2)) for a line.
pub fn radius(p: &Matrix2<f64>, probability: f64) -> f64 {
    let main = p.symmetric_eigenvalues();
    let squares = (0..QUARTER).map(|k| {
        let (s, c) = libm::sincos(0.5 * PI * (k as f64 + 0.5) / QUARTER as f64);
        (main[0].max(0.0) * c * c + main[1].max(0.0) * s * s, 1.0 / QUARTER as f64)
    });
    // Beyond k standard deviations, and the slope.
    quantile(squares.collect(), probability, |k| {
        let e = (-0.5 * k * k).exp();
        (e, -k * e)
    })
}

/// The radius that holds the share `probability` of the errors (x, y, z) of covariance `p`: [`radius`] in space, where the
/// length is of the Maxwell distribution and directions are on a sphere. Good to 1e-7 of itself.
pub fn spherical(p: &Matrix3<f64>, probability: f64) -> f64 {
    let mut main = p.symmetric_eigenvalues();
    main.as_mut_slice().sort_by(|a, b| b.total_cmp(a));
    let [a, b, c] = main.data.0[0].map(|x| x.max(0.0));
    if c <= FLAT * a {
        return radius(&Matrix2::new(a, 0.0, 0.0, b), probability);
    }
    let mut squares = Vec::with_capacity(ALONG * ABOUT);
    for (z, weight) in NODES.iter() {
        for k in 0..ABOUT {
            let (s, cos) = libm::sincos(0.5 * PI * (k as f64 + 0.5) / ABOUT as f64);
            let across = b * cos * cos + c * s * s;
            squares.push((a * z * z + (1.0 - z * z) * across, weight / ABOUT as f64));
        }
    }
    quantile(squares, probability, |k| {
        let e = (2.0 / PI).sqrt() * (-0.5 * k * k).exp();
        (libm::erfc(k * FRAC_1_SQRT_2) + k * e, -k * k * e)
    })
}

/// Nodes and weights of Gauss and Legendre between 0 and 1: zeros of the polynomial by Newton's method.
static NODES: LazyLock<[(f64, f64); ALONG]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let n = ALONG as f64;
        let mut x = (PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..20 {
            let (mut before, mut now) = (1.0, x);
            for j in 2..=ALONG {
                let j = j as f64;
                (before, now) = (now, ((2.0 * j - 1.0) * x * now - (j - 1.0) * before) / j);
            }
            slope = n * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
});

/// The radius beyond which there is as much as wanted: variances along directions with their weights, and `tail` of the length
/// in standard deviations, what is beyond it and its slope.
fn quantile(squares: Vec<(f64, f64)>, probability: f64, tail: impl Fn(f64) -> (f64, f64)) -> f64 {
    let squares: Vec<(f64, f64)> =
        squares.into_iter().filter(|(q, _)| *q > 0.0).map(|(q, w)| (q.sqrt(), w)).collect();
    let largest = squares.iter().map(|(s, _)| *s).fold(0.0, f64::max);
    if largest <= 0.0 {
        return 0.0;
    }
    // How much more than wanted is beyond r, and minus its slope.
    let excess = |r: f64| {
        let (mut value, mut slope) = (0.0, 0.0);
        for (sigma, weight) in &squares {
            let (beyond, by) = tail(r / sigma);
            value += weight * beyond;
            slope -= weight * by / sigma;
        }
        (value - (1.0 - probability), slope)
    };
    // Newton's steps within a bracket.
    let (mut low, mut high) = (0.0, largest);
    while excess(high).0 > 0.0 {
        (low, high) = (high, 2.0 * high);
    }
    let mut r = 0.5 * (low + high);
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
    // The part alone is never larger than with the rest.
    let (mut low, mut high) = (0.0, limit / radius(part, probability));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at(middle) < limit { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// North and east of a covariance.
pub fn horizontal(p: &Nine) -> Matrix2<f64> {
    p.fixed_view::<2, 2>(0, 0).into_owned()
}

/// North, east and down of a covariance.
pub fn space(p: &Nine) -> Matrix3<f64> {
    p.fixed_view::<3, 3>(0, 0).into_owned()
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
