//! The navigation errors that a filter estimates.

use nalgebra::SMatrix;

use crate::{ErrorDynamics, PsiMap, Pva, System};
use schuler_frames::{B, Vec3};

/// One of the nine navigation errors, in the order of [`NavError::as_array`](crate::NavError::as_array).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NavState {
    /// Position error north, m.
    PositionN,
    /// Position error east, m.
    PositionE,
    /// Position error down, m.
    PositionD,
    /// Velocity error north, m/s.
    VelocityN,
    /// Velocity error east, m/s.
    VelocityE,
    /// Velocity error down, m/s.
    VelocityD,
    /// Attitude error north (a tilt), rad.
    AttitudeN,
    /// Attitude error east (a tilt), rad.
    AttitudeE,
    /// Attitude error down (heading), rad.
    AttitudeD,
}

impl NavState {
    /// All nine, in their order.
    pub const ALL: [NavState; 9] = {
        use NavState::*;
        [PositionN, PositionE, PositionD, VelocityN, VelocityE, VelocityD, AttitudeN, AttitudeE, AttitudeD]
    };

    /// Name in reports: `dr_n`, `dv_e`, `phi_d`, or `psi_d` in the psi form.
    pub const fn name(self, form: Form) -> &'static str {
        const PHI: [&str; 9] = ["dr_n", "dr_e", "dr_d", "dv_n", "dv_e", "dv_d", "phi_n", "phi_e", "phi_d"];
        const PSI: [&str; 3] = ["psi_n", "psi_e", "psi_d"];
        match (form, self as usize) {
            (Form::Psi, k @ 6..) => PSI[k - 6],
            (_, k) => PHI[k],
        }
    }
}

/// The form of the error dynamics that a filter is built on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Errors against the true local level frame: [`ErrorDynamics::system`].
    #[default]
    Phi,
    /// Errors against the frame of the computed place: [`ErrorDynamics::system_psi`].
    Psi,
}

impl Form {
    /// The dynamics of this form at `pva` under the specific force `f_b` (m/s², body axes).
    pub fn system(self, dynamics: &ErrorDynamics, pva: &Pva, f_b: Vec3<B>) -> System {
        match self {
            Form::Phi => dynamics.system(pva, f_b),
            Form::Psi => dynamics.system_psi(pva, f_b),
        }
    }

    /// The matrix that takes the nine errors of this form to those of the phi form, at `pva`.
    pub fn to_phi(self, pva: &Pva) -> SMatrix<f64, 9, 9> {
        match self {
            Form::Phi => SMatrix::identity(),
            Form::Psi => PsiMap::new(pva).phi_from_psi,
        }
    }

    /// The matrix that takes the nine errors of the phi form to those of this form, at `pva`.
    pub fn from_phi(self, pva: &Pva) -> SMatrix<f64, 9, 9> {
        match self {
            Form::Phi => SMatrix::identity(),
            Form::Psi => PsiMap::new(pva).psi_from_phi,
        }
    }
}

/// A choice among the nine navigation errors. An error that is left out is taken as zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NavStates(u16);

impl NavStates {
    /// All nine.
    pub const ALL: NavStates = NavStates(0b111_111_111);
    /// All but the vertical channel, for [`Vertical::Held`](crate::Vertical::Held): seven errors.
    pub const HELD: NavStates = NavStates(0b111_011_011);
    /// Velocity and attitude: six errors.
    pub const NO_POSITION: NavStates = NavStates(0b111_111_000);
    /// North and east velocity and attitude, for alignment at a known place: five errors.
    pub const LEVEL: NavStates = NavStates(0b111_011_000);

    /// The errors named.
    pub const fn of(list: &[NavState]) -> NavStates {
        let (mut mask, mut k) = (0, 0);
        while k < list.len() {
            mask |= 1 << list[k] as usize;
            k += 1;
        }
        NavStates(mask)
    }

    /// Number of errors chosen.
    pub const fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether none is chosen.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether `state` is among them.
    pub const fn contains(self, state: NavState) -> bool {
        self.0 & (1 << state as usize) != 0
    }

    /// Those chosen, in the order of [`NavState::ALL`].
    pub fn iter(self) -> impl Iterator<Item = NavState> {
        NavState::ALL.into_iter().filter(move |s| self.contains(*s))
    }
}
