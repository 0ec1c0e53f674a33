use super::{
    Arguments, Form, LinearModel, Parameter, ParameterUnit, Polynomial, ProcessKind, Range, Shape, Step,
};

/// A coefficient that keeps its value: fixed, or drawn once per run.
pub struct Constant;

const VALUE: usize = 0;

impl ProcessKind for Constant {
    fn name(&self) -> &'static str {
        "constant"
    }
    fn doc(&self) -> &'static str {
        "Keeps its value during a run: fixed, or drawn once at turn-on"
    }
    fn formula(&self) -> &'static str {
        "c(t) = value, or c(t) = c0 with c0 ~ N(0, sigma^2)"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, turn-on to turn-on bias"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[
            &[Parameter {
                name: "value",
                unit: ParameterUnit::Coefficient(0),
                range: Range::Any,
                example: 1.0,
                doc: "the fixed value",
            }],
            &[Parameter {
                name: "sigma",
                unit: ParameterUnit::Coefficient(0),
                range: Range::NonNegative,
                example: 1.0,
                doc: "standard deviation from run to run",
            }],
        ];
        FORMS
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::Constant
    }
    fn initial(&self, a: &Arguments, _: usize, [w, _]: [f64; 2]) -> [f64; 2] {
        [if a.form == VALUE { a.values[0] } else { a.values[0] * w }, 0.0]
    }
    fn step(&self, _: &Arguments, _: usize, _: f64) -> Step {
        Step::first_order(1.0, 1.0, [0.0; 3])
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        let c = a.values[0];
        if a.form == VALUE {
            LinearModel::scalar(0.0, 0.0, c, 0.0)
        } else {
            LinearModel::scalar(0.0, 0.0, 0.0, c * c)
        }
    }
    fn allan_variance(&self, _: &Arguments, _: f64) -> f64 {
        0.0
    }
    /// All its power is at f = 0.
    fn spectrum(&self, _: &Arguments, _: f64) -> Option<f64> {
        Some(0.0)
    }
    fn deterministic(&self, a: &Arguments) -> Option<Polynomial> {
        (a.form == VALUE).then_some(Polynomial { value: a.values[0], rate: 0.0 })
    }
}
