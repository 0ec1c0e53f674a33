//! Motions that test the algorithms for coning and sculling, with closed forms.

use std::f64::consts::TAU;

use schuler_frames::{B, E, Euler, Geodetic, Rot, T, Vec3};

use super::{Jet, Kinematics, Place, Stance, Trajectory};

/// Classical coning about an attitude: `C_b^t(t) = C q(t)` with
/// `q = [cos(a/2), 0, sin(a/2) cos(omega t), sin(a/2) sin(omega t)]`.
///
/// The body turns by the half angle `a` about an axis that goes round in its y-z plane. Its rate is
/// (-2 omega sin²(a/2), -omega sin(a) sin(omega t), omega sin(a) cos(omega t)): x senses a constant rate although
/// the body comes back to where it was. At t = 0 the body has already turned by `a` about y.
#[derive(Clone, Debug, PartialEq)]
pub struct Coning {
    place: Place,
    c_tb: Rot<T, B>,
    half_angle: f64,
    omega: f64,
}

impl Coning {
    /// About `attitude` at `position`, with the half angle of the cone (rad) and the frequency (Hz).
    pub fn new(position: Geodetic, attitude: Euler, half_angle: f64, frequency: f64) -> Self {
        let place = Place::still(position);
        Coning { place, c_tb: Rot::from_euler(attitude), half_angle, omega: TAU * frequency }
    }
}

impl Trajectory for Coning {
    fn at(&self, t: f64) -> Kinematics {
        let w = self.omega;
        let (s, c) = libm::sincos(w * t);
        let (sin_half, cos_half) = libm::sincos(0.5 * self.half_angle);
        let sin = libm::sin(self.half_angle);
        let cone: Rot<B, B> = Rot::claim([cos_half, 0.0, sin_half * c, sin_half * s]);
        let stance = Stance {
            c_tb: self.c_tb * cone,
            omega_tb_b: Vec3::new(-2.0 * w * sin_half * sin_half, -w * sin * s, w * sin * c),
            alpha_tb_b: Vec3::new(0.0, -w * w * sin * c, -w * w * sin * s),
        };
        Kinematics::new(self.place, stance)
    }

    fn fastest(&self, _: f64) -> f64 {
        self.omega.abs()
    }
}

/// Sculling: the body swings by `alpha sin(omega t)` about its x axis, and in step with that it is shaken by
/// `b sin(omega t)` along the direction that y has in the mean, which is a motion to and fro.
///
/// Gravity and Earth rate aside, the z axis senses -b sin(omega t) sin(alpha sin(omega t)), in the mean -b J1(alpha), although
/// the body stays where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Sculling {
    r_e: Vec3<E>,
    /// Direction of y in the mean.
    y_e: Vec3<E>,
    c_tb: Rot<T, B>,
    angle: f64,
    acceleration: f64,
    omega: f64,
}

impl Sculling {
    /// About `attitude` at `position`: amplitudes of the angle (rad) and of the acceleration (m/s²), frequency (Hz).
    pub fn new(position: Geodetic, attitude: Euler, angle: f64, acceleration: f64, frequency: f64) -> Self {
        let c_tb = Rot::from_euler(attitude);
        let y_e = position.c_et() * (c_tb * Vec3::<B>::new(0.0, 1.0, 0.0));
        Sculling { r_e: position.as_ecef(), y_e, c_tb, angle, acceleration, omega: TAU * frequency }
    }
}

impl Trajectory for Sculling {
    fn at(&self, t: f64) -> Kinematics {
        let w = self.omega;
        let (s, c) = libm::sincos(w * t);
        let swing = Jet([s, w * c, -0.5 * w * w * s]);
        let way = swing * (-self.acceleration / (w * w));
        let r_e = [0, 1, 2].map(|axis| way * self.y_e[axis] + self.r_e[axis]);
        let x = Vec3::<B>::new(1.0, 0.0, 0.0);
        Kinematics::new(Place::from_ecef(r_e), Stance::about(self.c_tb, x, swing * self.angle))
    }

    fn fastest(&self, _: f64) -> f64 {
        self.omega.abs() * (1.0 + self.angle.abs())
    }
}
