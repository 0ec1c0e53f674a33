use super::{Arguments, Form, LinearModel, Parameter, ParameterUnit, ProcessKind, Range, Shape, Step};

/// Quantization of the integral: the linear model of a readout in increments.
///
/// The integral of the coefficient has an independent error of variance Q² at each end of an
/// interval, so the interval mean has the difference of two over its length. The error of the
/// integral stays bounded: as a continuous linear model there is nothing to integrate, and
/// [`ProcessKind::linear_model`] is empty.
pub struct Quantization;

impl ProcessKind for Quantization {
    fn name(&self) -> &'static str {
        "quantization"
    }
    fn doc(&self) -> &'static str {
        "White error Q of the integral at the ends of each interval: linear model of rounding with carry"
    }
    fn formula(&self) -> &'static str {
        "mean over dt = (q_end - q_start)/dt, q ~ N(0, Q^2), Q = LSB/sqrt(12); sigma^2(tau) = 3 Q^2/tau^2"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 952, quantization noise Q"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[&[Parameter {
            name: "q",
            unit: ParameterUnit::Coefficient(2),
            range: Range::NonNegative,
            example: 0.5,
            doc: "standard deviation of the integral's error, least significant bit over sqrt(12)",
        }]];
        FORMS
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::First
    }
    fn initial(&self, a: &Arguments, _: usize, [w, _]: [f64; 2]) -> [f64; 2] {
        [a.values[0] * w, 0.0]
    }
    fn step(&self, a: &Arguments, _: usize, dt: f64) -> Step {
        Step::first_order(0.0, -1.0 / dt, [a.values[0], a.values[0] / dt, 0.0])
    }
    fn linear_model(&self, _: &Arguments) -> LinearModel {
        LinearModel::NONE
    }
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64 {
        let q = a.values[0] / tau;
        3.0 * q * q
    }
    /// Depends on the sample interval, so there is none of the process itself.
    fn spectrum(&self, _: &Arguments, _: f64) -> Option<f64> {
        None
    }
}
