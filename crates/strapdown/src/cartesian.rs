//! The Cartesian mechanizations: Earth-fixed and inertial.

use schuler_frames::{B, E, Frame, Geodetic, Gravity, I, Real, Rot, Vec3, wgs84};

use crate::kernel::{Quaternion, Sum, turn};
use crate::series::Series;
use crate::{BodyMotion, Increments, Mechanization, Pva, Vertical};

/// Way (m) and time (s) after which the anchor is moved along, whichever comes first.
const REACH: f64 = 1500.0;
const LIFE: f64 = 4.0;

/// A frame with its origin in the Earth's centre and its z axis along the Earth's.
pub trait Centred: Frame {
    /// Its rate against i about z, rad/s.
    const SPIN: f64;

    /// Acceleration (m/s²) of a body that is left to itself at rest in this frame at `r` (m).
    fn gravity(gravity: Gravity, r: Vec3<Self>) -> Vec3<Self>;
}

impl Centred for E {
    const SPIN: f64 = wgs84::OMEGA;
    fn gravity(gravity: Gravity, r: Vec3<E>) -> Vec3<E> {
        gravity.gravity_e(r)
    }
}

impl Centred for I {
    const SPIN: f64 = 0.0;
    fn gravity(gravity: Gravity, r: Vec3<I>) -> Vec3<I> {
        gravity.gravitation_i(r)
    }
}

/// Navigator in Earth-centred Earth-fixed coordinates. See [`Cartesian`].
pub type EarthFixed<S = f64> = Cartesian<E, S>;

/// Navigator in inertial coordinates, which coincide with the Earth-fixed ones at its start. See [`Cartesian`].
pub type Inertial<S = f64> = Cartesian<I, S>;

/// A navigator in Cartesian coordinates of the frame `F`, second order in the step.
///
/// ```text
/// v' = C_b^F f + g(r) - 2 omega_iF × v,     r' = v,     C_b^F' = C_b^F [omega_ib ×] - [omega_iF ×] C_b^F
/// ```
///
/// with g the gravity in e, the gravitation in i. Gravity and Coriolis acceleration are those of
/// the middle of the step. Products and sums alone do it: gravity stands as a series about an anchor that
/// follows every 1.5 km or four seconds. No place is special, the poles are passed like any other.
///
/// The vertical channel means what it means in local level. With u the ellipsoid's normal: held, velocity along u
/// and height are put back at every step to what they were at the start, along u, which is the force of
/// a smooth floor (so the vertical accelerometer is not used); damped, the loop feeds back along u. What moves the
/// height without being a velocity also moves omega_ie × r, which the velocity in i contains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cartesian<F: Frame, S = f64> {
    q: Quaternion<S>,
    v: [Sum<S>; 3],
    /// Change of the velocity in the last step, m/s.
    last: Vec3<F, S>,
    /// A place passed not long ago, m.
    anchor: [Sum<S>; 3],
    /// Way gone since, m.
    way: Vec3<F, S>,
    series: Series<F, S>,
    /// Time since the anchor, and that at which it is moved along, s.
    age: f64,
    life: f64,
    /// Time since the start, s.
    time: Sum<f64>,
    /// Height (m) and vertical velocity (m/s) at the start, up: what a held channel stays at.
    h0: f64,
    v_up: f64,
    /// Vertical acceleration error as a third-order baro loop has it, up, m/s².
    baro_a: S,
    vertical: Vertical,
    gravity: Gravity,
}

impl<F: Centred> Cartesian<F> {
    /// A navigator that starts at `pva`.
    pub fn new(pva: &Pva, gravity: Gravity, vertical: Vertical) -> Self {
        let r_e = pva.position.as_ecef();
        let c_et = pva.position.c_et();
        // The frame coincides with e at the start, but may not turn with it.
        let r = Vec3::<F>::claim(r_e.as_array());
        let v_e = Vec3::<F>::claim((c_et * pva.v_t).as_array());
        let v = v_e + earth_rate::<F>().cross(r);
        Cartesian {
            q: Quaternion::new((c_et * pva.c_tb).as_quaternion()),
            v: v.as_array().map(Sum::new),
            last: Vec3::ZERO,
            anchor: r.as_array().map(Sum::new),
            way: Vec3::ZERO,
            series: series_ahead(r, v, gravity, vertical),
            life: life(v),
            age: 0.0,
            time: Sum::new(0.0),
            h0: pva.position.h,
            v_up: -pva.v_t[2],
            baro_a: 0.0,
            vertical,
            gravity,
        }
    }

    /// Moves the anchor to where the navigator is.
    fn expand(&mut self) {
        for (sum, way) in self.anchor.iter_mut().zip(self.way.as_array()) {
            sum.add(way);
        }
        self.way = Vec3::ZERO;
        let anchor = Vec3::claim(self.anchor.map(|sum| sum.value()));
        self.life = life(self.velocity());
        self.series = series_ahead(anchor, self.velocity(), self.gravity, self.vertical);
    }
}

/// For how long an anchor serves at the velocity `v` (m/s), s.
fn life<F: Centred>(v: Vec3<F>) -> f64 {
    (REACH / v.norm()).min(LIFE)
}

