//! The local-level mechanization: geodetic position, velocity in t, attitude body to t.

use schuler_frames::earth::{omega_ie_t, transport};
use schuler_frames::somigliana::gamma;
use schuler_frames::{Geodetic, Gravity, Real, T, Vec3, wgs84};

use crate::kernel::{Quaternion, Sum, refine_reciprocal, refine_rsqrt, sin_vers, small_turn, turn};
use crate::{Increments, Pva, Vertical};

/// Steps after which sine and cosine of the latitude are computed afresh; between, they are turned
/// along, which gathers a rounding of 1e-16 each step.
const REFRESH: u32 = 256;

/// Local-level navigator, second order in the step.
///
/// Each step uses Earth rate, transport rate, gravity, Coriolis and radii at the middle of the
/// step. A step needs no division, root or trigonometry: reciprocals follow by a Newton step from their
/// last values (which corrects itself), sine and cosine of the latitude by turning them along.
/// That holds while one step moves less than 20 km and turns the body by less than 1 rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalLevel<S = f64> {
    q_tb: Quaternion<S>,
    v_t: Vec3<T, S>,
    lat: Sum<S>,
    lon: Sum<S>,
    h: Sum<S>,
    sin_lat: S,
    cos_lat: S,
    /// 1 / sqrt(1 - e² sin² L).
    w: S,
    per_r_m: S,
    per_r_n: S,
    per_cos: S,
    /// Vertical acceleration error as a third-order baro loop has it, up, m/s².
    baro_a: S,
    steps: u32,
}

/// Gravity as a step asks for it: north and down component, m/s², from what the step has at hand.
pub trait StepGravity<S> {
    /// Gravity from sin L, cos L, h (m) and w = 1/sqrt(1 - e² sin² L).
    fn north_down(&self, sin_lat: S, cos_lat: S, h: S, w: S) -> (S, S);
}

/// [`Gravity::Somigliana`] for hot loops over any [`Real`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Somigliana;

impl<S: Real> StepGravity<S> for Somigliana {
    #[inline(always)]
    fn north_down(&self, sin_lat: S, _: S, h: S, w: S) -> (S, S) {
        (sin_lat.lift(0.0), gamma(sin_lat * sin_lat, h, w))
    }
}

/// [`Gravity::Normal`], exact at every step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Normal;

impl StepGravity<f64> for Normal {
    #[inline]
    fn north_down(&self, sin_lat: f64, cos_lat: f64, h: f64, _: f64) -> (f64, f64) {
        let g = Gravity::Normal.gravity_t(Geodetic::new(libm::atan2(sin_lat, cos_lat), 0.0, h));
        (g[0], g[2])
    }
}

impl LocalLevel {
    /// A navigator that starts at `pva`.
    pub fn new(pva: &Pva) -> Self {
        let Geodetic { lat, lon, h } = pva.position;
        let (sin_lat, cos_lat) = libm::sincos(lat);
        LocalLevel {
            q_tb: Quaternion::new(pva.c_tb.as_quaternion()),
            v_t: pva.v_t,
            lat: Sum::new(lat),
            lon: Sum::new(lon),
            h: Sum::new(h),
            sin_lat,
            cos_lat,
            w: wgs84::w(sin_lat),
            per_r_m: 1.0 / (wgs84::r_m(sin_lat) + h),
            per_r_n: 1.0 / (wgs84::r_n(sin_lat) + h),
            per_cos: 1.0 / cos_lat,
            baro_a: 0.0,
            steps: 0,
        }
    }

    /// Position, velocity and attitude now.
    pub fn pva(&self) -> Pva {
        Pva {
            position: Geodetic::new(self.lat.value(), self.lon.value(), self.h.value()),
            v_t: self.v_t,
            c_tb: self.q_tb.rot(),
        }
    }

    /// One step of `dt` (s) with gravity and vertical channel chosen at run time.
    #[inline]
    pub fn step(&mut self, increments: &Increments, dt: f64, gravity: Gravity, vertical: Vertical) {
        self.steps = self.steps.wrapping_add(1);
        if self.steps.is_multiple_of(REFRESH) {
            (self.sin_lat, self.cos_lat) = libm::sincos(self.lat.value());
        }
        match gravity {
            Gravity::Somigliana => self.advance(increments, dt, &Somigliana, vertical),
            Gravity::Normal => self.advance(increments, dt, &Normal, vertical),
        }
    }
}

