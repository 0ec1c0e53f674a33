//! Position from a velocity that is given as a function of time.

use std::f64::consts::PI;

use schuler_frames::{Geodetic, T, Vec3, wgs84};

use super::Impossible;

/// Nodes a step.
const NODES: usize = 10;

/// Latitude at which a track ends: 11 km from the pole, where north still turns slowly enough.
const HIGHEST: f64 = 1.569;

/// How far a track goes on beyond its ends, s.
const BEYOND: f64 = 2.0;

/// Position along a velocity v_t(t): piece by piece a polynomial in time, which solves
///
/// ```text
/// dL/dt = v_n / (R_M + h),   dlon/dt = v_e / ((R_N + h) cos L),   dh/dt = -v_d
/// ```
///
/// in ten nodes of Gauss and Legendre. Pieces are halved until the polynomial has converged to rounding, so the
/// position is a pure function of time whose derivative is the velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    steps: Vec<Step>,
}

#[derive(Clone, Debug, PartialEq)]
struct Step {
    begin: f64,
    middle: f64,
    /// 2 / duration.
    per: f64,
    start: Geodetic,
    /// Way since the start in latitude, longitude (rad), height (m): powers of the time from the middle, -1 to 1.
    way: [[f64; NODES + 1]; 3],
}

/// Nodes and what turns values in them into a polynomial.
struct Rule {
    nodes: [f64; NODES],
    /// Values in the nodes to coefficients of Legendre polynomials.
    legendre: [[f64; NODES]; NODES],
    /// Coefficients of Legendre polynomials to powers of the integral from -1.
    integral: [[f64; NODES + 1]; NODES],
}

impl Track {
    /// From `start` along `velocity` (time to v_t, m/s), which is smooth between the times of `joints` (increasing, two or more).
    /// It goes on for a few seconds before the first and after the last.
    ///
    /// # Errors
    /// The track comes to a pole.
    pub fn new(
        start: Geodetic,
        joints: &[f64],
        velocity: impl Fn(f64) -> Vec3<T>,
    ) -> Result<Self, Impossible> {
        let rule = Rule::new();
        let [Some(&first), Some(&last)] = [joints.first(), joints.last()] else {
            return Ok(Track { steps: vec![rule.step(start, 0.0, BEYOND, &velocity).0] });
        };
        let mut steps =
            vec![Step { begin: f64::NEG_INFINITY, ..rule.step(start, first, first - BEYOND, &velocity).0 }];
        let mut position = start;
        for pair in joints.windows(2) {
            // Parts that are still to be gone, the next one last.
            let mut parts = vec![(pair[0], pair[1])];
            while let Some((begin, end)) = parts.pop() {
                let (step, converged) = rule.step(position, begin, end, &velocity);
                let middle = 0.5 * (begin + end);
                if !converged && end - begin > 1e-3 {
                    parts.extend([(middle, end), (begin, middle)]);
                    continue;
                }
                position = step.at(end);
                if position.lat.abs() > HIGHEST || position.lat.is_nan() {
                    return Err(Impossible::new(
                        format!("the track comes to a pole at {end:.1} s"),
                        "a track that stays 11 km from the poles; a `great_circle` crosses them",
                    ));
                }
                steps.push(step);
            }
        }
        steps.push(rule.step(position, last, last + BEYOND, &velocity).0);
        Ok(Track { steps })
    }

    /// The position at the time `t` (s).
    pub fn at(&self, t: f64) -> Geodetic {
        let begun = self.steps.partition_point(|step| step.begin <= t);
        self.steps[begun.saturating_sub(1)].at(t)
    }
}

impl Step {
    fn at(&self, t: f64) -> Geodetic {
        let x = (t - self.middle) * self.per;
        let [lat, lon, h] =
            self.way.each_ref().map(|powers| powers.iter().rev().fold(0.0, |sum, c| sum * x + c));
        Geodetic::new(self.start.lat + lat, self.start.lon + lon, self.start.h + h)
    }
}

/// Rates of latitude, longitude and height.
fn rates(position: Geodetic, v: Vec3<T>) -> [f64; 3] {
    let (s, c) = libm::sincos(position.lat);
    let (r_m, r_n) = (wgs84::r_m(s) + position.h, wgs84::r_n(s) + position.h);
    [v[0] / r_m, v[1] / (r_n * c), -v[2]]
}

