//! Functions of time that are a cubic polynomial plus three oscillations.

/// The three circular rates of a family of [`ModalSum`]s, rad/s.
pub type Rates = [f64; 3];

/// `f(t) = p0 + p1 t + p2 t²/2 + p3 t³/6 + Σ_j (cos_j cos(w_j t) + sin_j sin(w_j t))`.
///
/// The answer of a stationary navigator to constant and ramp errors has this form, so that its
/// derivatives and integrals are exact too. The rates `w` are given with every call, because one
/// solution's channels share them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModalSum {
    /// Coefficients of `1, t, t²/2, t³/6`.
    pub poly: [f64; 4],
    /// Coefficients of `cos(w_j t)`.
    pub cos: [f64; 3],
    /// Coefficients of `sin(w_j t)`.
    pub sin: [f64; 3],
}

impl ModalSum {
    /// A polynomial alone.
    pub const fn polynomial(poly: [f64; 4]) -> Self {
        ModalSum { poly, cos: [0.0; 3], sin: [0.0; 3] }
    }

    /// Value at time `t` (s).
    pub fn at(&self, w: &Rates, t: f64) -> f64 {
        let [p0, p1, p2, p3] = self.poly;
        let mut sum = p0 + t * (p1 + t * (p2 / 2.0 + t * p3 / 6.0));
        for j in 0..3 {
            let (s, c) = libm::sincos(w[j] * t);
            sum += self.cos[j] * c + self.sin[j] * s;
        }
        sum
    }

    /// Derivative with respect to time.
    pub fn derivative(&self, w: &Rates) -> Self {
        let [_, p1, p2, p3] = self.poly;
        let mut d = ModalSum::polynomial([p1, p2, p3, 0.0]);
        for j in 0..3 {
            d.cos[j] = self.sin[j] * w[j];
            d.sin[j] = -self.cos[j] * w[j];
        }
        d
    }

    /// Integral from 0 to `t`. The cubic coefficient of `self` must be zero: nothing of degree four
    /// can be held. All rates with a non-zero coefficient must be non-zero.
    pub fn integral(&self, w: &Rates) -> Self {
        let [p0, p1, p2, p3] = self.poly;
        debug_assert!(p3 == 0.0, "the integral of a cubic does not fit");
        let mut i = ModalSum::polynomial([0.0, p0, p1, p2]);
        for j in 0..3 {
            if self.sin[j] != 0.0 {
                i.cos[j] = -self.sin[j] / w[j];
                i.poly[0] += self.sin[j] / w[j];
            }
            if self.cos[j] != 0.0 {
                i.sin[j] = self.cos[j] / w[j];
            }
        }
        i
    }

    /// `self + k * other`.
    pub fn plus(&self, k: f64, other: &Self) -> Self {
        let mut sum = *self;
        for j in 0..4 {
            sum.poly[j] += k * other.poly[j];
        }
        for j in 0..3 {
            sum.cos[j] += k * other.cos[j];
            sum.sin[j] += k * other.sin[j];
        }
        sum
    }

    /// `k * self`.
    pub fn scaled(&self, k: f64) -> Self {
        ModalSum::default().plus(k, self)
    }
}
