use libm::sqrt;

use super::{Arguments, Form, LinearModel, Parameter, ParameterUnit, ProcessKind, Range, Shape, Step};

/// White noise: angle random walk of gyroscopes, velocity random walk of accelerometers.
pub struct White;

impl ProcessKind for White {
    fn name(&self) -> &'static str {
        "white"
    }
    fn doc(&self) -> &'static str {
        "White noise of density N: angle or velocity random walk"
    }
    fn formula(&self) -> &'static str {
        "S(f) = N^2; mean over dt ~ N(0, N^2/dt); sigma^2(tau) = N^2/tau"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 952, angle random walk N"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[&[Parameter {
            name: "density",
            unit: ParameterUnit::Coefficient(1),
            range: Range::NonNegative,
            example: 1.0,
            doc: "root of the two-sided spectral density, N",
        }]];
        FORMS
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::White
    }
    fn initial(&self, _: &Arguments, _: usize, _: [f64; 2]) -> [f64; 2] {
        [0.0; 2]
    }
    fn step(&self, a: &Arguments, _: usize, dt: f64) -> Step {
        Step::first_order(0.0, 0.0, [0.0, 0.0, a.values[0] / sqrt(dt)])
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        LinearModel { white: a.values[0] * a.values[0], ..LinearModel::NONE }
    }
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64 {
        a.values[0] * a.values[0] / tau
    }
    fn spectrum(&self, a: &Arguments, _: f64) -> Option<f64> {
        Some(a.values[0] * a.values[0])
    }
}
