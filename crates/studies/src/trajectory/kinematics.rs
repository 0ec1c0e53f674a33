//! Where a body is, how it moves and how it turns, against the Earth.

use schuler_frames::{B, E, Geodetic, Rot, T, Vec3, wgs84};

use super::Jet;

/// Pose and its derivatives at one time, against the Earth. Everywhere on the Earth: nothing here needs a north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinematics {
    /// Geodetic position.
    pub position: Geodetic,
    /// Velocity against e, resolved in t, m/s.
    pub v_t: Vec3<T>,
    /// Acceleration against e, the second derivative of r_e, resolved in t, m/s².
    pub a_t: Vec3<T>,
    /// Attitude, body to local level.
    pub c_tb: Rot<T, B>,
    /// Rate of b against e, resolved in b, rad/s.
    pub omega_eb_b: Vec3<B>,
    /// Its derivative, rad/s².
    pub alpha_eb_b: Vec3<B>,
}

/// How a body stands and turns against local level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// Attitude, body to local level.
    pub c_tb: Rot<T, B>,
    /// Rate of b against t, resolved in b, rad/s.
    pub omega_tb_b: Vec3<B>,
    /// Its derivative, rad/s².
    pub alpha_tb_b: Vec3<B>,
}

/// Where a body is and how it moves over the Earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Geodetic position.
    pub position: Geodetic,
    /// Velocity against e, resolved in t, m/s.
    pub v_t: Vec3<T>,
    /// Acceleration against e, the second derivative of r_e, resolved in t, m/s².
    pub a_t: Vec3<T>,
    /// omega_et^t (rad/s) and the derivative of its components (rad/s²); without meaning at a pole.
    transport: [Vec3<T>; 2],
}

impl Stance {
    /// Not turning.
    pub fn still(c_tb: Rot<T, B>) -> Self {
        Stance { c_tb, omega_tb_b: Vec3::ZERO, alpha_tb_b: Vec3::ZERO }
    }

    /// From roll, pitch and yaw (rad) and their derivatives.
    pub fn from_euler(roll: Jet, pitch: Jet, yaw: Jet) -> Self {
        let [half_roll, half_pitch, half_yaw] = [roll, pitch, yaw].map(|a| libm::sincos(0.5 * a.value()));
        let c_tb = of_halves(half_roll, half_pitch, half_yaw);
        let whole = |(s, c): (f64, f64)| (2.0 * s * c, (c - s) * (c + s));
        let ((sr, cr), (sp, cp)) = (whole(half_roll), whole(half_pitch));
        // First and second derivatives.
        let (r1, p1, y1) = (roll.rate(), pitch.rate(), yaw.rate());
        let (r2, p2, y2) = (roll.acceleration(), pitch.acceleration(), yaw.acceleration());
        // Rates of yaw about down, of pitch about the axis that was right before the roll, of roll about forward.
        let omega_tb_b = Vec3::new(r1 - y1 * sp, p1 * cr + y1 * cp * sr, y1 * cp * cr - p1 * sr);
        let alpha_tb_b = Vec3::new(
            r2 - y2 * sp - y1 * p1 * cp,
            p2 * cr - p1 * r1 * sr + y2 * cp * sr - y1 * p1 * sp * sr + y1 * r1 * cp * cr,
            y2 * cp * cr - y1 * p1 * sp * cr - y1 * r1 * cp * sr - p2 * sr - p1 * r1 * cr,
        );
        Stance { c_tb, omega_tb_b, alpha_tb_b }
    }

    /// A body that turns by `angle` (rad) about the axis `axis` of `c_tb` (unit vector, the same in both).
    pub fn about(c_tb: Rot<T, B>, axis: Vec3<B>, angle: Jet) -> Self {
        Stance {
            c_tb: c_tb * Rot::<B, B>::from_rotation_vector(axis * angle.value()),
            omega_tb_b: axis * angle.rate(),
            alpha_tb_b: axis * angle.acceleration(),
        }
    }
}

