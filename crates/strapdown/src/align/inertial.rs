//! Alignment in inertial space: what the base rocks, the gyros take away; what is left of gravity turns with the Earth.

use core::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix3, Vector3};
use schuler_frames::{B, Dcm, Frame, Geodetic, Gravity, I, Rot, T, Vec3, c_ie, wgs84};

use super::closest_rotation;
use super::triad::axes;
use crate::BodyMotion;
use crate::kernel::{Quaternion, turn};

/// Body axes as they were at the start: an inertial frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct B0;

impl Frame for B0 {
    const NAME: &'static str = "b0";
}

/// Which vectors are laid upon each other, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solution {
    /// TRIAD of the velocity that the specific force integrates to, at the end (trusted first) and at the split.
    Velocity,
    /// The same with the position, the integral of that velocity: noise and shaking count less, bias more.
    Position,
    /// All velocities from the start to the end together, by least squares (q-method). Source: Wu, Wu, Hu and Hu,
    /// Optimization-based alignment for inertial navigation systems: theory and algorithm, Aerospace Science and
    /// Technology 15 (2011).
    Optimal,
}

/// Why the motion so far gives no attitude.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InertialError {
    /// The second vector is not there yet.
    #[error(
        "alignment in inertial space needs more than the {split} s to its first vector, but has {time} s"
    )]
    TooShort {
        /// Time of the first vector, s.
        split: f64,
        /// Time so far, s.
        time: f64,
    },
    /// Gravity did not turn in inertial space: at a pole, or without gravity.
    #[error(
        "alignment in inertial space needs gravity to turn with the Earth, but the sine between its vectors is {sine:.2e}"
    )]
    NoHeading {
        /// Sine of the angle between the two vectors.
        sine: f64,
    },
}

/// Collects the motion of a base that stays where it is, however it rocks.
///
/// The gyros give the attitude against the body axes b0 of the start; in these inertial axes the specific force of a
/// place on the Earth goes round a cone about the polar axis with the Earth rate Ω. What it integrates to is known at
/// a latitude L,
///
/// ```text
/// V(t) = g [cos L sin(Ω t)/Ω, cos L (1 - cos(Ω t))/Ω, sin L t]
/// ```
///
/// in axes of the Earth frozen at the start, x at the meridian of the place; the rotation that lays the one upon the other
/// completes the attitude. Rocking integrates to nothing, so that what would spoil means of rate and force does no harm.
/// The angle by which gravity turns, 15 deg cos L an hour, tells north, so that constant sensor errors turn the heading as
/// in [`Limits::bias`](super::Limits::bias).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialFrame {
    split: f64,
    t: f64,
    c_b0b: Quaternion<f64>,
    now: Vectors,
    first: Option<(f64, Vectors)>,
    least_squares: LeastSquares,
}

/// Integrals of the specific force in b0: velocity (m/s) and position (m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Vectors {
    v: Vec3<B0>,
    p: Vec3<B0>,
}

/// Sums over time of products of reference and measured velocity, apart for the parts of the reference that go with cos
/// L and with sin L.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct LeastSquares {
    polar: Matrix3<f64>,
    equatorial: Matrix3<f64>,
    polar_squares: f64,
    equatorial_squares: f64,
}

impl InertialFrame {
    /// Nothing collected yet; the first of the two vectors of [`Solution::Velocity`] and [`Solution::Position`] is that of
    /// the time `split` (s): about half of the alignment.
    pub fn new(split: f64) -> Self {
        InertialFrame {
            split,
            t: 0.0,
            c_b0b: Quaternion::new([1.0, 0.0, 0.0, 0.0]),
            now: Vectors::default(),
            first: None,
            least_squares: LeastSquares::default(),
        }
    }

    /// One step over `dt` (s) in which the body moved by `motion`.
    pub fn advance(&mut self, motion: &BodyMotion, dt: f64) {
        let dv = self.c_b0b.rot::<B0, B>() * motion.dv;
        self.now.p += (self.now.v + dv * 0.5) * dt;
        self.now.v += dv;
        self.c_b0b.turn_right(turn(motion.sigma));
        self.t += dt;
        if self.first.is_none() && self.t >= self.split - 0.5 * dt {
            self.first = Some((self.t, self.now));
        }
        let (equatorial, polar) = velocity(self.t);
        let v = self.now.v.as_nalgebra().transpose();
        let sums = &mut self.least_squares;
        sums.equatorial += equatorial * v;
        sums.polar += polar * v;
        sums.equatorial_squares += equatorial.norm_squared();
        sums.polar_squares += polar.norm_squared();
    }

