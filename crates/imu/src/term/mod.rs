//! Terms: how a coefficient vector becomes an output error.
//!
//! To add a term, write its file and name it in the two places below.

use core::fmt;

use crate::{Input, Instrument, Unit};

mod bias;
mod misalignment;
mod quadratic;
mod scale_factor;

/// Every term, in the order of the documentation tables.
pub const TERMS: &[&dyn Term] =
    &[&bias::Bias, &scale_factor::ScaleFactor, &quadratic::Quadratic, &misalignment::Misalignment];

/// Most coefficients that a term may have.
pub const MAX_COEFFICIENTS: usize = 9;

/// Labels of a term with one coefficient per axis.
pub(crate) const AXES: &[&str] = &["x", "y", "z"];

/// The coefficients of a term, the first [`Term::len`] in use and the others zero.
pub type Coefficients = [f64; MAX_COEFFICIENTS];

/// An error term: linear in its coefficients, possibly non-linear in the input.
pub trait Term: Sync {
    /// Name in files and column headers, `scale_factor`.
    fn name(&self) -> &'static str;

    /// One line for people who know the field.
    fn doc(&self) -> &'static str;

    /// The equation, as text.
    fn formula(&self) -> &'static str;

    /// Where the term is defined.
    fn source(&self) -> &'static str;

    /// The instruments that can have it.
    fn instruments(&self) -> &'static [Instrument] {
        &Instrument::ALL
    }

    /// Unit of the coefficients on `instrument`.
    fn unit(&self, instrument: Instrument) -> Unit;

    /// Label of each coefficient; their number is the number of coefficients.
    fn labels(&self) -> &'static [&'static str] {
        AXES
    }

    /// Output error per axis (rad/s or m/s²) of coefficients `c` under `input`; linear in `c`.
    fn output(&self, input: &Input, c: &Coefficients) -> [f64; 3];

    /// Number of coefficients.
    fn len(&self) -> usize {
        self.labels().len()
    }

    /// Whether there is no coefficient at all (no term is so).
    fn is_empty(&self) -> bool {
        self.labels().is_empty()
    }

    /// The 3 × k matrix that takes coefficients to the output error under `input`.
    fn regressor(&self, input: &Input) -> Regressor {
        let mut r = Regressor { columns: [[0.0; 3]; MAX_COEFFICIENTS], len: self.len() };
        for j in 0..r.len {
            let mut unit = [0.0; MAX_COEFFICIENTS];
            unit[j] = 1.0;
            r.columns[j] = self.output(input, &unit);
        }
        r
    }
}

/// The 3 × k matrix of a term under one input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regressor {
    columns: [[f64; 3]; MAX_COEFFICIENTS],
    len: usize,
}

impl Regressor {
    /// Column of each coefficient: output error per axis and unit of the coefficient.
    pub fn columns(&self) -> &[[f64; 3]] {
        &self.columns[..self.len]
    }
}

/// The term called `name`, if there is one.
pub fn term(name: &str) -> Option<&'static dyn Term> {
    TERMS.iter().copied().find(|t| t.name() == name)
}

impl fmt::Debug for dyn Term {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}

impl PartialEq for dyn Term {
    fn eq(&self, o: &dyn Term) -> bool {
        self.name() == o.name()
    }
}

/// Product per axis.
pub(crate) fn by_axis(c: &Coefficients, x: [f64; 3]) -> [f64; 3] {
    [c[0] * x[0], c[1] * x[1], c[2] * x[2]]
}
