//! The kernels run on any [`Real`]: on dual numbers they give exact derivatives, checked against theory.

use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use proptest::prelude::*;
use schuler_frames::{B, Rate, Real, Rot, T, Vec3, earth, somigliana, wgs84};

use crate::{rotations, vectors};

/// Value and derivative.
#[derive(Clone, Copy, Debug)]
struct Dual(f64, f64);

macro_rules! operators {
    ($($op:ident $f:ident: |$a:ident, $b:ident| $e:expr;)*) => {$(
        impl $op for Dual {
            type Output = Dual;
            fn $f(self, o: Dual) -> Dual {
                let ($a, $b) = (self, o);
                $e
            }
        }
        impl $op<f64> for Dual {
            type Output = Dual;
            fn $f(self, c: f64) -> Dual {
                $op::$f(self, Dual(c, 0.0))
            }
        }
    )*};
}

operators! {
    Add add: |a, b| Dual(a.0 + b.0, a.1 + b.1);
    Sub sub: |a, b| Dual(a.0 - b.0, a.1 - b.1);
    Mul mul: |a, b| Dual(a.0 * b.0, a.1 * b.0 + a.0 * b.1);
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(-self.0, -self.1)
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
        Dual(c, 0.0)
    }
}

/// The numbers `value` that change at `derivative`.
fn moving<const N: usize>(value: [f64; N], derivative: [f64; N]) -> [Dual; N] {
    core::array::from_fn(|i| Dual(value[i], derivative[i]))
}

fn derivative<const N: usize>(x: [Dual; N]) -> [f64; N] {
    x.map(|d| d.1)
}

proptest! {
    #![proptest_config(crate::laws())]

    /// C_b^t' = C_b^t [omega_tb^b ×] and q' = q ⊗ (0, omega_tb^b) / 2 are one statement.
    #[test]
    fn a_rotation_changes_at_its_rate(q in rotations::<T, B>(), omega in vectors::<B>(1.0), v in vectors::<B>(1.0)) {
        let [x, y, z] = omega.as_array().map(|c| 0.5 * c);
        let q_dot = (Rot::<T, B>::claim(q.as_quaternion()) * Rot::<B, B>::claim([0.0, x, y, z])).as_quaternion();
        let c_tb = Rot::<T, B, Dual>::claim(moving(q.as_quaternion(), q_dot));
        let still = Vec3::<B, Dual>::claim(moving(v.as_array(), [0.0; 3]));
        let change = Vec3::<T>::claim(derivative((c_tb * still).as_array()));
        let omega_tb_t: Rate<B, T, T> = q * Rate::claim(omega);
        prop_assert!((change - omega_tb_t.as_vec3().cross(q * v)).norm() < 2e-14);
        let same = Vec3::<T>::claim(derivative((c_tb.as_dcm() * still).as_array()));
        prop_assert!((change - same).norm() < 1e-15);
        let back = Vec3::<B>::claim(derivative((c_tb.inverse() * (c_tb * still)).as_array()));
        prop_assert!(back.norm() < 2e-14);
    }

    /// Somigliana's analytic gradient, term by term.
    #[test]
    fn gravity_changes_at_its_gradient(lat in -1.57..1.57f64, h in -1e4..5e4) {
        let (s, c) = lat.sin_cos();
        let w = wgs84::w(s);
        let (dlat, dh) = somigliana::gradient(s, c, h, w);
        // dw/dL = e² sin L cos L w³
        let (sin2, w_dual) = (Dual(s * s, 2.0 * s * c), Dual(w, wgs84::E2 * s * c * w * w * w));
        let along_lat = somigliana::gamma(sin2, Dual(h, 0.0), w_dual);
        let along_h = somigliana::gamma(Dual(s * s, 0.0), Dual(h, 1.0), Dual(w, 0.0));
        prop_assert!((along_lat.1 - dlat).abs() < 1e-16 && (along_h.1 - dh).abs() < 1e-20);
    }

    /// Transport rate is linear in velocity: its derivative is its value at the acceleration.
    #[test]
    fn transport_rate_changes_with_velocity(lat in -1.5..1.5f64, v in vectors::<T>(300.0), a in vectors::<T>(10.0)) {
        let (s, c) = lat.sin_cos();
        let (m, n, tan) = (1.0 / wgs84::r_m(s), 1.0 / wgs84::r_n(s), s / c);
        let fixed = |x: f64| Dual(x, 0.0);
        let moving = Vec3::<T, Dual>::claim(moving(v.as_array(), a.as_array()));
        let rate = earth::transport(moving, fixed(m), fixed(n), fixed(tan)).as_vec3();
        let want = earth::transport(a, m, n, tan).as_vec3();
        prop_assert!((Vec3::<T>::claim(derivative(rate.as_array())) - want).norm() < 1e-18);
    }
}
