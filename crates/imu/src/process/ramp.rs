use super::{
    Arguments, Form, LinearModel, Parameter, ParameterUnit, Polynomial, ProcessKind, Range, Shape, Step,
};

/// A coefficient that grows linearly from zero at t = 0.
pub struct Ramp;

const VALUE: usize = 0;

impl ProcessKind for Ramp {
    fn name(&self) -> &'static str {
        "ramp"
    }
    fn doc(&self) -> &'static str {
        "Linear growth from zero at t = 0, of fixed rate or of a rate drawn once: rate ramp"
    }
    fn formula(&self) -> &'static str {
        "c(t) = R t; sigma^2(tau) = R^2 tau^2/2"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 952, rate ramp R"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[
            &[Parameter {
                name: "rate",
                unit: ParameterUnit::Coefficient(-2),
                range: Range::Any,
                example: 0.5,
                doc: "the fixed rate R",
            }],
            &[Parameter {
                name: "sigma",
                unit: ParameterUnit::Coefficient(-2),
                range: Range::NonNegative,
                example: 0.5,
                doc: "standard deviation of the rate from run to run",
            }],
        ];
        FORMS
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::Free
    }
    fn initial(&self, a: &Arguments, _: usize, [w, _]: [f64; 2]) -> [f64; 2] {
        [0.0, if a.form == VALUE { a.values[0] } else { a.values[0] * w }]
    }
    fn step(&self, _: &Arguments, _: usize, dt: f64) -> Step {
        Step { phi: [[1.0, dt], [0.0, 1.0]], mean: [1.0, 0.5 * dt], noise: [[0.0; 3]; 3] }
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        let r = a.values[0];
        let mut m = LinearModel::planar([[0.0, 1.0], [0.0, 0.0]], [0.0; 2]);
        if a.form == VALUE {
            m.x0[1] = r;
        } else {
            m.p0[1][1] = r * r;
        }
        m
    }
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64 {
        let d = a.values[0] * tau;
        0.5 * d * d
    }
    fn spectrum(&self, _: &Arguments, _: f64) -> Option<f64> {
        None
    }
    fn deterministic(&self, a: &Arguments) -> Option<Polynomial> {
        (a.form == VALUE).then_some(Polynomial { value: 0.0, rate: a.values[0] })
    }
}
