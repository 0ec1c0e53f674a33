use core::f64::consts::{PI, TAU};

use libm::{hypot, sin, sincos};

use super::{Arguments, Form, LinearModel, Parameter, ParameterUnit, ProcessKind, Range, Shape, Step};
use crate::Unit;

/// A sinusoid of random phase, or of a given one.
pub struct Sinusoid;

const RANDOM_PHASE: usize = 0;

const AMPLITUDE: Parameter = Parameter {
    name: "amplitude",
    unit: ParameterUnit::Coefficient(0),
    range: Range::NonNegative,
    example: 1.0,
    doc: "amplitude A",
};

const FREQUENCY: Parameter = Parameter {
    name: "frequency",
    unit: ParameterUnit::Own(Unit::HERTZ),
    range: Range::Positive,
    example: 0.3,
    doc: "frequency f0, cycles per second",
};

const PHASE: Parameter = Parameter {
    name: "phase",
    unit: ParameterUnit::Own(Unit::RADIAN),
    range: Range::Any,
    example: 0.7,
    doc: "phase at t = 0",
};

impl ProcessKind for Sinusoid {
    fn name(&self) -> &'static str {
        "sinusoid"
    }
    fn doc(&self) -> &'static str {
        "Sinusoid of random phase (drawn once per run) or of a given one: dither noise"
    }
    fn formula(&self) -> &'static str {
        "c(t) = A sin(2 pi f0 t + phase); sigma^2(tau) = A^2 (sin^2(pi f0 tau)/(pi f0 tau))^2"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 952, sinusoidal noise"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[&[AMPLITUDE, FREQUENCY], &[AMPLITUDE, FREQUENCY, PHASE]];
        FORMS
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::Free
    }
    /// Sine and cosine of the phase, times the amplitude. The direction of a pair of independent
    /// normals is uniform, which gives the random phase.
    fn initial(&self, a: &Arguments, _: usize, [w1, w2]: [f64; 2]) -> [f64; 2] {
        let [amplitude, _, phase, ..] = a.values;
        if a.form == RANDOM_PHASE {
            let r = hypot(w1, w2);
            if r > 0.0 { [amplitude * w1 / r, amplitude * w2 / r] } else { [0.0, amplitude] }
        } else {
            let (s, c) = sincos(phase);
            [amplitude * s, amplitude * c]
        }
    }
    fn step(&self, a: &Arguments, _: usize, dt: f64) -> Step {
        let angle = TAU * a.values[1] * dt;
        let ((s, c), half) = (sincos(angle), sin(0.5 * angle));
        Step { phi: [[c, s], [-s, c]], mean: [s / angle, 2.0 * half * half / angle], noise: [[0.0; 3]; 3] }
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        let [amplitude, frequency, ..] = a.values;
        let w = TAU * frequency;
        let x0 = if a.form == RANDOM_PHASE { [0.0; 2] } else { self.initial(a, 0, [0.0; 2]) };
        let mut m = LinearModel::planar([[0.0, w], [-w, 0.0]], x0);
        if a.form == RANDOM_PHASE {
            (m.p0[0][0], m.p0[1][1]) = (0.5 * amplitude * amplitude, 0.5 * amplitude * amplitude);
        }
        m
    }
    /// Mean over the phase.
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64 {
        let x = PI * a.values[1] * tau;
        let s = a.values[0] * sin(x) * sin(x) / x;
        s * s
    }
    /// A line, no density.
    fn spectrum(&self, _: &Arguments, _: f64) -> Option<f64> {
        None
    }
}
