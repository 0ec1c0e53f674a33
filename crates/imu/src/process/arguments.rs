use super::{Arguments, Evolution, MAX_PARAMETERS, ProcessKind, Range};
use crate::error::{Error, Names, Text};
use crate::term::MAX_COEFFICIENTS;

/// A process with its parameters: the same number for every coefficient, or a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Process {
    kind: &'static dyn ProcessKind,
    form: usize,
    values: [[f64; MAX_COEFFICIENTS]; MAX_PARAMETERS],
    /// Length of the lists given, 0 where only single numbers were.
    count: usize,
}

/// A parameter as given: one number for all coefficients, or one for each. SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// The same for every coefficient.
    Same(f64),
    /// One for each coefficient, in the order of the term's labels.
    Each(&'a [f64]),
}

impl From<f64> for Value<'_> {
    fn from(x: f64) -> Self {
        Value::Same(x)
    }
}

impl<'a> From<&'a [f64]> for Value<'a> {
    fn from(x: &'a [f64]) -> Self {
        Value::Each(x)
    }
}

impl<'a, const N: usize> From<&'a [f64; N]> for Value<'a> {
    fn from(x: &'a [f64; N]) -> Self {
        Value::Each(x)
    }
}

impl Process {
    /// A process of `kind` with named parameters in SI units, validated.
    ///
    /// # Errors
    /// The names are those of no form of the process, a number is out of its range, lists differ in length,
    /// or the numbers contradict each other.
    pub fn new(kind: &'static dyn ProcessKind, given: &[(&str, Value<'_>)]) -> Result<Process, Error> {
        let forms = kind.forms();
        if let Some((stray, _)) =
            given.iter().find(|(name, _)| !forms.iter().any(|f| f.iter().any(|p| p.name == *name)))
        {
            return Err(Error::UnknownParameter {
                process: kind.name(),
                name: Text::new(stray),
                forms: Names(forms),
            });
        }
        let form = forms
            .iter()
            .position(|f| f.len() == given.len() && f.iter().all(|p| given.iter().any(|(n, _)| *n == p.name)))
            .ok_or(Error::ParameterSet { process: kind.name(), given: given.len(), forms: Names(forms) })?;
        let mut process = Process { kind, form, values: [[0.0; MAX_COEFFICIENTS]; MAX_PARAMETERS], count: 0 };
        for (i, parameter) in forms[form].iter().enumerate() {
            for (_, value) in given.iter().filter(|(n, _)| *n == parameter.name) {
                process.assign(i, parameter.name, parameter.range, *value)?;
            }
        }
        let used = process.list_length().unwrap_or(1);
        match (0..used).find_map(|j| kind.conflict(&process.evolution(j, 1.0).arguments)) {
            Some(reason) => Err(Error::Conflict { process: kind.name(), reason }),
            None => Ok(process),
        }
    }

    fn assign(&mut self, i: usize, name: &'static str, range: Range, value: Value<'_>) -> Result<(), Error> {
        let process = self.kind.name();
        let one = |x: f64| {
            if range.contains(x) { Ok(x) } else { Err(Error::OutOfRange { process, name, value: x, range }) }
        };
        match value {
            Value::Same(x) => self.values[i] = [one(x)?; MAX_COEFFICIENTS],
            Value::Each(list) => {
                if list.is_empty()
                    || list.len() > MAX_COEFFICIENTS
                    || (self.count != 0 && self.count != list.len())
                {
                    let need = if self.count == 0 { MAX_COEFFICIENTS } else { self.count };
                    return Err(Error::ListLength { process, name, found: list.len(), need });
                }
                self.count = list.len();
                for (slot, x) in self.values[i].iter_mut().zip(list) {
                    *slot = one(*x)?;
                }
            }
        }
        Ok(())
    }

    /// What process it is.
    pub fn kind(&self) -> &'static dyn ProcessKind {
        self.kind
    }

    /// Length of the lists that were given; `None` where single numbers stand for all coefficients.
    pub fn list_length(&self) -> Option<usize> {
        (self.count != 0).then_some(self.count)
    }

    /// The process of coefficient `j` (below [`MAX_COEFFICIENTS`]) times `gain`.
    pub(crate) fn evolution(&self, j: usize, gain: f64) -> Evolution {
        let values = self.values.map(|v| v[j]);
        Evolution { kind: self.kind, arguments: Arguments { form: self.form, values }, gain }
    }
}
