use core::f64::consts::PI;

use libm::{ceil, log, pow, sqrt};

use super::gauss_markov::GaussMarkov;
use super::{
    Arguments, Form, LinearModel, MAX_STATES, Parameter, ParameterUnit, ProcessKind, Range, Shape, Step,
};
use crate::Unit;

/// Flicker noise over a band of averaging times, as a sum of Gauss-Markov processes.
///
/// Over `tau_min` to `tau_max` the Allan deviation is flat at B sqrt(2 ln 2/pi) = 0.6643 B within
/// 1 %. True 1/f noise has no band and no finite variance, so the band must be stated; outside of
/// it the curve falls off on both sides.
///
/// The density B²/(2 pi f) is the integral of Gauss-Markov processes of variance B²/pi per unit of ln
/// tau. Poles spaced by a factor of 7, from at most 0.2 `tau_min` to at least 2 `tau_max`, sample it, the
/// first and the last with 1.2 times the variance in place of the poles beyond them; these figures keep
/// the ripple below 1 %.
pub struct Flicker;

const RATIO: f64 = 7.0;
const END_WEIGHT: f64 = 1.2;

/// Number of poles and the first time constant. What the last gap has too much is shared by both ends.
fn poles(a: &Arguments) -> (usize, f64) {
    let [_, tau_min, tau_max, ..] = a.values;
    let width = 10.0 * tau_max / tau_min;
    let gaps = ceil(log(width) / log(RATIO));
    (gaps as usize + 1, 0.2 * tau_min * sqrt(width / pow(RATIO, gaps)))
}

/// Parameters of pole `k` as a Gauss-Markov process.
fn pole(a: &Arguments, k: usize) -> Arguments {
    let (n, first) = poles(a);
    let weight = if k == 0 || k + 1 == n { END_WEIGHT } else { 1.0 };
    let sigma = a.values[0] * sqrt(weight * log(RATIO) / PI);
    let mut values = Arguments::EMPTY.values;
    (values[0], values[1]) = (sigma, first * pow(RATIO, k as f64));
    Arguments { form: 0, values }
}

impl ProcessKind for Flicker {
    fn name(&self) -> &'static str {
        "flicker"
    }
    fn doc(&self) -> &'static str {
        "Flicker noise B, flat in Allan deviation within 1 % over a stated band: bias instability"
    }
    fn formula(&self) -> &'static str {
        "S(f) = B^2/(2 pi f) as a sum of Gauss-Markov processes; sigma^2(tau) = (2 ln 2/pi) B^2 for tau_min <= tau <= tau_max"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 952, bias instability B"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[&[
            Parameter {
                name: "instability",
                unit: ParameterUnit::Coefficient(0),
                range: Range::NonNegative,
                example: 1.0,
                doc: "B; the Allan deviation is 0.6643 B",
            },
            Parameter {
                name: "tau_min",
                unit: ParameterUnit::Own(Unit::SECOND),
                range: Range::Positive,
                example: 0.5,
                doc: "shortest averaging time of the band",
            },
            Parameter {
                name: "tau_max",
                unit: ParameterUnit::Own(Unit::SECOND),
                range: Range::Positive,
                example: 50.0,
                doc: "longest averaging time of the band",
            },
        ]];
        FORMS
    }
    fn conflict(&self, a: &Arguments) -> Option<&'static str> {
        let [_, tau_min, tau_max, ..] = a.values;
        if tau_max < tau_min {
            Some("`tau_min` must not be above `tau_max`, for example 1 s and 1000 s")
        } else if tau_max / tau_min > 1e8 {
            Some(
                "the band from `tau_min` to `tau_max` must not be wider than 8 decades, for example 1 s to 1000 s",
            )
        } else {
            None
        }
    }
    fn parts(&self, a: &Arguments) -> usize {
        poles(a).0.min(MAX_STATES)
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::First
    }
    fn initial(&self, a: &Arguments, part: usize, normals: [f64; 2]) -> [f64; 2] {
        GaussMarkov.initial(&pole(a, part), 0, normals)
    }
    fn step(&self, a: &Arguments, part: usize, dt: f64) -> Step {
        GaussMarkov.step(&pole(a, part), 0, dt)
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        (0..self.parts(a)).fold(LinearModel::NONE, |sum, k| sum.plus(&GaussMarkov.linear_model(&pole(a, k))))
    }
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64 {
        (0..self.parts(a)).map(|k| GaussMarkov.allan_variance(&pole(a, k), tau)).sum()
    }
    fn spectrum(&self, a: &Arguments, f: f64) -> Option<f64> {
        (0..self.parts(a)).map(|k| GaussMarkov.spectrum(&pole(a, k), f)).sum()
    }
}
