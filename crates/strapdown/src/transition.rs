//! Propagation of linear errors along a motion, step by step.

use nalgebra::SMatrix;
use schuler_frames::{B, Vec3};

use crate::error_dynamics::{D, POSITION, VELOCITY};
use crate::{ErrorDynamics, Pva, Vertical};

const ERRORS: usize = 10;
const INPUTS: usize = 6;
const BARO: usize = 9;
/// Errors, and the sensor errors as states that stay.
const ALL: usize = ERRORS + INPUTS;

/// How errors pass one step: `x(t + dt) = phi x(t) + gamma u`.
///
/// x holds the nine errors of [`System`](crate::System) and, tenth, the error of the vertical acceleration that a
/// third-order baro loop estimates (m/s², up; zero without such a loop). u is the error of the gyro along body axes
/// (rad/s), then that of the accelerometer (m/s²), constant over the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    /// Transition matrix, 10 × 10.
    pub phi: SMatrix<f64, ERRORS, ERRORS>,
    /// Answer to constant sensor errors, 10 × 6.
    pub gamma: SMatrix<f64, ERRORS, INPUTS>,
}

impl ErrorDynamics {
    /// Where within a step, as a fraction of it, [`ErrorDynamics::transition`] wants the motion: the two nodes of Gauss.
    pub const NODES: [f64; 2] = [0.211_324_865_405_187_12, 0.788_675_134_594_812_9];

    /// The transition over a step `dt` (s) in phi form, from the state and the specific force (m/s², body
    /// axes) at the two [`NODES`](Self::NODES) of the step.
    ///
    /// Exponential of the Magnus series with its first commutator: fourth order in the step, and exact where
    /// nothing changes. Source: Blanes, Casas, Oteo and Ros, The Magnus expansion and some of its applications,
    /// Physics Reports 470 (2009).
    pub fn transition(&self, moments: [(&Pva, Vec3<B>); 2], dt: f64) -> Transition {
        let [a, b] = moments.map(|(pva, f_b)| self.all(pva, f_b) * dt);
        let commutator = b * a - a * b;
        // √3/12
        exponential(&((a + b) * 0.5 + commutator * 0.144_337_567_297_406_44))
    }

    /// The transition over a step `dt` (s) in phi form, from the state and the specific force (m/s², body axes) at the
    /// middle of the step: second order in the step.
    pub fn transition_at_middle(&self, pva: &Pva, f_b: Vec3<B>, dt: f64) -> Transition {
        exponential(&(self.all(pva, f_b) * dt))
    }

    /// The dynamics of errors and inputs together.
    fn all(&self, pva: &Pva, f_b: Vec3<B>) -> SMatrix<f64, ALL, ALL> {
        let system = self.system(pva, f_b);
        let mut all = SMatrix::<f64, ALL, ALL>::zeros();
        all.fixed_view_mut::<9, 9>(0, 0).copy_from(&system.f);
        all.fixed_view_mut::<9, 3>(0, ERRORS).copy_from(&system.b_gyro);
        all.fixed_view_mut::<9, 3>(0, ERRORS + 3).copy_from(&system.b_accel);
        if let Vertical::Damped(baro) = self.vertical {
            // a' = k3 dh and v_D' = ... + a, with dh = -x_D.
            all[(VELOCITY + D, BARO)] = 1.0;
            all[(BARO, POSITION + D)] = -baro.k3;
        }
        all
    }
}

/// exp(m) by scaling and squaring of its series.
fn exponential(m: &SMatrix<f64, ALL, ALL>) -> Transition {
    // In units in which every entry is of the size of a rate, a step of some seconds is far below one: metres by the Schuler
    // rate, radians by g over it. So the series is cut by what the Schuler, Earth and loop rates make of
    // the step, not by g.
    const W: f64 = 1.25e-3;
    const SCALE: [f64; ERRORS] = [W, W, W, 1.0, 1.0, 1.0, 9.8 / W, 9.8 / W, 9.8 / W, 1.0 / W];
    let unit = |k: usize| if k < ERRORS { SCALE[k] } else { 9.8 };
    let mut a = SMatrix::<f64, ALL, ALL>::from_fn(|r, k| m[(r, k)] * unit(r) / unit(k));
    let mut halvings = 0;
    let size = a.view((0, 0), (ERRORS, ERRORS)).norm();
    while libm::ldexp(size, -halvings) > 0.1 && halvings < 60 {
        halvings += 1;
    }
    a *= libm::ldexp(1.0, -halvings);
    // Nine terms leave 0.1^10 / 10! = 3e-17.
    let mut e = SMatrix::<f64, ALL, ALL>::identity();
    for n in (1..10).rev() {
        e = SMatrix::identity() + a * e * (1.0 / f64::from(n));
    }
    for _ in 0..halvings {
        e *= e;
    }
    Transition {
        phi: SMatrix::from_fn(|r, k| e[(r, k)] * unit(k) / unit(r)),
        gamma: SMatrix::from_fn(|r, k| e[(r, ERRORS + k)] * unit(ERRORS + k) / unit(r)),
    }
}
