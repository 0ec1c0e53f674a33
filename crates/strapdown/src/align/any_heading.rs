//! A filter that needs no heading to begin with.

use nalgebra::{SMatrix, SVector};
use schuler_frames::{B, Frame, Geodetic, Gravity, Rot, T, Vec3, earth::omega_ie_t};

use crate::BodyMotion;

/// Level, but turned from north by an angle that nobody knows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Level;

impl Frame for Level {
    const NAME: &'static str = "l";
}

type Six = SMatrix<f64, 6, 6>;

/// What [`AnyHeading`] takes as given: standard deviations and densities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyHeadingNoise {
    /// Tilt of the first level, rad.
    pub tilt: f64,
    /// Velocity at the start, m/s.
    pub velocity: f64,
    /// One measurement of the velocity, m/s.
    pub measurement: f64,
    /// Angle random walk, rad/√s.
    pub angle_walk: f64,
    /// Velocity random walk, m/s/√s.
    pub velocity_walk: f64,
}

/// Fine alignment from any heading, by velocity that is known.
///
/// Errors of heading are not small at the start, and cosine and sine of it are no linear matter. Here a level frame l
/// keeps the heading it happens to have, and what is estimated are, beside velocity and tilts, the components of the
/// horizontal Earth rate along its axes: constant, and linear in everything. With alpha the heading of l,
///
/// ```text
/// omega_x = Ω cos L cos alpha,  omega_y = -Ω cos L sin alpha
/// dv_x' =  g phi_y,    phi_x' = -Ω sin L phi_y + d omega_x - eps_x
/// dv_y' = -g phi_x,    phi_y' =  Ω sin L phi_x + d omega_y - eps_y
/// ```
///
/// (errors computed minus true; phi as elsewhere). Six states hold for every alpha; heading comes out at the end,
/// `alpha = atan2(-omega_y, omega_x)`. Constant sensor errors leave
/// [`Limits::bias`](super::Limits::bias), as in every alignment, and are no states, because at rest nothing tells them; the
/// down gyro turns l by eps_D t on top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyHeading {
    c_lb: Rot<Level, B>,
    v: [f64; 2],
    /// Earth rate along l.
    omega: Vec3<Level>,
    g: f64,
    p: Six,
    noise: AnyHeadingNoise,
    /// Time since the last measurement, s.
    elapsed: f64,
}

impl AnyHeading {
    /// Begins at `position` with the level that the mean specific force `f_b` (m/s²) of the first seconds shows.
    ///
    /// The Earth rate begins as zero with its horizontal part as standard deviation: nothing is known of north.
    pub fn new(f_b: Vec3<B>, position: Geodetic, gravity: Gravity, noise: AnyHeadingNoise) -> Self {
        let (s, c) = libm::sincos(position.lat);
        let omega = omega_ie_t(s, c).as_vec3();
        // The shortest turn that lays the measured force upon up, (0, 0, -1).
        let up = f_b * (1.0 / f_b.norm());
        let (axis, cosine) = (up.cross(Vec3::new(0.0, 0.0, -1.0)), -up[2]);
        let sine = axis.norm();
        let angle = libm::atan2(sine, cosine);
        let turn = if sine > 0.0 {
            axis * (angle / sine)
        } else {
            // Upright, or on its head.
            Vec3::new(if cosine < 0.0 { core::f64::consts::PI } else { 0.0 }, 0.0, 0.0)
        };
        let [x, y, z] = turn.as_array();
        let mut p = Six::zeros();
        for (k, sigma) in [noise.velocity, noise.tilt, omega[0].abs()].into_iter().enumerate() {
            (p[(2 * k, 2 * k)], p[(2 * k + 1, 2 * k + 1)]) = (sigma * sigma, sigma * sigma);
        }
        AnyHeading {
            c_lb: Rot::from_rotation_vector(Vec3::new(x, y, z)),
            v: [0.0; 2],
            omega: Vec3::new(0.0, 0.0, omega[2]),
            g: gravity.gravity_t(position).norm(),
            p,
            noise,
            elapsed: 0.0,
        }
    }