/// The series about the middle of the way to come.
fn series_ahead<F: Centred>(
    anchor: Vec3<F>,
    v: Vec3<F>,
    gravity: Gravity,
    vertical: Vertical,
) -> Series<F, f64> {
    let centre = v * (0.5 * life(v));
    Series::new(anchor, centre, |r| F::gravity(gravity, r), vertical != Vertical::Free)
}

/// What the Earth turns by against `F` about z, rad/s.
const fn slip<F: Centred>() -> f64 {
    wgs84::OMEGA - F::SPIN
}

/// The same as a vector.
fn earth_rate<F: Centred>() -> Vec3<F> {
    Vec3::new(0.0, 0.0, slip::<F>())
}

impl<F: Centred> Mechanization for Cartesian<F> {
    #[inline]
    fn advance(&mut self, motion: &BodyMotion, dt: f64) {
        self.age += dt;
        if self.age > self.life {
            self.expand();
            self.age = dt;
        }
        self.time.add(dt);
        self.advance_kernel(motion, dt);
    }

    fn pva(&self) -> Pva {
        let r = Vec3::<F>::claim(core::array::from_fn(|k| self.anchor[k].value() + self.way[k]));
        let v_e = Vec3::<F>::claim(self.v.map(|sum| sum.value())) - earth_rate::<F>().cross(r);
        let half = 0.5 * slip::<F>() * self.time.value();
        let (s, c) = libm::sincos(half);
        let c_ef = Rot::<E, F>::claim([c, 0.0, 0.0, -s]);
        let position = Geodetic::from_ecef(c_ef * r);
        let c_te = position.c_et().inverse();
        Pva { position, v_t: c_te * (c_ef * v_e), c_tb: c_te * (c_ef * self.q.rot::<F, B>()) }
    }
}

impl<F: Centred> Cartesian<F> {
    /// [`Mechanization::step`], to be had without the trait.
    #[inline]
    pub fn step(&mut self, increments: &Increments, dt: f64) {
        self.advance(&BodyMotion::of(increments), dt);
    }
}

impl<F: Centred, S: Real> Cartesian<F, S> {
    #[inline(always)]
    fn velocity(&self) -> Vec3<F, S> {
        let [x, y, z] = self.v;
        Vec3::new(x.hi, y.hi, z.hi)
    }

    #[inline(always)]
    fn advance_kernel(&mut self, motion: &BodyMotion<S>, dt: f64) {
        let half = 0.5 * dt;
        let v = self.velocity();
        let held = self.vertical == Vertical::Held;
        // In i even a body at rest is on a curve: gravity wants the middle of the step to second order.
        let mut mid = self.way + (v + self.last.scaled(0.25)).scaled(half);

        let mut dv_f = self.q.rot::<F, B>().as_dcm() * motion.dv;
        if F::SPIN != 0.0 {
            // Turned by half the turn of the frame.
            dv_f += turned(dv_f, F::SPIN * half);
        }
        let mut change = dv_f;
        if let Vertical::Damped(baro) = self.vertical {
            let (h, up) = self.series.height_and_up(mid);
            let feedback = baro.at_middle(h - baro.height, self.baro_a, dt);
            let back = up * feedback.back;
            mid -= back.scaled(0.5);
            self.way -= back;
            self.baro_a = feedback.baro_a;
            change += turned(back, slip::<F>()) - up * (feedback.down * dt);
        }
        change += self.series.gravity(mid).scaled(dt);
        if F::SPIN != 0.0 {
            // At the mean velocity, which has half of the Coriolis acceleration itself in it.
            let k = 2.0 * F::SPIN * dt;
            let mut v_mid = v + (change + turned(v, k)).scaled(0.5);
            if held {
                let (_, up) = self.series.height_and_up(mid);
                v_mid -= up * (up.dot(v_mid) - self.v_up);
            }
            change += turned(v_mid, k);
        }
        if held {
            // The floor pushes along the vertical of the middle of the step, so hard that the vertical
            // velocity at its end is what it was.
            let end = self.way + (v + change.scaled(0.5)).scaled(dt);
            let (_, up_mid) = self.series.height_and_up(mid);
            let (_, up_end) = self.series.height_and_up(end);
            change += turned(up_mid, slip::<F>() * self.v_up * dt);
            change -= up_mid * (up_end.dot(v + change) - self.v_up);
        }
        self.way += (v + change.scaled(0.5)).scaled(dt);
        if held {
            let (_, up_mid) = self.series.height_and_up(mid);
            let (h, _) = self.series.height_and_up(self.way);
            self.way -= up_mid * (h - self.h0);
        }
        self.last = change;
        for k in 0..3 {
            self.v[k].add(change[k]);
        }

        // Attitude: the frame turns on the left, b on the right.
        let right = turn(motion.sigma);
        if F::SPIN != 0.0 {
            self.q.turn_about_z(-F::SPIN * dt, right);
        } else {
            self.q.turn_right(right);
        }
    }
}

/// `-k z × v`, with z the axis of the Earth.
#[inline(always)]
fn turned<F: Centred, S: Real>(v: Vec3<F, S>, k: f64) -> Vec3<F, S> {
    Vec3::new(v[1] * k, -(v[0] * k), v[2].lift(0.0))
}
