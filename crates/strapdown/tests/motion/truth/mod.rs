//! Trajectories in closed form, and the exact increments a perfect IMU delivers along them.

mod jet;

use schuler_frames::{B, E, Euler, Geodetic, Gravity, Rot, T, Vec3, wgs84};
use schuler_strapdown::{Increments, Pva};

pub use jet::Jet;

/// Where a body is and how it stands, as functions of time.
pub trait Trajectory {
    /// Unit normal of the ellipsoid under the body, e axes, and the height above it (m).
    fn place(&self, t: Jet) -> ([Jet; 3], Jet);

    /// Roll, pitch and yaw (rad) of the body against `axes`.
    fn stand(&self, t: Jet) -> [Jet; 3];

    /// The axes against which the body stands: local level, or e itself where there is no north.
    fn against(&self) -> Against {
        Against::Level
    }
}

#[derive(Clone, Copy, PartialEq)]
pub enum Against {
    Level,
    Earth,
}

/// Normal of the ellipsoid at latitude and longitude (rad).
pub fn normal(lat: Jet, lon: Jet) -> [Jet; 3] {
    let ((s, c), (sin_lon, cos_lon)) = (lat.sin_cos(), lon.sin_cos());
    [c * cos_lon, c * sin_lon, s]
}

/// Nodes and weights of Gauss and Legendre on 0..1, exact for polynomials of degree 9.
const GAUSS: [(f64, f64); 5] = [
    (0.5, 0.284_444_444_444_444_44),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.769_234_655_052_841_55, 0.239_314_335_249_683_23),
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// What is true at one time.
pub struct Moment {
    pub pva: Pva,
    /// Specific force, m/s², and turn rate against i, rad/s, body axes.
    pub f_b: Vec3<B>,
    pub omega_ib_b: Vec3<B>,
}

/// The truth of a trajectory at the time `t` (s), in the field `gravity`.
pub fn at(path: &dyn Trajectory, gravity: Gravity, t: f64) -> Moment {
    let time = Jet::time(t);
    let (n, h) = path.place(time);
    // R_N = a / sqrt(1 - e² n_z²)
    let r_n = (n[2] * n[2] * -wgs84::E2 + 1.0).powf(-0.5) * wgs84::A;
    let r = [n[0] * (r_n + h), n[1] * (r_n + h), n[2] * (r_n * (1.0 - wgs84::E2) + h)];
    let [r_e, v_e, a_e] = [r.map(|x| x.0), r.map(|x| x.1), r.map(|x| x.2)].map(Vec3::<E>::claim);
    let omega = Vec3::<E>::new(0.0, 0.0, wgs84::OMEGA);

    // r'' against i, resolved in e.
    let a = a_e + omega.cross(v_e) * 2.0 + omega.cross(omega.cross(r_e));
    let f_e = a - gravity.gravitation_e(r_e);

    let position = Geodetic::new(n[2].0.atan2(n[0].0.hypot(n[1].0)), n[1].0.atan2(n[0].0), h.0);
    let c_et = position.c_et();
    let angles = path.stand(time);
    let stand = Euler::new(angles[0].0, angles[1].0, angles[2].0);
    // Rates of roll, pitch and yaw, each about its own axis, in body axes.
    let ((sr, cr), (sp, cp)) = (stand.roll.sin_cos(), stand.pitch.sin_cos());
    let [roll, pitch, yaw] = angles.map(Jet::rate);
    let turning = Vec3::<B>::new(roll - yaw * sp, pitch * cr + yaw * cp * sr, -pitch * sr + yaw * cp * cr);
    let (c_eb, omega_eb_b): (Rot<E, B>, Vec3<B>) = match path.against() {
        Against::Level => {
            let c_tb: Rot<T, B> = Rot::from_euler(stand);
            let rate_of_level = schuler_frames::earth::omega_et_t(c_et.inverse() * v_e, position).as_vec3();
            (c_et * c_tb, turning + c_tb.inverse() * rate_of_level)
        }
        Against::Earth => (Rot::from_euler(stand), turning),
    };
    let c_be = c_eb.inverse();
    Moment {
        pva: Pva { position, v_t: c_et.inverse() * v_e, c_tb: c_et.inverse() * c_eb },
        f_b: c_be * f_e,
        omega_ib_b: omega_eb_b + c_be * omega,
    }
}

/// Increments from `t` to `t + dt`, exact to rounding for motion that is smooth over `dt`.
pub fn increments(path: &dyn Trajectory, gravity: Gravity, t: f64, dt: f64) -> Increments {
    let (mut dtheta, mut dv) = (Vec3::ZERO, Vec3::ZERO);
    for (node, weight) in GAUSS {
        let moment = at(path, gravity, t + node * dt);
        dtheta += moment.omega_ib_b * (weight * dt);
        dv += moment.f_b * (weight * dt);
    }
    Increments { dtheta, dv }
}

/// Distance of two positions, m: horizontal and vertical.
pub fn distance(a: &Pva, b: &Pva) -> (f64, f64) {
    let apart = b.position.local_ned(a.position.as_ecef());
    (apart[0].hypot(apart[1]), (a.position.h - b.position.h).abs())
}
