use super::{Arguments, LinearModel, ProcessKind, Shape};

/// The process of one coefficient: a kind and its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evolution {
    /// What process it is.
    pub kind: &'static dyn ProcessKind,
    /// Its numbers.
    pub arguments: Arguments,
    /// Factor on the coefficient.
    pub gain: f64,
}

/// A coefficient that is a known function of time: `value + rate t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial {
    /// Value at t = 0, in the coefficient's unit.
    pub value: f64,
    /// Rate, in the coefficient's unit per second.
    pub rate: f64,
}

impl Evolution {
    /// The coefficient as a continuous linear model.
    pub fn linear_model(&self) -> LinearModel {
        let mut m = self.kind.linear_model(&self.arguments);
        m.c = m.c.map(|c| c * self.gain);
        m.white *= self.gain * self.gain;
        m
    }

    /// Ensemble Allan variance of the coefficient's interval means at averaging time `tau`, s.
    pub fn allan_variance(&self, tau: f64) -> f64 {
        self.gain * self.gain * self.kind.allan_variance(&self.arguments, tau)
    }

    /// Two-sided power spectral density at `f` Hz; `None` where there is none.
    pub fn spectrum(&self, f: f64) -> Option<f64> {
        self.kind.spectrum(&self.arguments, f).map(|s| self.gain * self.gain * s)
    }

    /// Whether the coefficient keeps its value, be it known or drawn.
    pub fn is_constant(&self) -> bool {
        self.kind.shape(&self.arguments) == Shape::Constant
    }

    /// The coefficient as a function of time, where nothing in it is random.
    pub fn deterministic(&self) -> Option<Polynomial> {
        let p = self.kind.deterministic(&self.arguments)?;
        Some(Polynomial { value: self.gain * p.value, rate: self.gain * p.rate })
    }
}

impl Polynomial {
    /// The coefficient at time `t`, s.
    pub fn at(&self, t: f64) -> f64 {
        self.value + self.rate * t
    }
}
