//! Numbers that carry their first and second derivative with time.

use std::ops::{Add, Mul, Neg, Sub};

/// Value, first and second derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet(pub f64, pub f64, pub f64);

impl Jet {
    pub fn constant(c: f64) -> Self {
        Jet(c, 0.0, 0.0)
    }

    pub fn time(t: f64) -> Self {
        Jet(t, 1.0, 0.0)
    }

    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    pub fn cos(self) -> Self {
        self.sin_cos().1
    }

    pub fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.0.sin_cos();
        (self.through(s, c, -s), self.through(c, -s, -c))
    }

    pub fn powf(self, n: f64) -> Self {
        let x = self.0;
        self.through(x.powf(n), n * x.powf(n - 1.0), n * (n - 1.0) * x.powf(n - 2.0))
    }

    /// f(self) from f, f' and f'' there.
    pub fn through(self, f: f64, df: f64, ddf: f64) -> Self {
        Jet(f, df * self.1, ddf * self.1 * self.1 + df * self.2)
    }

    /// The derivative, as far as it is known.
    pub fn rate(self) -> f64 {
        self.1
    }
}

impl Add for Jet {
    type Output = Jet;
    fn add(self, o: Jet) -> Jet {
        Jet(self.0 + o.0, self.1 + o.1, self.2 + o.2)
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, o: Jet) -> Jet {
        Jet(self.0 - o.0, self.1 - o.1, self.2 - o.2)
    }
}

impl Mul for Jet {
    type Output = Jet;
    fn mul(self, o: Jet) -> Jet {
        Jet(self.0 * o.0, self.1 * o.0 + self.0 * o.1, self.2 * o.0 + 2.0 * self.1 * o.1 + self.0 * o.2)
    }
}

impl Mul<f64> for Jet {
    type Output = Jet;
    fn mul(self, k: f64) -> Jet {
        Jet(self.0 * k, self.1 * k, self.2 * k)
    }
}

impl Add<f64> for Jet {
    type Output = Jet;
    fn add(self, k: f64) -> Jet {
        Jet(self.0 + k, self.1, self.2)
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        Jet(-self.0, -self.1, -self.2)
    }
}