impl<S: Real> LocalLevel<S> {
    /// One step without the refresh of sine and cosine of the latitude.
    #[inline(always)]
    pub fn advance<G: StepGravity<S>>(
        &mut self,
        increments: &Increments<S>,
        dt: f64,
        gravity: &G,
        vertical: Vertical,
    ) {
        let zero = self.sin_lat.lift(0.0);
        let half = 0.5 * dt;
        let v = self.v_t;
        let c_tb = self.q_tb.rot::<T, _>().as_dcm();
        let dv_f = c_tb * increments.dv_at_start();

        // The middle of the step: place, radii, gravity, rates.
        let (s, vers) = sin_vers(v[0] * self.per_r_m * half);
        let sin_mid = self.sin_lat + (self.cos_lat * s - self.sin_lat * vers);
        let cos_mid = self.cos_lat - (self.sin_lat * s + self.cos_lat * vers);
        let h_mid = self.h.hi - v[2] * half;
        let sin2 = sin_mid * sin_mid;
        let w = refine_rsqrt(self.w, -(sin2 * wgs84::E2) + 1.0);
        let r_n = w * wgs84::A;
        let r_m = r_n * w * w * (1.0 - wgs84::E2);
        self.w = w;
        self.per_r_m = refine_reciprocal(self.per_r_m, r_m + h_mid);
        self.per_r_n = refine_reciprocal(self.per_r_n, r_n + h_mid);
        self.per_cos = refine_reciprocal(self.per_cos, cos_mid);
        let tan_mid = sin_mid * self.per_cos;
        let (g_n, g_d) = gravity.north_down(sin_mid, cos_mid, h_mid, w);
        let omega_ie = omega_ie_t(sin_mid, cos_mid);

        // Velocity at the middle with the rates of the start, then everything with the rates of the middle.
        let g_dt = Vec3::new(g_n * dt, zero, g_d * dt);
        let mut v_mid = v;
        let mut change = dv_f;
        for _ in 0..2 {
            let omega_et = transport(v_mid, self.per_r_m, self.per_r_n, tan_mid);
            let omega_it = (omega_et + omega_ie).as_vec3();
            let coriolis = (omega_it + omega_ie.as_vec3()).cross(v_mid);
            change = dv_f - omega_it.cross(dv_f).scaled(half) + g_dt - coriolis.scaled(dt);
            if let Vertical::Damped(baro) = vertical {
                let excess = h_mid - baro.height;
                let down = (excess * baro.k2 + self.baro_a) * dt;
                change += Vec3::new(zero, zero, down);
            }
            if vertical == Vertical::Held {
                change = Vec3::new(change[0], change[1], zero);
            }
            v_mid = v + change.scaled(0.5);
        }
        self.v_t = v + change;

        // Position by the mean velocity.
        let dlat = v_mid[0] * self.per_r_m * dt;
        self.lat.add(dlat);
        self.lon.add(v_mid[1] * self.per_r_n * self.per_cos * dt);
        match vertical {
            Vertical::Free => self.h.add(-(v_mid[2] * dt)),
            Vertical::Held => {}
            Vertical::Damped(baro) => {
                let excess = h_mid - baro.height;
                self.h.add((-v_mid[2] - excess * baro.k1) * dt);
                self.baro_a += excess * (baro.k3 * dt);
            }
        }
        let (s, vers) = sin_vers(dlat);
        let (sin, cos) = (self.sin_lat, self.cos_lat);
        self.sin_lat = sin + (cos * s - sin * vers);
        self.cos_lat = cos - (sin * s + cos * vers);

        // Attitude: t turns on the left, b on the right.
        let omega_it = (transport(v_mid, self.per_r_m, self.per_r_n, tan_mid) + omega_ie).as_vec3();
        self.q_tb.turn(small_turn(-(omega_it.scaled(dt))), turn(increments.dtheta));
    }
}
