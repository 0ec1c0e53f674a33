//! What no alignment of a vehicle at rest can do better than.

use schuler_frames::{T, Vec3};

use super::Solution;
use crate::static_base::Site;

/// The analytic limits of alignment at rest at a place.
///
/// Each law is the standard deviation that the best estimator reaches when that noise is alone, velocity is known
/// to be zero and nothing is known of the attitude before; together they add in variance, about. `Ω c` is the
/// horizontal Earth rate Ω cos L, `t` the time of alignment.
///
/// ```
/// use schuler_frames::{Geodetic, Gravity, Vec3};
/// use schuler_strapdown::{align::Limits, static_base::Site};
/// let site = Site::new(Geodetic::new(45f64.to_radians(), 0.0, 0.0), Gravity::Somigliana);
/// let gyro_east = 0.01_f64.to_radians() / 3600.0;
/// let phi = Limits::new(site).bias(Vec3::new(0.0, gyro_east, 0.0), Vec3::ZERO);
/// assert!((phi[2].to_degrees() * 60.0 - 3.2322).abs() < 1e-4); // arc minutes
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The place.
    pub site: Site,
}

impl Limits {
    /// The limits at `site`.
    pub fn new(site: Site) -> Self {
        Limits { site }
    }

    /// Horizontal part of the Earth rate Ω cos L, rad/s: what tells north.
    pub fn omega_north(&self) -> f64 {
        self.site.omega_ie * self.site.cos_lat
    }

    /// Attitude error phi (rad) that constant sensor errors `eps_t` (rad/s) and `nabla_t` (m/s²), resolved in t,
    /// leave in every alignment that levels by the accelerometers:
    ///
    /// ```text
    /// phi_N = nabla_E / g,   phi_E = -nabla_N / g,   phi_D = eps_E / (Ω cos L) - tan L nabla_E / g
    /// ```
    ///
    /// To first order. With these errors the navigator is in equilibrium: it does not move.
    pub fn bias(&self, eps_t: Vec3<T>, nabla_t: Vec3<T>) -> Vec3<T> {
        let phi_n = nabla_t[1] / self.site.g;
        let tan_lat = self.site.sin_lat / self.site.cos_lat;
        Vec3::new(phi_n, -nabla_t[0] / self.site.g, eps_t[1] / self.omega_north() - tan_lat * phi_n)
    }

    /// Standard deviations of [`Limits::bias`] (rad) from those of the gyro error `eps` (rad/s) and of the accelerometer
    /// error `nabla` (m/s²), one for all axes.
    pub fn bias_sigma(&self, eps: f64, nabla: f64) -> Vec3<T> {
        let tilt = nabla / self.site.g;
        let tan_lat = self.site.sin_lat / self.site.cos_lat;
        Vec3::new(tilt, tilt, libm::hypot(eps / self.omega_north(), tan_lat * tilt))
    }

    /// Heading (rad) under angle random walk `n` (rad/√s) alone after `t` (s):
    /// `N / √(Ω c) √coth(Ω c t)`, which begins as `N / (Ω c √t)` and ends at `N / √(Ω c)`.
    ///
    /// The steady form of the Riccati equation of heading seen through Ω cos L phi_D with noise N, and driven by
    /// the same noise.
    pub fn heading_angle_walk(&self, n: f64, t: f64) -> f64 {
        let o = self.omega_north();
        n / libm::sqrt(o * libm::tanh(o * t))
    }

    /// Heading (rad) under velocity random walk `q` (m/s/√s) alone after `t` (s), velocity measured without
    /// noise: `√12 q / (g Ω c t^1.5)`.
    ///
    /// The slope of a straight line through white noise.
    pub fn heading_velocity_walk(&self, q: f64, t: f64) -> f64 {
        libm::sqrt(12.0) * q / (self.site.g * self.omega_north() * libm::pow(t, 1.5))
    }

