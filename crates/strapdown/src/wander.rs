//! The wander-azimuth mechanization: local level that knows no north, and so passes over the poles.

use schuler_frames::{B, Dcm, E, Frame, Geodetic, Gravity, Real, Vec3, wgs84};

use crate::kernel::{Quaternion, Sum, small_turn, turn};
use crate::profile::{Level, Profile};
use crate::{BodyMotion, Increments, Mechanization, Pva, Vertical};

/// Age of the anchor at which it is moved along, s.
const ANCHOR_AGE: f64 = 0.5;

/// Level with z down; turned about z by the wander angle against t.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct W;

impl Frame for W {
    const NAME: &'static str = "w";
}

/// Local-level navigator with free azimuth, second order in the step.
///
/// Its frame w is level like t, but does not turn about the vertical against the Earth: nothing grows
/// without bound towards the poles, and the rotation from w to e is the horizontal position.
/// At its start w is t. With z the Earth's axis resolved in w (so that sin L = -z_3), p = (z_1, z_2, 0) of length cos L, and
/// K the curvature of the level surface,
///
/// ```text
/// omega_ew = ((K v)_2, -(K v)_1, 0),   K v = v / (R_N + h) + p (p . v) (R_N - R_M) / (cos² L (R_M + h)(R_N + h))
/// v'       = C_b^w f + g - (2 omega_ie + omega_ew) × v
/// ```
///
/// The quotient (R_N - R_M) / cos² L = R_M e² / (1 - e²) is smooth at the poles. Otherwise it works as
/// [`LocalLevel`](crate::LocalLevel) does, and gives the same [`Pva`] resolved in t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WanderAzimuth<S = f64> {
    q_wb: Quaternion<S>,
    q_ew: Quaternion<S>,
    v_w: Vec3<W, S>,
    profile: Profile<S>,
    /// Height of the anchor, and what was climbed since, m.
    h: Sum<S>,
    climbed: S,
    /// Time since the anchor, s.
    age: f64,
    /// All acceleration that is not specific force, as the last step had it, m/s².
    a_free: Vec3<W, S>,
    /// Turn rate of w against e, as the last step had it, rad/s.
    omega_ew: Vec3<W, S>,
    /// Vertical acceleration error as a third-order baro loop has it, up, m/s².
    baro_a: S,
    vertical: Vertical,
    gravity: Gravity,
}

impl WanderAzimuth {
    /// A navigator that starts at `pva`, with no wander angle.
    pub fn new(pva: &Pva, gravity: Gravity, vertical: Vertical) -> Self {
        let mut nav = WanderAzimuth {
            q_wb: Quaternion::new(pva.c_tb.as_quaternion()),
            q_ew: Quaternion::new(pva.position.c_et().as_quaternion()),
            v_w: Vec3::claim(pva.v_t.as_array()),
            profile: Profile::new(pva.position.lat, pva.position.h, gravity),
            h: Sum::new(pva.position.h),
            climbed: 0.0,
            age: 0.0,
            a_free: Vec3::ZERO,
            omega_ew: Vec3::ZERO,
            baro_a: 0.0,
            vertical,
            gravity,
        };
        // A step of no duration fills in rates and accelerations of the start.
        nav.advance_kernel(&BodyMotion { sigma: Vec3::ZERO, dv: Vec3::ZERO }, 0.0);
        nav
    }

    /// [`Mechanization::step`], to be had without the trait.
    #[inline]
    pub fn step(&mut self, increments: &Increments, dt: f64) {
        self.advance(&BodyMotion::of(increments), dt);
    }

    /// Position by the normal of the ellipsoid, which is up.
    fn position(&self) -> Geodetic {
        let [x, y, z] = self.q_ew.rot::<E, W>().as_dcm().as_rows();
        let up = [-x[2], -y[2], -z[2]];
        // The first two components of the last row are as long as cos L, and exact near the poles.
        let lat = libm::atan2(up[2], libm::hypot(z[0], z[1]));
        Geodetic::new(lat, libm::atan2(up[1], up[0]), self.h.value() + self.climbed)
    }
}

