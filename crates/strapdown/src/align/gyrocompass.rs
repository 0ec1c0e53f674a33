//! The classical loop: level by velocity, north by the tilt that the Earth's turn makes.

use schuler_frames::earth::omega_ie_t;
use schuler_frames::{B, Geodetic, Gravity, Rot, T, Vec3};

use super::Limits;
use crate::BodyMotion;
use crate::static_base::Site;

/// A gyrocompass: a computed local level that is turned by its own velocity error until it stands still.
///
/// The velocity of a base at rest is zero, so that what the accelerometers integrate to is error; it is fed back as
///
/// ```text
/// v_N' = f_N - k1 v_N       turn about east  -k2 v_N,   about down -k3 v_N
/// v_E' = f_E - k1' v_E      turn about north  k2' v_E
/// ```
///
/// with the gains that give the north channel, which holds heading (s³ + k1 s² + g k2 s + g Ω cos L k3), and the
/// east channel (s² + k1' s + g k2') all their poles at -1/tau:
/// k1 = 3/tau, g k2 = 3/tau², g Ω cos L k3 = 1/tau³; k1' = 2/tau, g k2' = 1/tau².
///
/// Constant sensor errors leave phi_N and phi_E of [`Limits::bias`] up to products of tau with gyro errors, and a heading of
/// `eps_E / (Ω cos L) - tan L phi_N - 3 tau (eps_D + Ω cos L phi_E)` ([`Gyrocompass::settled`] has all of it). A start
/// that is off by `phi` leaves `phi` times a power of t/tau times `exp(-t/tau)`: ten tau settle it to a thousandth.
/// Below a tau of a minute noise and rocking pass into heading; velocity noise goes as tau^-2.5.
///
/// Source of the principle: Titterton and Weston, Strapdown Inertial Navigation Technology (2nd ed. 2004), chapter 10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gyrocompass {
    c_tb: Rot<T, B>,
    v: [f64; 2],
    g_t: Vec3<T>,
    omega_t: Vec3<T>,
    gains: Gains,
    site: Site,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Gains {
    tau: f64,
    north: [f64; 3],
    east: [f64; 2],
}

impl Gyrocompass {
    /// A loop of time constant `tau` (s) that starts from the coarse attitude `c_tb` at `position`.
    ///
    /// Of the heading at the start the loop wants no more than that it is not the opposite of true; from some tens of
    /// degrees it takes a few tau more. At a pole there is no north to find: heading then is not turned at all.
    pub fn new(c_tb: Rot<T, B>, position: Geodetic, gravity: Gravity, tau: f64) -> Self {
        let site = Site::new(position, gravity);
        let omega_north = Limits::new(site).omega_north();
        let rate = 1.0 / tau;
        let heading = if omega_north.abs() > 1e-6 * site.omega_ie {
            rate * rate * rate / (site.g * omega_north)
        } else {
            0.0
        };
        Gyrocompass {
            c_tb,
            v: [0.0; 2],
            g_t: gravity.gravity_t(position),
            omega_t: omega_ie_t(site.sin_lat, site.cos_lat).as_vec3(),
            gains: Gains {
                tau,
                north: [3.0 * rate, 3.0 * rate * rate / site.g, heading],
                east: [2.0 * rate, rate * rate / site.g],
            },
            site,
        }
    }

    /// One step over `dt` (s, well below tau) in which the body moved by `motion`.
    pub fn advance(&mut self, motion: &BodyMotion, dt: f64) {
        let [v_n, v_e] = self.v;
        let Gains { north, east, .. } = self.gains;
        let turn = Vec3::<T>::new(east[1] * v_e, -north[1] * v_n, -north[2] * v_n) + self.omega_t;
        // The local level of the middle of the step: half of its turn would be a tilt of Ω cos L dt / 2.
        let f_dt = self.c_tb * motion.dv;
        let dv = f_dt - turn.cross(f_dt) * (0.5 * dt) + self.g_t * dt;
        self.v = [v_n + dv[0] - north[0] * v_n * dt, v_e + dv[1] - east[0] * v_e * dt];
        // C' = C [omega_ib^b ×] - [omega_it^t ×] C
        let frame = Rot::<T, T>::from_rotation_vector(turn * -dt);
        let body = Rot::<B, B>::from_rotation_vector(motion.sigma);
        self.c_tb = (frame * self.c_tb * body).normalized();
    }

    /// The attitude now.
    pub fn attitude(&self) -> Rot<T, B> {
        self.c_tb
    }

    /// Attitude error phi (rad) at which the loop comes to rest under constant sensor errors `eps_t` (rad/s) and
    /// `nabla_t` (m/s²), resolved in t, to first order in tau times the Earth rate.
    pub fn settled(&self, eps_t: Vec3<T>, nabla_t: Vec3<T>) -> Vec3<T> {
        let (tau, o) = (self.gains.tau, self.site.omega_ie);
        let (omega_n, omega_d) = (o * self.site.cos_lat, -o * self.site.sin_lat);
        let level = Limits::new(self.site).bias(eps_t, nabla_t);
        // What the loops must turn for ever is held by a velocity: v_E = tau² g (…), v_N = -tau³ g Ω cos L (…).
        let about_north = eps_t[0] - omega_d * level[1];
        let about_down = eps_t[2] + omega_n * level[1];
        let phi_n = level[0] - 2.0 * tau * about_north;
        let phi_e = level[1] - 3.0 * tau * tau * omega_n * about_down;
        let phi_d = (eps_t[1] + omega_d * phi_n) / omega_n - 3.0 * tau * about_down;
        Vec3::new(phi_n, phi_e, phi_d)
    }

    /// Standard deviations of phi (rad) in the settled loop under angle random walk `n` (rad/√s) of each gyro alone:
    /// `N √(5 tau/4)`, `N √(3 tau/4)` and `N / (Ω cos L) √(3 / (16 tau))`.
    ///
    /// White noise through (tau (tau s + 2) / (tau s + 1)²), (tau² s (tau s + 3) / (tau s + 1)³) and
    /// 1 / (Ω cos L (tau s + 1)³).
    pub fn angle_walk(&self, n: f64) -> Vec3<T> {
        let tau = self.gains.tau;
        let heading = n / Limits::new(self.site).omega_north() * libm::sqrt(3.0 / (16.0 * tau));
        Vec3::new(n * libm::sqrt(1.25 * tau), n * libm::sqrt(0.75 * tau), heading)
    }

    /// The same under velocity random walk `q` (m/s/√s) of each accelerometer alone: `q / (2 g √tau)`,
    /// `q / g √(3 / (4 tau))` and `q / (4 g Ω cos L tau^1.5)`.
    ///
    /// White noise through 1 / (g (tau s + 1)²), (3 tau s + 1) / (g (tau s + 1)³) and s / (g Ω cos L (tau s + 1)³).
    pub fn velocity_walk(&self, q: f64) -> Vec3<T> {
        let tau = self.gains.tau;
        let tilt = q / (self.site.g * libm::sqrt(tau));
        let heading = 0.25 * tilt / (Limits::new(self.site).omega_north() * tau);
        Vec3::new(0.5 * tilt, tilt * libm::sqrt(0.75), heading)
    }
}
