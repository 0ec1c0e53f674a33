//! Numbers that carry their derivatives with time.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A function of time about one instant: the first `N` coefficients of its Taylor series,
/// `f(t + s) = c0 + c1 s + c2 s² + …`, so that what is computed from exact derivatives has exact derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<const N: usize = 3>(pub [f64; N]);

impl<const N: usize> Jet<N> {
    /// What does not change.
    pub fn constant(value: f64) -> Self {
        Jet(std::array::from_fn(|k| if k == 0 { value } else { 0.0 }))
    }

    /// Time itself, at `t` (s).
    pub fn time(t: f64) -> Self {
        Jet(std::array::from_fn(|k| match k {
            0 => t,
            1 => 1.0,
            _ => 0.0,
        }))
    }

    /// The value.
    pub fn value(&self) -> f64 {
        self.0[0]
    }

    /// The first derivative, `N` of 2 or more.
    pub fn rate(&self) -> f64 {
        self.0[1]
    }

    /// The second derivative, `N` of 3 or more.
    pub fn acceleration(&self) -> f64 {
        2.0 * self.0[2]
    }

    /// The derivative as a jet; its last coefficient is not known and stands as zero.
    pub fn derivative(&self) -> Self {
        Jet(std::array::from_fn(|k| if k + 1 < N { (k + 1) as f64 * self.0[k + 1] } else { 0.0 }))
    }

    /// The jet with the value `value` and this derivative.
    pub fn integral(&self, value: f64) -> Self {
        Jet(std::array::from_fn(|k| if k == 0 { value } else { self.0[k - 1] / k as f64 }))
    }

    /// The first `M` coefficients.
    pub fn truncated<const M: usize>(&self) -> Jet<M> {
        Jet(std::array::from_fn(|k| self.0[k]))
    }

    /// Sine and cosine.
    pub fn sin_cos(self) -> (Self, Self) {
        let (mut s, mut c) = ([0.0; N], [0.0; N]);
        (s[0], c[0]) = libm::sincos(self.0[0]);
        for k in 1..N {
            let (mut ds, mut dc) = (0.0, 0.0);
            for j in 1..=k {
                let rate = j as f64 * self.0[j];
                ds += rate * c[k - j];
                dc -= rate * s[k - j];
            }
            (s[k], c[k]) = (ds / k as f64, dc / k as f64);
        }
        (Jet(s), Jet(c))
    }

    /// Square root of what is not zero.
    pub fn sqrt(self) -> Self {
        let mut root = [0.0; N];
        root[0] = libm::sqrt(self.0[0]);
        for k in 1..N {
            let products: f64 = (1..k).map(|j| root[j] * root[k - j]).sum();
            root[k] = (self.0[k] - products) / (2.0 * root[0]);
        }
        Jet(root)
    }

    /// Arc tangent.
    pub fn atan(self) -> Self {
        let derivative = self.derivative() / (self * self + 1.0);
        derivative.integral(libm::atan(self.0[0]))
    }

    /// Direction of the point (x, y), rad, where x is `other` and y is `self`; not both zero.
    pub fn atan2(self, other: Self) -> Self {
        let (y, x) = (self, other);
        let derivative = (x * y.derivative() - y * x.derivative()) / (x * x + y * y);
        derivative.integral(libm::atan2(y.0[0], x.0[0]))
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Jet(std::array::from_fn(|k| self.0[k] + o.0[k]))
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Jet(std::array::from_fn(|k| self.0[k] - o.0[k]))
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Jet(std::array::from_fn(|k| (0..=k).map(|j| self.0[j] * o.0[k - j]).sum()))
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let mut quotient = [0.0; N];
        for k in 0..N {
            let products: f64 = (1..=k).map(|j| o.0[j] * quotient[k - j]).sum();
            quotient[k] = (self.0[k] - products) / o.0[0];
        }
        Jet(quotient)
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Jet(self.0.map(|c| -c))
    }
}

impl<const N: usize> Add<f64> for Jet<N> {
    type Output = Self;
    fn add(mut self, k: f64) -> Self {
        self.0[0] += k;
        self
    }
}

impl<const N: usize> Mul<f64> for Jet<N> {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        Jet(self.0.map(|c| c * k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Identities that hold for every derivative: sin² + cos² = 1, sqrt(x)² = x, tan(atan x) = x, and the
    /// direction of (cos a, sin a) is a.
    #[test]
    fn identities_hold_to_the_last_derivative() {
        let t = Jet::<6>::time(0.7);
        let x = t * t * 0.3 + t * 1.1 + 0.2;
        let near = |a: Jet<6>, b: Jet<6>| {
            for (a, b) in a.0.iter().zip(b.0) {
                assert!((a - b).abs() < 1e-14, "{a} {b}");
            }
        };
        let (s, c) = x.sin_cos();
        near(s * s + c * c, Jet::constant(1.0));
        near(s.derivative(), c * x.derivative() - Jet([0.0, 0.0, 0.0, 0.0, 0.0, (c * x.derivative()).0[5]]));
        near(x.sqrt() * x.sqrt(), x);
        let (s, c) = x.atan().sin_cos();
        near(s / c, x);
        let (s, c) = x.sin_cos();
        near(s.atan2(c), x);
    }
}
