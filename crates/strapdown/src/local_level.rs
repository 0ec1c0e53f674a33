//! The local-level mechanization: geodetic position, velocity in t, attitude body to t.

use schuler_frames::earth::{omega_ie_t, transport};
use schuler_frames::{Geodetic, Gravity, Real, T, Vec3};

use crate::anchor::Anchor;
use crate::kernel::{Quaternion, small_turn, turn};
use crate::{BodyMotion, Increments, Mechanization, Pva, Vertical};

/// Age of the anchor at which it is moved along, s.
const ANCHOR_AGE: f64 = 0.5;

/// Local-level navigator, second order in the step.
///
/// Each step uses Earth rate, transport rate, gravity, Coriolis acceleration and radii at the middle
/// of the step. Products and sums alone do it: what else the Earth asks for stands as a series about an
/// anchor that follows twice a second. Made for steps that turn the body by less than 1 rad; poles
/// are outside (the local level frame has no north there).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalLevel<S = f64> {
    q_tb: Quaternion<S>,
    v_t: Vec3<T, S>,
    anchor: Anchor<S>,
    /// Way gone since the anchor: latitude, longitude (rad), height (m).
    way: [S; 3],
    /// Time since the anchor, s.
    age: f64,
    /// All acceleration that is not specific force, as the last step had it, m/s².
    a_free: Vec3<T, S>,
    /// Turn rate of t against i, as the last step had it, rad/s.
    omega_it: Vec3<T, S>,
    /// Vertical acceleration error as a third-order baro loop has it, up, m/s².
    baro_a: S,
    vertical: Vertical,
    gravity: Gravity,
}

impl LocalLevel {
    /// A navigator that starts at `pva`.
    pub fn new(pva: &Pva, gravity: Gravity, vertical: Vertical) -> Self {
        let anchor = Anchor::new(pva.position, gravity);
        let mut nav = LocalLevel {
            q_tb: Quaternion::new(pva.c_tb.as_quaternion()),
            v_t: pva.v_t,
            anchor,
            way: [0.0; 3],
            age: 0.0,
            a_free: Vec3::ZERO,
            omega_it: Vec3::ZERO,
            baro_a: 0.0,
            vertical,
            gravity,
        };
        // A step of no duration fills in rates and accelerations of the start.
        nav.advance_kernel(&BodyMotion { sigma: Vec3::ZERO, dv: Vec3::ZERO }, 0.0);
        nav
    }

    /// Position, velocity and attitude now.
    pub fn pva(&self) -> Pva {
        let Anchor { lat, lon, h, .. } = self.anchor;
        Pva {
            position: Geodetic::new(
                lat.value() + self.way[0],
                lon.value() + self.way[1],
                h.value() + self.way[2],
            ),
            v_t: self.v_t,
            c_tb: self.q_tb.rot(),
        }
    }

    /// [`Mechanization::step`], to be had without the trait.
    #[inline]
    pub fn step(&mut self, increments: &Increments, dt: f64) {
        self.advance(&BodyMotion::of(increments), dt);
    }
}

impl Mechanization for LocalLevel {
    #[inline]
    fn advance(&mut self, motion: &BodyMotion, dt: f64) {
        self.age += dt;
        if self.age > ANCHOR_AGE {
            self.anchor.move_by(self.way, self.gravity);
            self.way = [0.0; 3];
            self.age = dt;
        }
        self.advance_kernel(motion, dt);
    }

    fn pva(&self) -> Pva {
        LocalLevel::pva(self)
    }
}

impl<S> LocalLevel<S> {
    /// Every number in it in another kind of number.
    #[inline(always)]
    fn map<R>(self, f: &mut impl FnMut(S) -> R) -> LocalLevel<R> {
        LocalLevel {
            q_tb: self.q_tb.map(f),
            v_t: Vec3::claim(self.v_t.as_array().map(&mut *f)),
            anchor: self.anchor.map(f),
            way: self.way.map(&mut *f),
            age: self.age,
            a_free: Vec3::claim(self.a_free.as_array().map(&mut *f)),
            omega_it: Vec3::claim(self.omega_it.as_array().map(&mut *f)),
            baro_a: f(self.baro_a),
            vertical: self.vertical,
            gravity: self.gravity,
        }
    }
}

