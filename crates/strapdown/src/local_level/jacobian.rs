//! The step on dual numbers: its exact derivative is what the error dynamics say.

use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use nalgebra::SMatrix;
use schuler_frames::{B, Geodetic, Gravity, Real, Rot, Vec3, wgs84};

use super::*;
use crate::{BaroLoop, ErrorDynamics};

/// Errors and sensor errors by which everything is differentiated at once: ten and six.
const N: usize = 16;

#[derive(Clone, Copy, Debug)]
struct Dual(f64, [f64; N]);

macro_rules! operators {
    ($($op:ident $f:ident: |$a:ident, $b:ident| $value:expr, |$k:ident| $slope:expr;)*) => {$(
        impl $op for Dual {
            type Output = Dual;
            fn $f(self, o: Dual) -> Dual {
                let ($a, $b) = (self, o);
                Dual($value, core::array::from_fn(|$k| $slope))
            }
        }
        impl $op<f64> for Dual {
            type Output = Dual;
            fn $f(self, c: f64) -> Dual {
                $op::$f(self, Dual(c, [0.0; N]))
            }
        }
    )*};
}

operators! {
    Add add: |a, b| a.0 + b.0, |k| a.1[k] + b.1[k];
    Sub sub: |a, b| a.0 - b.0, |k| a.1[k] - b.1[k];
    Mul mul: |a, b| a.0 * b.0, |k| product_rule(a, b, k);
}

fn product_rule(a: Dual, b: Dual, k: usize) -> f64 {
    a.1[k] * b.0 + a.0 * b.1[k]
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(0.0, [0.0; N]) - self
    }
}

impl AddAssign for Dual {
    fn add_assign(&mut self, o: Dual) {
        *self = *self + o;
    }
}

impl SubAssign for Dual {
    fn sub_assign(&mut self, o: Dual) {
        *self = *self - o;
    }
}

impl Real for Dual {
    fn lift(self, c: f64) -> Dual {
        Dual(c, [0.0; N])
    }
}

/// `value` that changes with the input `k` at the rate `slope`.
fn along(value: f64, k: usize, slope: f64) -> Dual {
    let mut d = Dual(value, [0.0; N]);
    d.1[k] = slope;
    d
}

fn start() -> Pva {
    let q = Rot::<T, B>::claim([0.8, 0.3, -0.2, 0.4]).normalized();
    Pva { position: Geodetic::new(0.7, 0.3, 4000.0), v_t: Vec3::new(180.0, -90.0, 7.0), c_tb: q }
}

