use core::f64::consts::TAU;

use libm::sqrt;

use super::{
    Arguments, Form, LinearModel, Parameter, ParameterUnit, Polynomial, ProcessKind, Range, Shape, Step,
};
use crate::Unit;

/// The temperature equations (4) and (5) of Sun, Li, Zhang and Wang, *Numerical Simulation on Inertial
/// Measurement Unit Errors*, to the letter, at one temperature T:
///
/// ```text
/// db = 0.2 (T - T_min)/(T_kal - T_min)                  (4)
/// b' = w + db,  b(0) = b0,  w in N(0, b1^2)             (5)
/// ```
///
/// What is wrong with them, so that nobody takes them for a model of a sensor: (5) adds a bias (m/s²)
/// to a derivative (m/s³), so a constant temperature makes the bias grow without end (0.2 is read
/// here in the coefficient's unit per second); w has no density, so b1 is read as the root of its
/// spectral density; 0.2 is the figure of one data sheet, without its unit; and db vanishes at the
/// lowest temperature, where it should vanish at the calibration temperature.
///
/// The general form has a `constant` for b0, a `random_walk` or `gauss_markov` for w, and the terms
/// `thermal`, `thermal_2`, `thermal_3` and `thermal_rate` for db(T(t)), which is added to the bias and
/// not to its derivative. Equation (4) alone is `bias: constant 0.2` with `thermal: constant
/// 0.2/(T_kal - T_min)`.
pub struct SunLiteral;

const COEFFICIENT: f64 = 0.2;

const fn kelvin(name: &'static str, doc: &'static str, example: f64) -> Parameter {
    Parameter { name, unit: ParameterUnit::Own(Unit::KELVIN), range: Range::NonNegative, example, doc }
}

/// The added bias of equation (4).
fn added(a: &Arguments) -> f64 {
    let [_, _, t, t_min, t_kal] = a.values;
    COEFFICIENT * (t - t_min) / (t_kal - t_min)
}

impl ProcessKind for SunLiteral {
    fn name(&self) -> &'static str {
        "sun_literal"
    }
    fn doc(&self) -> &'static str {
        "Temperature equations (4) and (5) of Sun et al. to the letter, dimensionally wrong: see the text"
    }
    fn formula(&self) -> &'static str {
        "c' = w + 0.2 (T - T_min)/(T_kal - T_min), c(0) = b0, S_w = b1^2"
    }
    fn source(&self) -> &'static str {
        "Sun, Li, Zhang, Wang, Numerical Simulation on Inertial Measurement Unit Errors, eq. (4), (5)"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[&[
            Parameter {
                name: "b0",
                unit: ParameterUnit::Coefficient(0),
                range: Range::Any,
                example: 0.5,
                doc: "value at t = 0",
            },
            Parameter {
                name: "b1",
                unit: ParameterUnit::Coefficient(-1),
                range: Range::NonNegative,
                example: 1.0,
                doc: "root of the spectral density of w",
            },
            kelvin("t", "temperature T", 303.15),
            kelvin("t_min", "lowest temperature T_min", 233.15),
            kelvin("t_kal", "calibration temperature T_kal", 298.15),
        ]];
        FORMS
    }
    fn conflict(&self, a: &Arguments) -> Option<&'static str> {
        (a.values[3] == a.values[4])
            .then_some("`t_min` and `t_kal` must differ, for example 233.15 K and 298.15 K")
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::Second
    }
    fn initial(&self, a: &Arguments, _: usize, _: [f64; 2]) -> [f64; 2] {
        [a.values[0], added(a)]
    }
    /// A random walk on top of a ramp.
    fn step(&self, a: &Arguments, _: usize, dt: f64) -> Step {
        let k = a.values[1] * sqrt(dt);
        Step {
            phi: [[1.0, dt], [0.0, 1.0]],
            mean: [1.0, 0.5 * dt],
            noise: [[k, 0.0, 0.0], [0.0; 3], [0.5 * k, 0.0, k / sqrt(12.0)]],
        }
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        let mut m = LinearModel::planar([[0.0, 1.0], [0.0, 0.0]], [a.values[0], added(a)]);
        m.q[0][0] = a.values[1] * a.values[1];
        m
    }
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64 {
        let (k, d) = (a.values[1], added(a) * tau);
        k * k * tau / 3.0 + 0.5 * d * d
    }
    fn spectrum(&self, a: &Arguments, f: f64) -> Option<f64> {
        let k = a.values[1] / (TAU * f);
        (added(a) == 0.0).then_some(k * k)
    }
    fn deterministic(&self, a: &Arguments) -> Option<Polynomial> {
        (a.values[1] == 0.0).then_some(Polynomial { value: a.values[0], rate: added(a) })
    }
}