    /// Heading (rad) under white noise of the measured velocity alone, of density `r` (m²/s: variance times
    /// interval), after `t` (s): `√(720 r / t⁵) / (g Ω c)`.
    ///
    /// The curvature of a parabola through white noise.
    pub fn heading_velocity_noise(&self, r: f64, t: f64) -> f64 {
        libm::sqrt(720.0 * r / libm::pow(t, 5.0)) / (self.site.g * self.omega_north())
    }

    /// Tilts phi_N and phi_E (rad) at the end under velocity random walk `q` alone: `q / (g √t)` and `2 q / (g √t)`.
    ///
    /// About east the heading must be told apart from the tilt: the end of a line in place of a mean.
    pub fn tilt_velocity_walk(&self, q: f64, t: f64) -> [f64; 2] {
        let mean = q / (self.site.g * libm::sqrt(t));
        [mean, 2.0 * mean]
    }

    /// Tilts phi_N and phi_E (rad) at the end under white noise of the measured velocity of density `r` (m²/s):
    /// `√(12 r / t³) / g` and `√(192 r / t³) / g`, the slope of a line and the end slope of a parabola.
    pub fn tilt_velocity_noise(&self, r: f64, t: f64) -> [f64; 2] {
        [12.0, 192.0].map(|k| libm::sqrt(k * r / (t * t * t)) / self.site.g)
    }

    /// Heading (rad) of TRIAD from means over `t` (s) under angle random walk `n` (rad/√s): `N / (Ω c √t)`.
    pub fn heading_triad(&self, n: f64, t: f64) -> f64 {
        n / (self.omega_north() * libm::sqrt(t))
    }

    /// phi (rad) of alignment in inertial space by `solution` at the end, with its first vector at `t`/2, under angle
    /// random walk `n` (rad/√s) of each gyro alone, for `t` (s) well below a radian of the Earth's turn.
    ///
    /// A gyro that has drifted by a(s) turns the specific force, so that the velocity across gravity is off by
    /// `-g ∫ a`, in which the forms see the tilt as the part that goes with t and Ω c phi_D as the part that goes with t²/2:
    ///
    /// ```text
    ///            phi_N and phi_E over N √t      phi_D over N / (Ω c √t)
    /// velocity   √(1/3)    √(1/6)               √(4/3)
    /// position   √(8/15)   √(13/30)             √(3/2)
    /// optimal    √(17/35)  √(752/2835)          √(760/567)
    /// ```
    pub fn inertial_angle_walk(&self, solution: Solution, n: f64, t: f64) -> Vec3<T> {
        let [north, east, down] = match solution {
            Solution::Velocity => [1.0 / 3.0, 1.0 / 6.0, 4.0 / 3.0],
            Solution::Position => [8.0 / 15.0, 13.0 / 30.0, 1.5],
            Solution::Optimal => [17.0 / 35.0, 752.0 / 2835.0, 760.0 / 567.0],
        }
        .map(libm::sqrt);
        let tilt = n * libm::sqrt(t);
        Vec3::new(north * tilt, east * tilt, down * self.heading_triad(n, t))
    }

    /// The same under velocity random walk `q` (m/s/√s) of each accelerometer alone:
    ///
    /// ```text
    ///            phi_N and phi_E over q / (g √t)      phi_D over q / (g Ω c t^1.5)
    /// velocity   1        √5                          4
    /// position   √(4/3)   √(28/3)                     √24
    /// optimal    √(6/5)   √(192/35)                   √(320/21)
    /// ```
    ///
    /// The best would be 1, 2 and √12.
    pub fn inertial_velocity_walk(&self, solution: Solution, q: f64, t: f64) -> Vec3<T> {
        let [north, east, down] = match solution {
            Solution::Velocity => [1.0, 5.0, 16.0],
            Solution::Position => [4.0 / 3.0, 28.0 / 3.0, 24.0],
            Solution::Optimal => [1.2, 192.0 / 35.0, 320.0 / 21.0],
        }
        .map(libm::sqrt);
        let tilt = q / (self.site.g * libm::sqrt(t));
        Vec3::new(north * tilt, east * tilt, down * tilt / (self.omega_north() * t))
    }
}