impl Rule {
    fn new() -> Self {
        let nodes = std::array::from_fn(|k| {
            // Newton's iteration on the polynomial of degree NODES from the usual first guess.
            let mut x = -libm::cos(PI * (k as f64 + 0.75) / (NODES as f64 + 0.5));
            for _ in 0..6 {
                let [below, p] = last_two(x);
                let slope = NODES as f64 * (x * p - below) / (x * x - 1.0);
                x -= p / slope;
            }
            x
        });
        let legendre = std::array::from_fn(|degree| {
            nodes.map(|x| {
                let [below, p] = last_two(x);
                let slope = NODES as f64 * (x * p - below) / (x * x - 1.0);
                let weight = 2.0 / ((1.0 - x * x) * slope * slope);
                (degree as f64 + 0.5) * weight * values(x)[degree]
            })
        });
        let powers = legendre_powers();
        let integral = std::array::from_fn(|degree| {
            // The integral of P_k is (P_(k+1) - P_(k-1)) / (2k + 1), of P_0 it is P_1 + P_0: zero at -1.
            let below = if degree == 0 { powers[0].map(|c| -c) } else { powers[degree - 1] };
            std::array::from_fn(|k| (powers[degree + 1][k] - below[k]) / (2.0 * degree as f64 + 1.0))
        });
        Rule { nodes, legendre, integral }
    }

    /// One step from `start`, and whether its polynomial has converged.
    fn step(&self, start: Geodetic, begin: f64, end: f64, velocity: impl Fn(f64) -> Vec3<T>) -> (Step, bool) {
        let (middle, half) = (0.5 * (begin + end), 0.5 * (end - begin));
        let v = self.nodes.map(|x| velocity(middle + half * x));
        let mut step = Step { begin, middle, per: 1.0 / half, start, way: [[0.0; NODES + 1]; 3] };
        let mut tail = [0f64; 3];
        // Picard's iteration: the radii change by 1e-7 of what the position does, so a round gives seven digits.
        for _ in 0..5 {
            let mut at = [[0.0; NODES]; 3];
            for (k, x) in self.nodes.iter().enumerate() {
                let rates = rates(step.at(middle + half * x), v[k]);
                for (at, rate) in at.iter_mut().zip(rates) {
                    at[k] = rate * half;
                }
            }
            for ((way, at), tail) in step.way.iter_mut().zip(at).zip(&mut tail) {
                let coefficients: [f64; NODES] =
                    self.legendre.map(|row| row.iter().zip(at).map(|(m, rate)| m * rate).sum());
                *way = std::array::from_fn(|power| {
                    coefficients.iter().zip(&self.integral).map(|(c, integral)| c * integral[power]).sum()
                });
                *tail = coefficients[NODES - 1].abs().max(coefficients[NODES - 2].abs());
            }
        }
        let gone = v.iter().map(|v| v.norm()).fold(0.0, f64::max) * 2.0 * half;
        let metres = [tail[0] * wgs84::A, tail[1] * wgs84::A, tail[2]];
        let converged = gone < 0.2 * wgs84::A && metres.iter().all(|tail| *tail < 1e-11 + 1e-15 * gone);
        (step, converged)
    }
}

/// Values of the Legendre polynomials 0 to NODES.
fn values(x: f64) -> [f64; NODES + 1] {
    let mut p = [1.0; NODES + 1];
    p[1] = x;
    for k in 1..NODES {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

fn last_two(x: f64) -> [f64; 2] {
    let p = values(x);
    [p[NODES - 1], p[NODES]]
}

/// Powers of the Legendre polynomials 0 to NODES.
fn legendre_powers() -> [[f64; NODES + 1]; NODES + 1] {
    let mut p = [[0.0; NODES + 1]; NODES + 1];
    (p[0][0], p[1][1]) = (1.0, 1.0);
    for k in 1..NODES {
        let n = k as f64;
        p[k + 1] = std::array::from_fn(|power| {
            let raised = if power == 0 { 0.0 } else { p[k][power - 1] };
            ((2.0 * n + 1.0) * raised - n * p[k - 1][power]) / (n + 1.0)
        });
    }
    p
}