impl<S: Real> LocalLevel<S> {
    #[inline(always)]
    fn advance_kernel(&mut self, motion: &BodyMotion<S>, dt: f64) {
        let half = 0.5 * dt;
        let v = self.v_t;
        let zero = v[0].lift(0.0);
        let held = self.vertical == Vertical::Held;
        let dv_f = self.q_tb.rot::<T, _>().as_dcm() * motion.dv;

        // Specific force, turned by half the turn of t. What moves slowly is taken from the last step here:
        // it differs by the square of the step only, and nothing waits for it.
        let dv_f = dv_f - self.omega_it.cross(dv_f).scaled(half);
        let v_mid = v + horizontal_if(held, dv_f + self.a_free.scaled(dt)).scaled(0.5);

        // The Earth at the middle of the step.
        let dlat = self.way[0] + v[0] * self.anchor.per_r_m * half;
        let mut dh = if held { self.way[2] } else { self.way[2] - v[2] * half };
        let mut pushed = zero;
        if let Vertical::Damped(baro) = self.vertical {
            let mid = baro.at_middle(self.anchor.h.hi + (dh - baro.height), self.baro_a, dt);
            dh -= mid.back * 0.5;
            self.way[2] -= mid.back;
            self.baro_a = mid.baro_a;
            pushed = mid.down;
        }
        let earth = self.anchor.near(dlat, dh);
        let omega_ie = omega_ie_t(earth.sin_lat, earth.cos_lat);
        let tan_lat = earth.sin_lat * earth.sec_lat;
        let omega_it = (transport(v_mid, earth.per_r_m, earth.per_r_n, tan_lat) + omega_ie).as_vec3();

        // Velocity.
        let coriolis = (omega_it + omega_ie.as_vec3()).cross(v_mid);
        let mut a_free = Vec3::new(earth.g_n, zero, earth.g_d) - coriolis;
        if let Vertical::Damped(_) = self.vertical {
            a_free += Vec3::new(zero, zero, pushed);
        }
        let change = horizontal_if(held, dv_f + a_free.scaled(dt));
        let v_mid = v + change.scaled(0.5);
        self.a_free = a_free;
        self.omega_it = omega_it;
        self.v_t = v + change;

        // Position by the mean velocity.
        self.way[0] += v_mid[0] * earth.per_r_m * dt;
        self.way[1] += v_mid[1] * (earth.per_r_n * earth.sec_lat) * dt;
        if !held {
            self.way[2] -= v_mid[2] * dt;
        }

        // Attitude: t turns on the left, b on the right.
        self.q_tb.turn(small_turn(-omega_it.scaled(dt)), turn(motion.sigma));
    }
}

#[inline(always)]
fn horizontal_if<S: Real>(held: bool, v: Vec3<T, S>) -> Vec3<T, S> {
    if held { Vec3::new(v[0], v[1], v[2].lift(0.0)) } else { v }
}

#[cfg(test)]
mod jacobian;
mod lanes;

pub use lanes::{Eight, LANES, LocalLevelLanes};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NavError;
    use schuler_frames::{B, Rot};

    /// What the series about an anchor cost in an hour of flight with turns and climbs at 100 Hz: the same run
    /// with an anchor at every step has exact radii, gravity and trigonometry throughout.
    #[test]
    fn series_cost_less_than_ten_micrometres_in_an_hour() {
        for gravity in [Gravity::Somigliana, Gravity::Normal] {
            let start = Pva {
                position: Geodetic::new(0.8, 0.2, 8000.0),
                v_t: Vec3::new(180.0, 120.0, 0.0),
                c_tb: Rot::IDENTITY,
            };
            let mut series = LocalLevel::new(&start, gravity, Vertical::Held);
            let mut exact = series;
            for k in 0..360_000 {
                let t = f64::from(k) * 0.01;
                let increments = Increments {
                    dtheta: Vec3::<B>::new(
                        1e-5 * (0.11 * t).cos(),
                        1e-5 * (0.07 * t).cos(),
                        1e-3 * (0.013 * t).cos(),
                    ),
                    dv: Vec3::new(0.02 * (0.05 * t).sin(), 0.03 * (0.031 * t).cos(), -0.098),
                };
                exact.age = 1.0;
                series.step(&increments, 0.01);
                exact.step(&increments, 0.01);
            }
            let speed = exact.v_t.norm();
            assert!((100.0..1000.0).contains(&speed), "a flight, not {speed} m/s");
            let e = NavError::between(&series.pva(), &exact.pva());
            assert!(e.dr.norm() < 1e-5, "{gravity:?}: {:e} m, {:e} rad", e.dr.norm(), e.phi.norm());
            assert!(e.phi.norm() < 1e-12, "{gravity:?}: {} rad", e.phi.norm());
        }
    }
}
