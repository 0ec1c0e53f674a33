//! Processes: how a coefficient evolves in time.
//!
//! To add a process, write its file and name it in the two places below.

use core::fmt;

use crate::Unit;

mod arguments;
mod constant;
mod evolution;
mod flicker;
mod gauss_markov;
mod innovation;
mod linear;
mod quantization;
mod ramp;
mod random_walk;
mod second_order_gauss_markov;
mod sinusoid;
mod step;
mod sun_literal;
mod white;

pub use arguments::{Process, Value};
pub use evolution::{Evolution, Polynomial};
pub use innovation::{Innovation, SETTLED};
pub use linear::{LinearModel, MAX_STATES};
pub use step::{Shape, Step};

/// Every process, in the order of the documentation tables.
pub static PROCESSES: &[&dyn ProcessKind] = &[
    &constant::Constant,
    &white::White,
    &random_walk::RandomWalk,
    &gauss_markov::GaussMarkov,
    &second_order_gauss_markov::SecondOrderGaussMarkov,
    &flicker::Flicker,
    &ramp::Ramp,
    &quantization::Quantization,
    &sinusoid::Sinusoid,
    &sun_literal::SunLiteral,
];

/// Most parameters that a process may have.
pub const MAX_PARAMETERS: usize = 5;

/// Parameters of one coefficient: which form was given, and its numbers in the order of the form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arguments {
    /// Index into [`ProcessKind::forms`].
    pub form: usize,
    /// SI values in the order of the form; the rest is zero.
    pub values: [f64; MAX_PARAMETERS],
}

impl Arguments {
    /// First form, all numbers zero.
    const EMPTY: Arguments = Arguments { form: 0, values: [0.0; MAX_PARAMETERS] };
}

/// A stochastic or deterministic process in time, zero-mean where it is random.
///
/// The numbers of an [`Arguments`] that reaches these functions have been validated.
pub trait ProcessKind: Sync {
    /// Name in files and column headers, `gauss_markov`.
    fn name(&self) -> &'static str;

    /// One line for people who know the field.
    fn doc(&self) -> &'static str;

    /// The equation, as text.
    fn formula(&self) -> &'static str;

    /// Where the process is defined.
    fn source(&self) -> &'static str;

    /// The ways to parametrise it, of which one is chosen by the names given.
    fn forms(&self) -> &'static [Form];

    /// Why these numbers, each in its range, do not go together, if they do not.
    fn conflict(&self, _: &Arguments) -> Option<&'static str> {
        None
    }

    /// Number of independent parts whose sum it is.
    fn parts(&self, _: &Arguments) -> usize {
        1
    }

    /// What one step of a part needs.
    fn shape(&self, a: &Arguments) -> Shape;

    /// State of part `part` at t = 0 from two independent standard normals (unused where nothing is random).
    fn initial(&self, a: &Arguments, part: usize, normals: [f64; 2]) -> [f64; 2];

    /// Exact joint discretisation of state and interval mean of part `part` over a step of `dt` seconds.
    fn step(&self, a: &Arguments, part: usize, dt: f64) -> Step;

    /// The same process as a continuous linear model.
    fn linear_model(&self, a: &Arguments) -> LinearModel;

    /// Ensemble Allan variance of interval means at averaging time `tau` (s), squared coefficient unit.
    fn allan_variance(&self, a: &Arguments, tau: f64) -> f64;

    /// Two-sided power spectral density at frequency `f` (Hz), squared coefficient unit per hertz;
    /// `None` where the process has none.
    fn spectrum(&self, a: &Arguments, f: f64) -> Option<f64>;

    /// The coefficient as a function of time, where nothing in it is random.
    fn deterministic(&self, _: &Arguments) -> Option<Polynomial> {
        None
    }
}

/// One way to parametrise a process.
pub type Form = &'static [Parameter];

/// A parameter of a process.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name in files, `density`.
    pub name: &'static str,
    /// Its unit.
    pub unit: ParameterUnit,
    /// The values that make sense.
    pub range: Range,
    /// A number that makes sense, in SI units and for a coefficient of the size of one.
    pub example: f64,
    /// One line.
    pub doc: &'static str,
}

/// Unit of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterUnit {
    /// The coefficient's unit times s^(n/2): a value (0), a white density (1), a walk density (-1).
    Coefficient(i8),
    /// A unit of its own, whatever the coefficient.
    Own(Unit),
}

/// Values that a parameter may take; all must be finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// Any number.
    Any,
    /// Zero or more.
    NonNegative,
    /// More than zero.
    Positive,
}

impl Parameter {
    /// Its unit for a coefficient in `coefficient`.
    pub const fn unit_for(&self, coefficient: Unit) -> Unit {
        match self.unit {
            ParameterUnit::Coefficient(halves) => coefficient.times_half_seconds(halves),
            ParameterUnit::Own(unit) => unit,
        }
    }

    /// Whether a number in `given` may be assigned for a coefficient in `coefficient`.
    pub fn accepts(&self, coefficient: Unit, given: Unit) -> bool {
        match self.unit {
            ParameterUnit::Coefficient(_) => self.unit_for(coefficient).accepts(given),
            ParameterUnit::Own(unit) => unit == given,
        }
    }
}

impl Range {
    /// Whether `x` is finite and inside.
    pub fn contains(self, x: f64) -> bool {
        x.is_finite()
            && match self {
                Range::Any => true,
                Range::NonNegative => x >= 0.0,
                Range::Positive => x > 0.0,
            }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Range::Any => "a finite number",
            Range::NonNegative => "a finite number, zero or more",
            Range::Positive => "a finite number above zero",
        })
    }
}

/// The process called `name`, if there is one.
pub fn process_kind(name: &str) -> Option<&'static dyn ProcessKind> {
    PROCESSES.iter().copied().find(|p| p.name() == name)
}

impl fmt::Debug for dyn ProcessKind {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}

impl PartialEq for dyn ProcessKind {
    fn eq(&self, o: &dyn ProcessKind) -> bool {
        self.name() == o.name()
    }
}