/// [`Rot::from_euler`] from sines and cosines of half the angles, which serve for more than that.
fn of_halves((sr, cr): (f64, f64), (sp, cp): (f64, f64), (sy, cy): (f64, f64)) -> Rot<T, B> {
    Rot::claim([
        cy * cp * cr + sy * sp * sr,
        cy * cp * sr - sy * sp * cr,
        cy * sp * cr + sy * cp * sr,
        sy * cp * cr - cy * sp * sr,
    ])
}

impl Place {
    /// At rest on the Earth.
    pub fn still(position: Geodetic) -> Self {
        Place { position, v_t: Vec3::ZERO, a_t: Vec3::ZERO, transport: [Vec3::ZERO; 2] }
    }

    /// From the Earth-fixed position (m).
    pub fn from_ecef(r_e: [Jet; 3]) -> Self {
        let [r, v, a] =
            [Jet::value, Jet::rate, Jet::acceleration].map(|part| Vec3::claim(r_e.map(|x| part(&x))));
        Place::from_e(r, v, a)
    }

    /// From position (m), velocity (m/s) and acceleration (m/s²) against e, resolved in e.
    pub fn from_e(r_e: Vec3<E>, v_e: Vec3<E>, a_e: Vec3<E>) -> Self {
        let position = Geodetic::from_ecef(r_e);
        let c_te = position.c_et().inverse().as_dcm();
        let (v_t, a_t) = (c_te * v_e, c_te * a_e);
        let transport = transport(position, v_t, |omega| a_t - omega.cross(v_t));
        Place { position, v_t, a_t, transport }
    }

    /// From the position, the velocity and the derivatives of its components north, east and down (m/s²); not at a pole.
    pub fn from_velocity(position: Geodetic, v_t: Vec3<T>, v_dot: Vec3<T>) -> Self {
        let transport = transport(position, v_t, |_| v_dot);
        Place { position, v_t, a_t: v_dot + transport[0].cross(v_t), transport }
    }
}

/// omega_et^t (rad/s) and the derivative of its components (rad/s²) from the velocity and the derivatives of its
/// components, which may depend on omega_et^t.
fn transport(position: Geodetic, v_t: Vec3<T>, v_dot: impl FnOnce(Vec3<T>) -> Vec3<T>) -> [Vec3<T>; 2] {
    let (s, c) = libm::sincos(position.lat);
    let w = wgs84::w(s);
    let (r_n, r_m) = (wgs84::A * w, wgs84::A * (1.0 - wgs84::E2) * w * w * w);
    let (per_n, per_m) = (1.0 / (r_n + position.h), 1.0 / (r_m + position.h));
    let [v_n, v_e, v_d] = v_t.as_array();
    let (north, east, tan) = (v_e * per_n, -v_n * per_m, s / c);
    let omega = Vec3::new(north, east, -north * tan);

    let [a_n, a_e, _] = v_dot(omega).as_array();
    // dR_N/dL = R_N e² s c w², dR_M/dL three times that of R_M.
    let (lat, slope) = (-east, wgs84::E2 * s * c * w * w);
    let north_dot = (a_e - north * (r_n * slope * lat - v_d)) * per_n;
    let east_dot = -(a_n - lat * (3.0 * r_m * slope * lat - v_d)) * per_m;
    [omega, Vec3::new(north_dot, east_dot, -north_dot * tan - north * lat / (c * c))]
}

impl Kinematics {
    /// From motion over the Earth and attitude against local level. Where the body moves, not at a pole.
    pub fn new(place: Place, stance: Stance) -> Self {
        let Place { position, v_t, a_t, transport: [omega_et_t, omega_dot] } = place;
        let Stance { c_tb, omega_tb_b, alpha_tb_b } = stance;
        let c_bt = c_tb.inverse().as_dcm();
        let omega_et_b = c_bt * omega_et_t;
        Kinematics {
            position,
            v_t,
            a_t,
            c_tb,
            omega_eb_b: omega_tb_b + omega_et_b,
            alpha_eb_b: alpha_tb_b + c_bt * omega_dot - omega_tb_b.cross(omega_et_b),
        }
    }
}
