//! Linear error dynamics of the local-level navigator, phi form, complete to first order.

use nalgebra::{SMatrix, Vector3};
use schuler_frames::earth::{omega_ie_t, transport};
use schuler_frames::{B, Dcm, Gravity, T, Vec3, wgs84};

use crate::{Pva, Vertical};

/// The navigation half of a linear error model: `x' = f x + b_gyro eps_b + b_accel nabla_b`.
///
/// State order: position error N, E, D (m, by the radii), velocity error N, E, D (m/s), attitude
/// error phi N, E, D (rad): the order of [`NavError::as_array`](crate::NavError::as_array).
/// `eps_b` (rad/s) and `nabla_b` (m/s²) are the errors of the gyro and of the accelerometer along body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct System {
    /// Dynamics of the nine errors, 9 × 9.
    pub f: SMatrix<f64, 9, 9>,
    /// How a gyro error along body axes enters, 9 × 3.
    pub b_gyro: SMatrix<f64, 9, 3>,
    /// How an accelerometer error along body axes enters, 9 × 3.
    pub b_accel: SMatrix<f64, 9, 3>,
}

/// Linear error dynamics of [`LocalLevel`](crate::LocalLevel).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorDynamics {
    /// Gravity that the navigator computes with.
    pub gravity: Gravity,
    /// What is done about the vertical channel. [`Vertical::Damped`] is taken by its gains k1 and k2;
    /// the loop's own state (k3) is the caller's to append.
    pub vertical: Vertical,
}

pub(crate) const POSITION: usize = 0;
pub(crate) const VELOCITY: usize = 3;
pub(crate) const ATTITUDE: usize = 6;
pub(crate) const D: usize = 2;

