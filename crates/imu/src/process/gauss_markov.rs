use core::f64::consts::TAU;

use libm::{exp, expm1, sqrt, tanh};

use super::{Arguments, Form, LinearModel, Parameter, ParameterUnit, ProcessKind, Range, Shape, Step};
use crate::Unit;

/// First-order Gauss-Markov process, stationary from t = 0.
pub struct GaussMarkov;

impl ProcessKind for GaussMarkov {
    fn name(&self) -> &'static str {
        "gauss_markov"
    }
    fn doc(&self) -> &'static str {
        "First-order Gauss-Markov process, stationary from t = 0: correlated noise"
    }
    fn formula(&self) -> &'static str {
        "c' = -c/tau + w, E c(t) c(s) = sigma^2 exp(-|t - s|/tau)"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 952, exponentially correlated (Markov) noise"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[&[
            Parameter {
                name: "sigma",
                unit: ParameterUnit::Coefficient(0),
                range: Range::NonNegative,
                example: 1.0,
                doc: "standard deviation at any time",
            },
            Parameter {
                name: "tau",
                unit: ParameterUnit::Own(Unit::SECOND),
                range: Range::Positive,
                example: 2.0,
                doc: "correlation time",
            },
        ]];
        FORMS
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::First
    }
    fn initial(&self, a: &Arguments, _: usize, [w, _]: [f64; 2]) -> [f64; 2] {
        [a.values[0] * w, 0.0]
    }
    /// With u = dt/tau, h = u/2: state noise s² (1 - e^-2u), mean noise given the state noise
    /// s² (h - tanh h)/h², their regression tanh(h)/u. Written so, nothing cancels for small u.
    fn step(&self, a: &Arguments, _: usize, dt: f64) -> Step {
        let [sigma, tau, ..] = a.values;
        let u = dt / tau;
        let h = 0.5 * u;
        let state = sigma * sqrt(-expm1(-2.0 * u));
        let rest = sigma * sqrt(h_minus_tanh(h)) / h;
        Step::first_order(exp(-u), -expm1(-u) / u, [state, state * tanh(h) / u, rest])
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        let [sigma, tau, ..] = a.values;
        LinearModel::scalar(-1.0 / tau, 2.0 * sigma * sigma / tau, 0.0, sigma * sigma)
    }
    /// s²/x² (2x - 3 + 4e^-x - e^-2x) with x = averaging time over correlation time.
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64 {
        let [sigma, correlation, ..] = a.values;
        let x = tau / correlation;
        let e = -expm1(-x);
        sigma * sigma * (4.0 * h_minus_tanh(0.5 * x) + e * e * e / (2.0 - e)) / (x * x)
    }
    fn spectrum(&self, a: &Arguments, f: f64) -> Option<f64> {
        let [sigma, tau, ..] = a.values;
        let w = TAU * f * tau;
        Some(2.0 * sigma * sigma * tau / (1.0 + w * w))
    }
}

/// h - tanh h for h >= 0, without cancellation.
fn h_minus_tanh(h: f64) -> f64 {
    if h > 0.1 {
        return h - tanh(h);
    }
    // Taylor series of tanh (Abramowitz and Stegun 4.5.64); the first term left out is below
    // 1e-16 of the sum at h = 0.1.
    const SERIES: [f64; 7] = [
        929_569.0 / 638_512_875.0,
        -21_844.0 / 6_081_075.0,
        1_382.0 / 155_925.0,
        -62.0 / 2_835.0,
        17.0 / 315.0,
        -2.0 / 15.0,
        1.0 / 3.0,
    ];
    let z = h * h;
    h * z * SERIES.iter().fold(0.0, |sum, c| sum * z + c)
}
