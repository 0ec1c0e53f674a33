//! One fault in somebody's input: where it is, what was expected, what was found, what would work.

use std::{fmt, ops::Range, path::PathBuf, sync::Arc};

/// A fault in an input file. Every part but the file and the problem may be empty.
///
/// `Display` gives plain text, one fact a line; the command line draws the excerpt as well.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// The input file, as the user named it.
    pub file: PathBuf,
    /// Where in the file.
    pub place: Option<Place>,
    /// Path of the key, `imu.gyro[0].bias.constant.value`, or the column of a log.
    pub path: String,
    /// What is wrong, one sentence without a full stop.
    pub problem: String,
    /// What was expected there.
    pub expected: String,
    /// What was found.
    pub found: String,
    /// Something that would work, ready to copy.
    pub example: String,
    /// Anything else that helps: a key of a similar name, where the data comes from.
    pub help: String,
    /// The text around the fault.
    pub excerpt: Option<Excerpt>,
}

/// Line and column, both from 1, column in characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line, from 1.
    pub line: u64,
    /// Column, from 1. Zero when the whole line is meant.
    pub column: u64,
}

/// The text that holds the fault, and the bytes of it that are meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// A text, whole (a scenario) or the one line (a log).
    pub text: Arc<str>,
    /// Line number of the first line of `text`.
    pub first_line: u64,
    /// The bytes of `text` that are meant.
    pub span: Range<usize>,
}

impl Diagnostic {
    /// A fault in `file`; the other parts are added by the methods below.
    pub fn new(file: impl Into<PathBuf>, problem: impl Into<String>) -> Self {
        Diagnostic {
            file: file.into(),
            place: None,
            path: String::new(),
            problem: problem.into(),
            expected: String::new(),
            found: String::new(),
            example: String::new(),
            help: String::new(),
            excerpt: None,
        }
    }

    /// Where: line and column from 1 (column 0 for a whole line).
    pub fn at(mut self, line: u64, column: u64) -> Self {
        self.place = Some(Place { line, column });
        self
    }

    /// Path of the key or the column.
    pub fn path(mut self, path: impl Into<String>) -> Self {
        self.path = path.into();
        self
    }

    /// What was expected.
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = expected.into();
        self
    }

    /// What was found.
    pub fn found(mut self, found: impl Into<String>) -> Self {
        self.found = found.into();
        self
    }

    /// What would work.
    pub fn example(mut self, example: impl Into<String>) -> Self {
        self.example = example.into();
        self
    }

    /// Anything else that helps.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = help.into();
        self
    }

    /// The one line `text`, number `line` of the file, with the bytes that are meant.
    pub fn excerpt(mut self, line: u64, text: &str, span: Range<usize>) -> Self {
        self.excerpt = Some(Excerpt { text: text.into(), first_line: line, span });
        self
    }

    /// The facts below the headline, as (name, text), empty ones left out.
    pub fn facts(&self) -> impl Iterator<Item = (&'static str, &str)> {
        [
            ("expected", &self.expected),
            ("found", &self.found),
            ("example", &self.example),
            ("help", &self.help),
        ]
        .into_iter()
        .filter(|(_, text)| !text.is_empty())
        .map(|(name, text)| (name, text.as_str()))
    }

    /// `path: problem`, or the problem alone.
    pub fn headline(&self) -> String {
        match self.path.as_str() {
            "" => self.problem.clone(),
            path => format!("{path}: {}", self.problem),
        }
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        match self.place {
            Some(Place { line, column: 0 }) => write!(f, ":{line}")?,
            Some(Place { line, column }) => write!(f, ":{line}:{column}")?,
            None => {}
        }
        write!(f, ": {}", self.headline())?;
        for (name, text) in self.facts() {
            write!(f, "\n  {name}: {text}")?;
        }
        Ok(())
    }
}