impl ErrorDynamics {
    /// The system at a state `pva` under the specific force `f_b` (m/s², body axes).
    ///
    /// With `rho` the transport rate and every first-order term kept:
    ///
    /// ```text
    /// phi' = -omega_it × phi + d omega_ie + d rho - C eps
    /// dv'  = f_t × phi - (2 omega_ie + rho) × dv - (2 d omega_ie + d rho) × v + dg + C nabla
    /// dr'  = dv + the change of the metric along the motion
    /// ```
    pub fn system(&self, pva: &Pva, f_b: Vec3<B>) -> System {
        let position = pva.position;
        let (s, c) = libm::sincos(position.lat);
        let tan = s / c;
        let r_m = wgs84::r_m(s) + position.h;
        let r_n = wgs84::r_n(s) + position.h;
        // dR_M/dL = 3 R_M0 e² s c w²; dR_N/dL = (R_N - R_M) tan L.
        let w = wgs84::w(s);
        let r_m_slope = 3.0 * wgs84::r_m(s) * wgs84::E2 * s * c * w * w;
        let r_n_slope = (r_n - r_m) * tan;
        let [v_n, v_e, v_d] = pva.v_t.as_array();
        let omega_ie = omega_ie_t(s, c);
        let omega_et = transport(pva.v_t, 1.0 / r_m, 1.0 / r_n, tan);
        let omega_it = (omega_et + omega_ie).as_vec3();
        let c_tb: Dcm<T, B> = pva.c_tb.as_dcm();
        let f_t = c_tb * f_b;

        // Change of Earth rate and transport rate with position (per metre N and D) and velocity.
        let o = wgs84::OMEGA;
        let d_omega_ie = SMatrix::<f64, 3, 3>::new(
            -o * s / r_m,
            0.0,
            0.0, //
            0.0,
            0.0,
            0.0, //
            -o * c / r_m,
            0.0,
            0.0,
        );
        let east = v_e / r_n;
        let north = v_n / r_m;
        // dh = -x_D, dL = x_N / R_M
        let d_rho_dr = SMatrix::<f64, 3, 3>::new(
            -east * r_n_slope / (r_n * r_m),
            0.0,
            east / r_n, //
            north * r_m_slope / (r_m * r_m),
            0.0,
            -north / r_m, //
            (-east / (c * c) + east * tan * r_n_slope / r_n) / r_m,
            0.0,
            -east * tan / r_n,
        );
        let d_rho_dv = SMatrix::<f64, 3, 3>::new(
            0.0,
            1.0 / r_n,
            0.0, //
            -1.0 / r_m,
            0.0,
            0.0, //
            0.0,
            -tan / r_n,
            0.0,
        );
        let (dg_dlat, dg_dh) = self.gravity.gradient_t(position);
        let dg = SMatrix::<f64, 3, 3>::from_columns(&[
            dg_dlat.as_nalgebra() / r_m,
            Vector3::zeros(),
            -dg_dh.as_nalgebra(),
        ]);
        // A metre is a smaller angle the higher one is: what counts is how the height changes.
        let sink = v_d + self.vertical.taken_back(pva);
        let metric = SMatrix::<f64, 3, 3>::new(
            -sink / r_m,
            0.0,
            north, //
            east * tan,
            -(tan * v_n + sink) / r_n,
            east, //
            0.0,
            0.0,
            0.0,
        );

        let v_cross = pva.v_t.as_nalgebra().cross_matrix();
        let coriolis = (omega_it + omega_ie.as_vec3()).as_nalgebra().cross_matrix();
        let mut f = SMatrix::<f64, 9, 9>::zeros();
        let mut block = |row: usize, column: usize, m: SMatrix<f64, 3, 3>| {
            f.fixed_view_mut::<3, 3>(row, column).copy_from(&m);
        };
        block(POSITION, POSITION, metric);
        block(POSITION, VELOCITY, SMatrix::identity());
        // -(2 d omega_ie + d rho) × v = v × (2 d omega_ie + d rho)
        block(VELOCITY, POSITION, v_cross * (d_omega_ie * 2.0 + d_rho_dr) + dg);
        block(VELOCITY, VELOCITY, v_cross * d_rho_dv - coriolis);
        block(VELOCITY, ATTITUDE, f_t.as_nalgebra().cross_matrix());
        block(ATTITUDE, POSITION, d_omega_ie + d_rho_dr);
        block(ATTITUDE, VELOCITY, d_rho_dv);
        block(ATTITUDE, ATTITUDE, -omega_it.as_nalgebra().cross_matrix());

        let mut system = System::driven(f, c_tb);
        system.constrain(self.vertical);
        system
    }
}

impl System {
    /// The dynamics `f` with sensor errors entering by the attitude.
    pub(crate) fn driven(f: SMatrix<f64, 9, 9>, c_tb: Dcm<T, B>) -> Self {
        let c_tb = c_tb.as_nalgebra();
        let mut b_gyro = SMatrix::<f64, 9, 3>::zeros();
        b_gyro.fixed_view_mut::<3, 3>(ATTITUDE, 0).copy_from(&-c_tb);
        let mut b_accel = SMatrix::<f64, 9, 3>::zeros();
        b_accel.fixed_view_mut::<3, 3>(VELOCITY, 0).copy_from(&c_tb);
        System { f, b_gyro, b_accel }
    }

    /// What is done about the vertical channel.
    pub(crate) fn constrain(&mut self, vertical: Vertical) {
        let System { f, b_accel, .. } = self;
        match vertical {
            Vertical::Free => {}
            Vertical::Held => {
                f.row_mut(POSITION + D).fill(0.0);
                f.row_mut(VELOCITY + D).fill(0.0);
                b_accel.row_mut(VELOCITY + D).fill(0.0);
            }
            Vertical::Damped(baro) => {
                // Down is positive here: dh = -x_D.
                f[(POSITION + D, POSITION + D)] -= baro.k1;
                f[(VELOCITY + D, POSITION + D)] -= baro.k2;
            }
        }
    }
}