    /// Time collected, s.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// C_b^t now, for a base at `position`.
    ///
    /// Of the position latitude and height enter, of `gravity` its direction.
    ///
    /// # Errors
    /// [`InertialError`] if there is no second vector yet or gravity did not turn.
    pub fn attitude(
        &self,
        solution: Solution,
        position: Geodetic,
        gravity: Gravity,
    ) -> Result<Rot<T, B>, InertialError> {
        // Up in the plane of the meridian: where the plumb line leans, a little beside the latitude.
        let meridian = Geodetic { lon: 0.0, ..position };
        let c_et = meridian.c_et();
        let up = c_et * -gravity.gravity_t(position);
        let (s, c) = (up[2] / up.norm(), up[0] / up.norm());
        let c_i_b0 = self.start(solution, s, c)?;
        let c_ti = (c_ie(wgs84::OMEGA * self.t) * c_et).inverse();
        Ok((c_ti * c_i_b0 * self.c_b0b.rot::<B0, B>()).normalized())
    }

    /// C_b0^i, i being the Earth's axes at the start with x at the meridian of the place.
    fn start(&self, solution: Solution, s: f64, c: f64) -> Result<Rot<I, B0>, InertialError> {
        let too_short = InertialError::TooShort { split: self.split, time: self.t };
        let (t1, first) = self.first.ok_or(too_short)?;
        if t1 >= self.t {
            return Err(too_short);
        }
        let at = |parts: (Vector3<f64>, Vector3<f64>)| Vec3::<I>::claim((parts.0 * c + parts.1 * s).into());
        let (reference, measured) = match solution {
            Solution::Optimal | Solution::Velocity => {
                ((at(velocity(self.t)), at(velocity(t1))), (self.now.v, first.v))
            }
            Solution::Position => ((at(way(self.t)), at(way(t1))), (self.now.p, first.p)),
        };
        let no_heading = |sine| InertialError::NoHeading { sine };
        let reference = axes(reference.0, reference.1).map_err(no_heading)?;
        let measured = axes(measured.0, measured.1).map_err(no_heading)?;
        Ok(match solution {
            Solution::Optimal => {
                closest_rotation(&(self.least_squares.equatorial * c + self.least_squares.polar * s)).0
            }
            _ => {
                let to_triad: Dcm<I, B0> = Dcm::claim(measured);
                Rot::from_dcm(Dcm::<I, I>::claim(reference).transpose() * to_triad)
            }
        })
    }

    /// The latitude (rad) that fits the cone best, where nobody knows it: the one at which the least squares of
    /// [`Solution::Optimal`], with the size of gravity free, are smallest.
    ///
    /// It comes from the angle by which gravity turned, Ω t cos L, so that near the equator little of it is seen.
    ///
    /// # Errors
    /// As [`InertialFrame::attitude`].
    pub fn latitude(&self) -> Result<f64, InertialError> {
        // What the least squares leave is sum |V|² - lambda² / sum |reference|²: half the logarithm of its second part, and the
        // slope of that, which tells the top more sharply than the height does.
        let fit = |lat: f64| {
            let (s, c) = libm::sincos(lat);
            let LeastSquares { polar, equatorial, polar_squares, equatorial_squares } = &self.least_squares;
            let (rotation, lambda) = closest_rotation::<I, B0>(&(equatorial * c + polar * s));
            let squares = equatorial_squares * c * c + polar_squares * s * s;
            let turned = rotation.as_dcm().as_nalgebra();
            let slope = turned.dot(&(polar * c - equatorial * s)) / lambda
                - s * c * (polar_squares - equatorial_squares) / squares;
            (libm::log(lambda) - 0.5 * libm::log(squares), slope)
        };
        // One best whole degree, then where the slope changes its sign.
        let degree = FRAC_PI_2 / 90.0;
        let mut best = (0.0, f64::NEG_INFINITY);
        for k in -89..90 {
            let lat = f64::from(k) * degree;
            let (height, _) = fit(lat);
            if height > best.1 {
                best = (lat, height);
            }
        }
        let (mut low, mut high) = (best.0 - degree, best.0 + degree);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if fit(middle).1 > 0.0 { low = middle } else { high = middle }
        }
        let lat = 0.5 * (low + high);
        let (s, c) = libm::sincos(lat);
        self.start(Solution::Optimal, s, c).map(|_| lat)
    }
}

/// Integral of the unit vector up in inertial axes, apart for cos L and sin L.
fn velocity(t: f64) -> (Vector3<f64>, Vector3<f64>) {
    let o = wgs84::OMEGA;
    let (s, c) = libm::sincos(0.5 * o * t);
    (Vector3::new(2.0 * s * c / o, 2.0 * s * s / o, 0.0), Vector3::new(0.0, 0.0, t))
}

/// Integral of [`velocity`].
fn way(t: f64) -> (Vector3<f64>, Vector3<f64>) {
    let o = wgs84::OMEGA;
    let (s, c) = libm::sincos(0.5 * o * t);
    let x = 2.0 * s * s / (o * o);
    (Vector3::new(x, (o * t - 2.0 * s * c) / (o * o), 0.0), Vector3::new(0.0, 0.0, 0.5 * t * t))
}
