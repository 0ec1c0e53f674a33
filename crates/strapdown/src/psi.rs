//! The psi form of the error dynamics: errors against the frame of the computed place.

use nalgebra::{SMatrix, Vector3};
use schuler_frames::earth::{omega_et_t, omega_ie_t};
use schuler_frames::{B, Dcm, T, Vec3, wgs84};

use crate::error_dynamics::{ATTITUDE, D, POSITION, VELOCITY};
use crate::{ErrorDynamics, Pva, System, Vertical};

/// The first-order map between the two forms at a state `pva`.
///
/// A position error turns the local level frame of the computed place (c) against that of the true one by
///
/// ```text
/// dtheta = (dr_E / (R_N + h), -dr_N / (R_M + h), -dr_E tan L / (R_N + h))
/// ```
///
/// and the psi form gives its errors against what is true, resolved in c:
/// `dr` as it is, `dv_psi = dv + dtheta × v`, `psi = phi - dtheta`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PsiMap {
    /// phi form to psi form, 9 × 9.
    pub psi_from_phi: SMatrix<f64, 9, 9>,
    /// psi form to phi form, 9 × 9: its inverse.
    pub phi_from_psi: SMatrix<f64, 9, 9>,
}

/// dtheta from dr, rad/m.
fn dtheta(pva: &Pva) -> SMatrix<f64, 3, 3> {
    let (s, c) = libm::sincos(pva.position.lat);
    let per_r_m = 1.0 / (wgs84::r_m(s) + pva.position.h);
    let per_r_n = 1.0 / (wgs84::r_n(s) + pva.position.h);
    let mut m = SMatrix::zeros();
    m[(0, 1)] = per_r_n;
    m[(1, 0)] = -per_r_m;
    m[(2, 1)] = -per_r_n * s / c;
    m
}

impl PsiMap {
    /// The map at `pva`.
    pub fn new(pva: &Pva) -> Self {
        let turn = dtheta(pva);
        let dv = -pva.v_t.skew() * turn;
        let map = |sign: f64| {
            let mut m = SMatrix::<f64, 9, 9>::identity();
            m.fixed_view_mut::<3, 3>(VELOCITY, POSITION).copy_from(&(dv * sign));
            m.fixed_view_mut::<3, 3>(ATTITUDE, POSITION).copy_from(&(turn * -sign));
            m
        };
        PsiMap { psi_from_phi: map(1.0), phi_from_psi: map(-1.0) }
    }
}

impl ErrorDynamics {
    /// The psi form at a state `pva` under the specific force `f_b` (m/s², body axes), complete to first order.
    ///
    /// It is the error of the equations in e, where nothing but attitude, gravity and Coriolis acceleration
    /// depends on the state, resolved in t, which turns with rho against e:
    ///
    /// ```text
    /// psi' = -omega_it × psi - C eps
    /// dv'  = f_t × psi - (2 omega_ie + rho) × dv + (dg/dr) dr + C nabla
    /// dr'  = dv - rho × dr
    /// ```
    ///
    /// Same order of states as [`ErrorDynamics::system`]; [`PsiMap`] leads from one to the other. With
    /// [`Vertical::Held`] the vertical velocity error is no state of its own: that of the phi form is zero, so
    /// that here it is the vertical part of `dtheta × v`, which the position error carries. Its row is zero. With
    /// [`Vertical::Damped`] the acceleration that the loop feeds back is taken as small against gravity.
    pub fn system_psi(&self, pva: &Pva, f_b: Vec3<B>) -> System {
        let (s, c) = libm::sincos(pva.position.lat);
        let omega_ie = omega_ie_t(s, c).as_vec3();
        let omega_et = omega_et_t(pva.v_t, pva.position).as_vec3();
        let c_tb: Dcm<T, B> = pva.c_tb.as_dcm();
        let turn = dtheta(pva);

        // The change of gravity in axes that move along, and the turn of those axes.
        let (dg_dlat, dg_dh) = self.gravity.gradient_t(pva.position);
        let dg = SMatrix::<f64, 3, 3>::from_columns(&[
            dg_dlat.as_nalgebra() * -turn[(1, 0)],
            Vector3::zeros(),
            -dg_dh.as_nalgebra(),
        ]) - self.gravity.gravity_t(pva.position).skew() * turn;

        // What acts along the vertical acts along that of the computed place: height taken back, and the floor of a held
        // channel, which balances all other acceleration down.
        let down = Vec3::<T>::new(0.0, 0.0, 1.0).skew();
        let coriolis = (omega_ie * 2.0 + omega_et).cross(pva.v_t);
        let floor = match self.vertical {
            Vertical::Held => coriolis[D] - (c_tb * f_b)[D] - self.gravity.gravity_t(pva.position)[D],
            Vertical::Free | Vertical::Damped(_) => 0.0,
        };
        let back = self.vertical.taken_back(pva);

        let mut f = SMatrix::<f64, 9, 9>::zeros();
        let mut block = |row: usize, column: usize, m: SMatrix<f64, 3, 3>| {
            f.fixed_view_mut::<3, 3>(row, column).copy_from(&m);
        };
        block(POSITION, POSITION, -omega_et.skew() - down * turn * back);
        block(POSITION, VELOCITY, SMatrix::identity());
        block(VELOCITY, POSITION, dg - down * turn * floor);
        block(VELOCITY, VELOCITY, -(omega_ie * 2.0 + omega_et).skew());
        block(VELOCITY, ATTITUDE, (c_tb * f_b).skew());
        block(ATTITUDE, ATTITUDE, -(omega_ie + omega_et).skew());
        let mut system = System::driven(f, c_tb);

        if self.vertical == Vertical::Held {
            // dv_D = (dtheta × v)_D
            let carried = (-pva.v_t.skew() * turn).row(D).into_owned();
            let from_vertical = system.f.column(VELOCITY + D).into_owned();
            let mut position = system.f.fixed_view_mut::<9, 3>(0, POSITION);
            position += from_vertical * carried;
            system.f.column_mut(VELOCITY + D).fill(0.0);
        }
        system.constrain(self.vertical);
        system
    }
}
