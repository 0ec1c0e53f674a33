//! Error sources: a term on an instrument whose coefficients follow a process.

use core::fmt;

use crate::error::{Error, Text};
use crate::process::{Evolution, Process, Value, process_kind};
use crate::term::Term;
use crate::{Instrument, Unit};

/// A term on an instrument with the process of its coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    instrument: Instrument,
    term: &'static dyn Term,
    process: Process,
    /// 1 for the first source of its name in a specification, 2 for the second, …
    pub(crate) occurrence: u8,
    /// Bit j: coefficient j is present.
    active: u16,
    pub(crate) gain: f64,
}

impl Source {
    /// A source.
    ///
    /// # Errors
    /// The instrument cannot have the term, or the parameter lists do not fit its coefficients.
    pub fn new(instrument: Instrument, term: &'static dyn Term, process: Process) -> Result<Source, Error> {
        if !term.instruments().contains(&instrument) {
            let only = term.instruments()[0];
            return Err(Error::Instrument { term: term.name(), instrument, only });
        }
        match process.list_length() {
            Some(found) if found != term.len() => Err(Error::Coefficients {
                term: term.name(),
                labels: term.labels(),
                process: process.kind().name(),
                found,
                need: term.len(),
            }),
            _ => {
                let active = (1 << term.len()) - 1;
                Ok(Source { instrument, term, process, occurrence: 1, active, gain: 1.0 })
            }
        }
    }

    /// A source from names, with parameters in SI units:
    /// `Source::named(Gyro, "bias", "white", &[("density", 1e-5.into())])`.
    ///
    /// # Errors
    /// As [`Source::new`] and [`Process::new`], and where a name does not exist.
    pub fn named(
        instrument: Instrument,
        term: &str,
        process: &str,
        given: &[(&str, Value<'_>)],
    ) -> Result<Source, Error> {
        let term = crate::term(term).ok_or(Error::UnknownTerm { name: Text::new(term) })?;
        let kind = process_kind(process).ok_or(Error::UnknownProcess { name: Text::new(process) })?;
        Source::new(instrument, term, Process::new(kind, given)?)
    }

    /// The same with only the coefficients whose bits are set in `active`.
    pub(crate) fn masked(mut self, active: u16) -> Source {
        self.active = active;
        self
    }

    /// The instrument.
    pub fn instrument(&self) -> Instrument {
        self.instrument
    }

    /// The term.
    pub fn term(&self) -> &'static dyn Term {
        self.term
    }

    /// The process of its coefficients.
    pub fn process(&self) -> &Process {
        &self.process
    }

    /// Unit of its coefficients.
    pub fn unit(&self) -> Unit {
        self.term.unit(self.instrument)
    }

    /// Its canonical name `gyro.bias.constant`, with `#2` for the second of the same in a specification.
    pub fn name(&self) -> impl fmt::Display + use<'_> {
        Name(self)
    }

    /// Its components, one for each coefficient that is present.
    pub fn components(&self) -> impl Iterator<Item = Component> + use<> {
        let source = *self;
        (0..source.term.len())
            .filter(move |j| source.active & (1 << j) != 0)
            .map(move |coefficient| Component { source, coefficient })
    }
}

struct Name<'a>(&'a Source);

impl fmt::Display for Name<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = self.0;
        write!(out, "{}.{}.{}", s.instrument, s.term.name(), s.process.kind().name())?;
        if s.occurrence > 1 { write!(out, "#{}", s.occurrence) } else { Ok(()) }
    }
}

/// One coefficient of a source; shown as `gyro.bias.constant.x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    source: Source,
    coefficient: usize,
}

impl Component {
    /// The source it belongs to.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The instrument.
    pub fn instrument(&self) -> Instrument {
        self.source.instrument
    }

    /// The term.
    pub fn term(&self) -> &'static dyn Term {
        self.source.term
    }

    /// Number of the coefficient: its column in the term's regressor.
    pub fn coefficient(&self) -> usize {
        self.coefficient
    }

    /// Label of the coefficient, `x` or `xz`.
    pub fn label(&self) -> &'static str {
        self.source.term.labels()[self.coefficient]
    }

    /// Unit of the coefficient.
    pub fn unit(&self) -> Unit {
        self.source.unit()
    }

    /// The process of the coefficient with its numbers.
    pub fn evolution(&self) -> Evolution {
        self.source.process.evolution(self.coefficient, self.source.gain)
    }

    /// Whether it is the same component, whatever its gain.
    pub fn is(&self, o: &Component) -> bool {
        let (a, b) = (&self.source, &o.source);
        self.coefficient == o.coefficient
            && a.instrument == b.instrument
            && a.term == b.term
            && a.process.kind() == b.process.kind()
            && a.occurrence == b.occurrence
    }
}

impl fmt::Display for Component {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}.{}", self.source.name(), self.label())
    }
}
