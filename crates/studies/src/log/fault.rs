//! What can be wrong with a log, each with file, line, column, what was expected and what was found.

use std::io;
use std::path::Path;

use super::rows::Rows;
use crate::{Diagnostic, Error};

/// A field of the current row, for messages.
pub(super) struct Field<'a> {
    pub file: &'a Path,
    pub rows: &'a Rows,
    /// Index of the field, from 0.
    pub index: usize,
    pub name: &'a str,
}

impl Field<'_> {
    /// A fault in this field, shown in its row.
    pub fn fault(&self, problem: impl Into<String>) -> Diagnostic {
        let (line, begin) = self.rows.around();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let span = self.rows.spans().nth(self.index).unwrap_or(0..0);
        let row = text(line);
        let start = text(&line[..begin + span.start]).len();
        let end = start + text(&line[begin + span.start..begin + span.end]).len();
        let number = self.rows.number();
        Diagnostic::new(self.file, problem)
            .at(number, row[..start].chars().count() as u64 + 1)
            .path(self.name)
            .excerpt(number, &row, start..end)
    }

    fn bytes(&self) -> &[u8] {
        self.rows.fields().nth(self.index).unwrap_or_default()
    }

    /// The diagnostic for a field that is no finite number.
    pub fn no_number(&self) -> Diagnostic {
        let text = String::from_utf8_lossy(self.bytes());
        let short: String = text.chars().take(40).collect();
        let found = if short.len() < text.len() { format!("`{short}…`") } else { format!("`{short}`") };
        let problem = match std::str::from_utf8(self.bytes()).map(str::trim) {
            Err(_) => "bytes that are no text where a number belongs",
            Ok("") => "an empty field where a number belongs",
            Ok(text) if text.parse::<f64>().is_ok() => "a number that is not finite",
            Ok(_) => "text where a number belongs",
        };
        let expected = "a finite number in every row, as in `-1.25e-3`";
        self.fault(problem).expected(expected).found(found)
    }
}

/// What reading the bytes met: a broken gzip stream is told from a disk that fails.
pub(super) fn reading(file: &Path, rows: u64, error: io::Error) -> Error {
    let end = match rows {
        0 => "before the first row".to_string(),
        n => format!("after {n} rows"),
    };
    let broken = |problem: &str, help: &str| {
        Diagnostic::new(file, format!("{problem} {end}")).found(error.to_string()).help(help).into()
    };
    match error.kind() {
        io::ErrorKind::UnexpectedEof => {
            broken("the gzip stream is cut off", "the file is not whole: copy or download it again")
        }
        io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => {
            broken("the gzip stream is damaged", "the file is damaged: copy or download it again")
        }
        io::ErrorKind::Other => broken("the log cannot be read", ""),
        _ => Error::Read { path: file.into(), source: error },
    }
}