    /// One step over `dt` (s) in which the body moved by `motion`.
    pub fn advance(&mut self, motion: &BodyMotion, dt: f64) {
        // In the level of the middle of the step, as in the gyrocompass.
        let f_dt = self.c_lb * motion.dv;
        let dv = f_dt - self.omega.cross(f_dt) * (0.5 * dt);
        self.v = [self.v[0] + dv[0], self.v[1] + dv[1]];
        let frame = Rot::<Level, Level>::from_rotation_vector(self.omega * -dt);
        let body = Rot::<B, B>::from_rotation_vector(motion.sigma);
        self.c_lb = (frame * self.c_lb * body).normalized();
        self.elapsed += dt;
    }

    /// The base has this `velocity` now (m/s) along the first two axes of the level frame: zero, but for what a simulation
    /// adds as noise, which has no direction.
    pub fn measure(&mut self, velocity: [f64; 2]) {
        let dt = core::mem::take(&mut self.elapsed);
        self.predict(dt);
        let mut x = SVector::<f64, 6>::zeros();
        let r = self.noise.measurement * self.noise.measurement;
        for k in 0..2 {
            // z = v_k - what is known, the row that takes component k; Joseph form.
            let s = self.p[(k, k)] + r;
            let gain = self.p.column(k) / s;
            x += gain * (self.v[k] - velocity[k] - x[k]);
            let mut keep = Six::identity();
            for i in 0..6 {
                keep[(i, k)] -= gain[i];
            }
            self.p = keep * self.p * keep.transpose() + gain * gain.transpose() * r;
        }
        self.v = [self.v[0] - x[0], self.v[1] - x[1]];
        // C_true = exp([phi ×]) C_computed
        let phi = Vec3::<Level>::new(x[2], x[3], 0.0);
        self.c_lb = (Rot::<Level, Level>::from_rotation_vector(phi) * self.c_lb).normalized();
        self.omega -= Vec3::new(x[4], x[5], 0.0);
    }

    fn predict(&mut self, dt: f64) {
        let mut f = Six::zeros();
        (f[(0, 3)], f[(1, 2)]) = (self.g, -self.g);
        (f[(2, 3)], f[(3, 2)]) = (self.omega[2], -self.omega[2]);
        (f[(2, 4)], f[(3, 5)]) = (1.0, 1.0);
        let transition = |t: f64| {
            // What is left out is of the fourth power of the Earth's turn over the interval.
            let a = f * t;
            let a2 = a * a;
            Six::identity() + a + a2 * 0.5 + a2 * a * (1.0 / 6.0)
        };
        let mut q = Six::zeros();
        for (k, walk) in [(0, self.noise.velocity_walk), (2, self.noise.angle_walk)] {
            (q[(k, k)], q[(k + 1, k + 1)]) = (walk * walk, walk * walk);
        }
        let (half, whole) = (transition(0.5 * dt), transition(dt));
        let spread = q + half * q * half.transpose() * 4.0 + whole * q * whole.transpose();
        self.p = whole * self.p * whole.transpose() + spread * (dt / 6.0);
    }

    /// The attitude now.
    pub fn attitude(&self) -> Rot<T, B> {
        let alpha = libm::atan2(-self.omega[1], self.omega[0]);
        let turn = Rot::<T, Level>::from_rotation_vector(Vec3::new(0.0, 0.0, alpha));
        turn * self.c_lb
    }

    /// Standard deviations of phi north, east and down, rad; that of heading holds once it is small against one.
    pub fn sigma(&self) -> [f64; 3] {
        let [x, y, _] = self.omega.as_array();
        let square = x * x + y * y;
        // Along and across north, from the axes of l.
        let turned = |k: usize, along: f64, across: f64| {
            let p = |i: usize, j: usize| self.p[(k + i, k + j)];
            let variance =
                along * along * p(0, 0) + 2.0 * along * across * p(0, 1) + across * across * p(1, 1);
            libm::sqrt((variance / square).max(0.0))
        };
        [turned(2, x, y), turned(2, -y, x), turned(4, -y, x) / libm::sqrt(square)]
    }
}
