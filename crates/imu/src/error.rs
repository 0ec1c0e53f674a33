//! What can be wrong with a specification.

use core::fmt;

use thiserror::Error;

use crate::process::{Form, Range};
use crate::{Instrument, PROCESSES, TERMS};

/// What can be wrong with a specification; once built, nothing fails.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// No term of that name.
    #[error("there is no term `{name}`; terms are {}", Registry(TERMS.iter().map(|t| t.name())))]
    UnknownTerm {
        /// The name.
        name: Text,
    },
    /// No process of that name.
    #[error("there is no process `{name}`; processes are {}", Registry(PROCESSES.iter().map(|p| p.name())))]
    UnknownProcess {
        /// The name.
        name: Text,
    },
    /// A parameter that no form of the process has.
    #[error("process `{process}` has no parameter `{name}`; it takes {forms}")]
    UnknownParameter {
        /// Name of the process.
        process: &'static str,
        /// The stray name.
        name: Text,
        /// What it takes.
        forms: Names,
    },
    /// Parameters that make no form of the process: some missing, too many, or of two forms.
    #[error("process `{process}` got {given} parameter(s) that do not go together; it takes {forms}")]
    ParameterSet {
        /// Name of the process.
        process: &'static str,
        /// How many were given.
        given: usize,
        /// What it takes.
        forms: Names,
    },
    /// A number out of range.
    #[error("`{name}` of process `{process}` is {value}, but must be {range}")]
    OutOfRange {
        /// Name of the process.
        process: &'static str,
        /// Name of the parameter.
        name: &'static str,
        /// The number found.
        value: f64,
        /// What it must be.
        range: Range,
    },
    /// Numbers that do not go together.
    #[error("process `{process}`: {reason}")]
    Conflict {
        /// Name of the process.
        process: &'static str,
        /// What is wrong.
        reason: &'static str,
    },
    /// A list of the wrong length.
    #[error(
        "`{name}` of process `{process}` is a list of {found} numbers, but {need} are needed (or one number for all)"
    )]
    ListLength {
        /// Name of the process.
        process: &'static str,
        /// Name of the parameter.
        name: &'static str,
        /// Numbers found.
        found: usize,
        /// Numbers needed.
        need: usize,
    },
    /// Lists that do not fit the coefficients of the term.
    #[error("term `{term}` has {need} coefficients ({}), but its process `{process}` was given lists of {found}", Registry(.labels.iter().copied()))]
    Coefficients {
        /// Name of the term.
        term: &'static str,
        /// Labels of its coefficients.
        labels: &'static [&'static str],
        /// Name of the process.
        process: &'static str,
        /// Numbers found.
        found: usize,
        /// Numbers needed.
        need: usize,
    },
    /// A term that the instrument cannot have.
    #[error("term `{term}` does not exist on `{instrument}`, only on `{only}`")]
    Instrument {
        /// Name of the term.
        term: &'static str,
        /// The instrument asked for.
        instrument: Instrument,
        /// The one that has it.
        only: Instrument,
    },
    /// A number of the readout that makes no sense.
    #[error("readout: `{name}` is {value}, but must be {need}")]
    Readout {
        /// Name of the number.
        name: &'static str,
        /// The number found.
        value: f64,
        /// What it must be.
        need: &'static str,
    },
    /// A number of a temperature profile that makes no sense.
    #[error("temperature: `{name}` is {value}, but must be {need}")]
    Temperature {
        /// Name of the number.
        name: &'static str,
        /// The number found.
        value: f64,
        /// What it must be.
        need: &'static str,
    },
    /// A state that was saved from another specification or by another version.
    #[error("this state does not belong to this sensor: {reason}")]
    ForeignState {
        /// What differs.
        reason: &'static str,
    },
    /// More than a fixed capacity holds.
    #[error("too many {what}: this specification needs {need}, the crate holds {capacity}")]
    Capacity {
        /// What there are too many of.
        what: &'static str,
        /// How many are needed.
        need: usize,
        /// How many there can be.
        capacity: usize,
    },
}

/// A short text kept in place, cut after 32 bytes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Text {
    bytes: [u8; 32],
    len: usize,
}

impl Text {
    pub(crate) fn new(s: &str) -> Text {
        let mut len = s.len().min(32);
        while !s.is_char_boundary(len) {
            len -= 1;
        }
        let mut bytes = [0; 32];
        bytes[..len].copy_from_slice(&s.as_bytes()[..len]);
        Text { bytes, len }
    }
}

impl fmt::Display for Text {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(core::str::from_utf8(&self.bytes[..self.len]).unwrap_or_default())
    }
}

impl fmt::Debug for Text {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "\"{self}\"")
    }
}

/// The forms of a process as text: `{ value } or { sigma }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Names(pub &'static [Form]);

impl fmt::Display for Names {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, form) in self.0.iter().enumerate() {
            out.write_str(if i == 0 { "{ " } else { " or { " })?;
            for (j, parameter) in form.iter().enumerate() {
                write!(out, "{}{}", if j == 0 { "" } else { ", " }, parameter.name)?;
            }
            out.write_str(" }")?;
        }
        Ok(())
    }
}

/// Names with commas between them.
struct Registry<I>(I);

impl<I: Iterator<Item = &'static str> + Clone> fmt::Display for Registry<I> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, name) in self.0.clone().enumerate() {
            write!(out, "{}{name}", if i == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}
