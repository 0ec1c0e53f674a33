use core::f64::consts::TAU;

use libm::sqrt;

use super::{Arguments, Form, LinearModel, Parameter, ParameterUnit, ProcessKind, Range, Shape, Step};

/// Integrated white noise, zero at t = 0.
pub struct RandomWalk;

impl ProcessKind for RandomWalk {
    fn name(&self) -> &'static str {
        "random_walk"
    }
    fn doc(&self) -> &'static str {
        "Random walk of density K, zero at t = 0: rate random walk when applied to bias"
    }
    fn formula(&self) -> &'static str {
        "c' = w, S_w = K^2; sigma^2(tau) = K^2 tau/3"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 952, rate random walk K"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[&[Parameter {
            name: "density",
            unit: ParameterUnit::Coefficient(-1),
            range: Range::NonNegative,
            example: 1.0,
            doc: "root of the spectral density of its derivative, K",
        }]];
        FORMS
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::First
    }
    fn initial(&self, _: &Arguments, _: usize, _: [f64; 2]) -> [f64; 2] {
        [0.0; 2]
    }
    /// Increment and interval mean have covariance K² [dt, dt/2; dt/2, dt/3].
    fn step(&self, a: &Arguments, _: usize, dt: f64) -> Step {
        let k = a.values[0] * sqrt(dt);
        Step::first_order(1.0, 1.0, [k, 0.5 * k, k / sqrt(12.0)])
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        LinearModel::scalar(0.0, a.values[0] * a.values[0], 0.0, 0.0)
    }
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64 {
        a.values[0] * a.values[0] * tau / 3.0
    }
    fn spectrum(&self, a: &Arguments, f: f64) -> Option<f64> {
        let k = a.values[0] / (TAU * f);
        Some(k * k)
    }
}
