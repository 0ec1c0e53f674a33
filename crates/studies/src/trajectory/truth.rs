//! What is true at one time and over one interval.

use schuler_frames::{B, E, Geodetic, Gravity, I, Rate, T, Vec3, earth::omega_ie_t, wgs84};
use schuler_strapdown::{Increments, Pva};

use super::{Kinematics, Trajectory, quadrature};

/// What is true at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Position, velocity over ground, attitude.
    pub pva: Pva,
    /// Acceleration against e, the second derivative of r_e, resolved in t, m/s².
    pub a_t: Vec3<T>,
    /// Specific force, m/s².
    pub f_b: Vec3<B>,
    /// Rate of the body against inertial space, rad/s.
    pub omega_ib_b: Rate<B, I, B>,
    /// Its derivative, rad/s².
    pub alpha_ib_b: Vec3<B>,
    /// Rate of the body against the Earth, rad/s.
    pub omega_eb_b: Vec3<B>,
}

/// A trajectory in a gravity field.
#[derive(Debug)]
pub struct Truth {
    trajectory: Box<dyn Trajectory>,
    gravity: Gravity,
}

/// Integrals over an interval.
struct Integrals {
    increments: Increments,
    /// Integral of the angular acceleration, rad/s.
    alpha: Vec3<B>,
}

impl Truth {
    /// The truth of `trajectory` in the field `gravity`.
    pub fn new(trajectory: impl Trajectory + 'static, gravity: Gravity) -> Self {
        Truth::boxed(Box::new(trajectory), gravity)
    }

    /// [`Truth::new`] of a trajectory that is boxed already.
    pub fn boxed(trajectory: Box<dyn Trajectory>, gravity: Gravity) -> Self {
        Truth { trajectory, gravity }
    }

    /// The motion.
    pub fn trajectory(&self) -> &dyn Trajectory {
        &*self.trajectory
    }

    /// The field.
    pub fn gravity(&self) -> Gravity {
        self.gravity
    }

    /// What is true at the time `t` (s).
    pub fn moment(&self, t: f64) -> Moment {
        let Kinematics { position, v_t, a_t, c_tb, omega_eb_b, alpha_eb_b } = self.trajectory.at(t);
        let (s, c) = libm::sincos(position.lat);
        let omega_ie = omega_ie_t(s, c).as_vec3();
        let c_bt = c_tb.inverse().as_dcm();
        let f_t = a_t + omega_ie.cross(v_t) * 2.0 - gravity_t(self.gravity, position, s, c);
        let omega_ie_b = c_bt * omega_ie;
        Moment {
            pva: Pva { position, v_t, c_tb },
            a_t,
            f_b: c_bt * f_t,
            omega_ib_b: Rate::claim(omega_eb_b + omega_ie_b),
            // Earth rate stays in e, so in b it turns back.
            omega_eb_b,
            alpha_ib_b: alpha_eb_b - omega_eb_b.cross(omega_ie_b),
        }
    }

    /// What a perfect IMU delivers over the interval from `t` to `t + dt` (s): integrals of omega_ib^b and
    /// of f^b in the turning body frame, to rounding.
    ///
    /// The interval is a length and not an end, because the difference of two times late in the day has lost the digits
    /// that an accelerometer counts: 1e-11 s at noon, 1e-7 m/s² at 1 kHz.
    pub fn increments(&self, t: f64, dt: f64) -> Increments {
        self.integrals(t, dt).increments
    }

    /// The same as the IMU model takes it, with the mean angular acceleration and the vibration of the trajectory.
    pub fn imu_truth(&self, t: f64, dt: f64) -> schuler_imu::Truth {
        let Integrals { increments, alpha } = self.integrals(t, dt);
        schuler_imu::Truth::increments(increments.dtheta.as_array(), increments.dv.as_array())
            .with_omega_dot((alpha * (1.0 / dt)).as_array())
            .with_vibration(self.trajectory.vibration())
    }

    fn integrals(&self, t: f64, dt: f64) -> Integrals {
        let mut increments = Increments { dtheta: Vec3::ZERO, dv: Vec3::ZERO };
        let mut alpha = Vec3::ZERO;
        let trajectory = self.trajectory();
        let fastest = |t: f64| trajectory.fastest(t);
        quadrature::nodes(t, dt, fastest, trajectory.joints(), |t, weight| {
            let moment = self.moment(t);
            increments.dtheta += moment.omega_ib_b.as_vec3() * weight;
            increments.dv += moment.f_b * weight;
            alpha += moment.alpha_ib_b * weight;
        });
        Integrals { increments, alpha }
    }
}

/// [`Gravity::gravity_t`] from sine and cosine of the latitude: the normal field is the same on each meridian, so the one
/// of longitude 0 spares the turn to and from e.
fn gravity_t(gravity: Gravity, position: Geodetic, s: f64, c: f64) -> Vec3<T> {
    match gravity {
        Gravity::Somigliana => gravity.gravity_t(position),
        Gravity::Normal => {
            let r_n = wgs84::r_n(s);
            let r = Vec3::<E>::new((r_n + position.h) * c, 0.0, ((1.0 - wgs84::E2) * r_n + position.h) * s);
            let [x, _, z] = gravity.gravity_e(r).as_array();
            Vec3::new(c * z - s * x, 0.0, -c * x - s * z)
        }
    }
}