impl Mechanization for WanderAzimuth {
    #[inline]
    fn advance(&mut self, motion: &BodyMotion, dt: f64) {
        self.age += dt;
        if self.age > ANCHOR_AGE {
            self.h.add(self.climbed);
            self.climbed = 0.0;
            let Geodetic { lat, h, .. } = self.position();
            self.profile = Profile::new(lat, h, self.gravity);
            self.age = dt;
        }
        self.advance_kernel(motion, dt);
    }

    fn pva(&self) -> Pva {
        let position = self.position();
        let c_tw = position.c_et().inverse() * self.q_ew.rot::<E, W>();
        Pva { position, v_t: c_tw * self.v_w, c_tb: c_tw * self.q_wb.rot::<W, B>() }
    }
}

impl<S: Real> WanderAzimuth<S> {
    #[inline(always)]
    fn advance_kernel(&mut self, motion: &BodyMotion<S>, dt: f64) {
        let half = 0.5 * dt;
        let v = self.v_w;
        let zero = v[0].lift(0.0);
        let held = self.vertical == Vertical::Held;
        let c_wb: Dcm<W, B, S> = self.q_wb.rot::<W, B>().as_dcm();
        let axis = Vec3::<W, S>::claim(self.q_ew.rot::<E, W>().as_dcm().as_rows()[2]);

        // Specific force, turned by half the turn of w. What moves slowly is taken from the last step here.
        let axis = axis - self.omega_ew.cross(axis).scaled(half);
        let omega_ie = axis.scaled(wgs84::OMEGA);
        let dv_f = c_wb * motion.dv;
        let dv_f = dv_f - (self.omega_ew + omega_ie).cross(dv_f).scaled(half);
        let v_mid = v + horizontal_if(held, dv_f + self.a_free.scaled(dt)).scaled(0.5);

        // The Earth at the middle of the step.
        let mut climbed = if held { self.climbed } else { self.climbed - v[2] * half };
        let mut pushed = zero;
        if let Vertical::Damped(baro) = self.vertical {
            let feedback = baro.at_middle(self.h.hi + (climbed - baro.height), self.baro_a, dt);
            climbed -= feedback.back * 0.5;
            self.climbed -= feedback.back;
            self.baro_a = feedback.baro_a;
            pushed = feedback.down;
        }
        let earth = self.profile.near(-axis[2], climbed);
        let level = Vec3::<W, S>::new(axis[0], axis[1], zero);

        // Velocity.
        let coriolis = (transport(v_mid, level, &earth) + omega_ie.scaled(2.0)).cross(v_mid);
        let a_free = level * earth.g_level + Vec3::new(zero, zero, earth.g_d + pushed) - coriolis;
        let change = horizontal_if(held, dv_f + a_free.scaled(dt));
        let v_mid = v + change.scaled(0.5);
        let omega_ew = transport(v_mid, level, &earth);
        self.a_free = a_free;
        self.omega_ew = omega_ew;
        self.v_w = v + change;

        // Position by the mean velocity.
        self.q_ew.turn_right(small_turn(omega_ew.scaled(dt)));
        if !held {
            self.climbed -= v_mid[2] * dt;
        }

        // Attitude: w turns on the left, b on the right.
        let omega_iw = omega_ew + omega_ie;
        self.q_wb.turn(small_turn(-omega_iw.scaled(dt)), turn(motion.sigma));
    }
}

#[inline(always)]
fn horizontal_if<S: Real>(held: bool, v: Vec3<W, S>) -> Vec3<W, S> {
    if held { Vec3::new(v[0], v[1], v[2].lift(0.0)) } else { v }
}

/// omega_ew at the velocity `v`, from the level part of the Earth's axis.
#[inline(always)]
fn transport<S: Real>(v: Vec3<W, S>, level: Vec3<W, S>, earth: &Level<S>) -> Vec3<W, S> {
    let bent = v * earth.per_r_n + level * (level.dot(v) * earth.bulge);
    Vec3::new(bent[1], -bent[0], v[2].lift(0.0))
}