/// Derivative of one step of `dt` (s) with the ten errors and the six sensor errors.
fn derivative(vertical: Vertical, f_b: Vec3<B>, omega: Vec3<B>, dt: f64) -> SMatrix<f64, 10, N> {
    let pva = start();
    let nav = LocalLevel::new(&pva, Gravity::Normal, vertical);
    let zero = Dual(0.0, [0.0; N]);
    let metres = |p: Geodetic| {
        let (s, c) = libm::sincos(p.lat);
        [wgs84::r_m(s) + p.h, (wgs84::r_n(s) + p.h) * c, -1.0]
    };
    let at_start = metres(pva.position);
    let v = pva.v_t.as_array();
    // C_computed = exp(-[phi ×]) C_true: the quaternion changes by -(0, phi) ⊗ q / 2.
    let [w, x, y, z] = pva.c_tb.as_quaternion();
    let mut q = [w, x, y, z].map(|c| zero.lift(c));
    for (k, row) in [[x, -w, z, -y], [y, -z, -w, x], [z, y, -x, -w]].iter().enumerate() {
        for (part, slope) in q.iter_mut().zip(row) {
            part.1[6 + k] = 0.5 * slope;
        }
    }
    let mut nav = LocalLevel {
        q_tb: Quaternion::new(q),
        v_t: Vec3::claim(core::array::from_fn(|k| along(v[k], 3 + k, 1.0))),
        anchor: nav.anchor.map(&mut |x| zero.lift(x)),
        way: core::array::from_fn(|k| along(0.0, k, 1.0 / at_start[k])),
        age: 0.0,
        a_free: Vec3::new(zero, zero, zero),
        omega_it: Vec3::new(zero, zero, zero),
        baro_a: along(0.0, 9, 1.0),
        vertical,
        gravity: Gravity::Normal,
    };
    let still = Vec3::new(zero, zero, zero);
    nav.advance_kernel(&BodyMotion { sigma: still, dv: still }, 0.0);
    let sensed = |x: Vec3<B>, first: usize| {
        Vec3::<B, Dual>::claim(core::array::from_fn(|k| along(x[k] * dt, first + k, dt)))
    };
    nav.advance_kernel(&BodyMotion::of(&Increments { dtheta: sensed(omega, 10), dv: sensed(f_b, 13) }), dt);

    let p = pva.position;
    let at_end = metres(Geodetic::new(p.lat + nav.way[0].0, p.lon + nav.way[1].0, p.h + nav.way[2].0));
    let q = nav.q_tb.rot::<T, B>().as_quaternion();
    let [w, x, y, z] = q.map(|c| c.0);
    SMatrix::from_fn(|row, k| match row {
        0..3 => nav.way[row].1[k] * at_end[row],
        3..6 => nav.v_t[row - 3].1[k],
        6..9 => {
            let [dw, dx, dy, dz] = q.map(|c| c.1[k]);
            let turn = [
                dx * w - dw * x - dy * z + dz * y,
                dy * w - dw * y - dz * x + dx * z,
                dz * w - dw * z - dx * y + dy * x,
            ];
            -2.0 * turn[row - 6]
        }
        _ => nav.baro_a.1[k],
    })
}

/// The derivative of a step is the transition of the error dynamics but for the third order of the step: half the step
/// leaves an eighth of the deviation, in every block that is not the same to 1e-9 anyhow.
#[test]
fn derivative_of_a_step_is_the_transition() {
    let omega = Vec3::<B>::new(0.05, -0.1, 0.2);
    let f_b = Vec3::<B>::new(1.0, -2.0, -11.0);
    let baro = BaroLoop::third_order(30.0, 3e-6, 3990.0);
    for vertical in [Vertical::Free, Vertical::Held, Vertical::Damped(baro)] {
        let dynamics = ErrorDynamics { gravity: Gravity::Normal, vertical };
        let off = |dt: f64| {
            let exact = derivative(vertical, f_b, omega, dt);
            // State and force in the middle of the step.
            let mut nav = LocalLevel::new(&start(), Gravity::Normal, vertical);
            nav.step(&Increments { dtheta: omega * (0.5 * dt), dv: f_b * (0.5 * dt) }, 0.5 * dt);
            let step = dynamics.transition_at_middle(&nav.pva(), f_b, dt);
            let mut all = SMatrix::<f64, 10, N>::zeros();
            all.fixed_view_mut::<10, 10>(0, 0).copy_from(&step.phi);
            all.fixed_view_mut::<10, 6>(0, 10).copy_from(&step.gamma);
            (exact - all, all)
        };
        let ((coarse, phi), (fine, _)) = (off(0.2), off(0.1));
        // Blocks of one kind of error each: position, velocity, attitude, baro; gyro, accelerometer.
        let rows = [(0, 3), (3, 3), (6, 3), (9, 1)];
        let columns = rows.into_iter().chain([(10, 3), (13, 3)]);
        for (column, columns) in columns {
            for (row, rows) in rows {
                let norm = |m: &SMatrix<f64, 10, N>| m.view((row, column), (rows, columns)).norm();
                let (c, f) = (norm(&coarse), norm(&fine));
                assert!(
                    c <= 1e-9 * norm(&phi) || c / f > 7.0,
                    "{vertical:?}: block at ({row}, {column}) of size {:e}: off by {c:e}, {f:e}",
                    norm(&phi)
                );
            }
        }
    }
}
