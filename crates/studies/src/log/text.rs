//! A log as text: rows of numbers behind a header, or without one where columns go by number.

use std::io::BufRead;
use std::path::{Path, PathBuf};

use super::fault::{self, Field};
use super::rows::{BLANK, Rows, blanks};
use super::slots::{SLOTS, Wanted, names, settle};
use super::{ColumnRef, number};
use crate::{Diagnostic, Error};

/// Rows of text, in counts.
pub(super) struct TextRows {
    file: PathBuf,
    rows: Rows,
    /// The first row, where it was read to see whether it is a header and is none.
    pending: bool,
    /// What each field of a row is for.
    slots: Vec<Option<usize>>,
    names: [String; SLOTS],
    /// The fields of the first row.
    pub titles: Vec<String>,
    /// Rows delivered so far.
    count: u64,
}

impl TextRows {
    /// Finds in the first row, or by number, where the columns stand.
    pub fn new(file: &Path, text: Box<dyn BufRead + Send>, wanted: &[Wanted<'_>]) -> Result<Self, Error> {
        let mut rows = Rows::new(text);
        if !rows.advance().map_err(|e| fault::reading(file, 0, e))? {
            return Err(Diagnostic::new(file, "the log is empty").into());
        }
        rows.settle_separator();
        let title = |field: &[u8]| String::from_utf8_lossy(field).trim().trim_matches('"').to_string();
        let header: Vec<String> = rows.fields().map(title).collect();
        let slots = settle(file, wanted, &header).map_err(|wrong| wrong.at(rows.number(), 0))?;
        // Names need a header. Numbers do not: the first row is one if none of its columns is a number.
        let by_name = wanted.iter().any(|w| matches!(w.column, ColumnRef::Name(_)));
        let is_number =
            |(slot, title): (&Option<usize>, &String)| slot.is_some() && title.parse::<f64>().is_ok();
        let pending = !by_name && slots.iter().zip(&header).any(is_number);
        Ok(TextRows {
            file: file.into(),
            rows,
            pending,
            slots,
            names: names(wanted),
            titles: header,
            count: 0,
        })
    }

    /// The next row, `None` at the end.
    pub fn advance(&mut self) -> Result<Option<[f64; SLOTS]>, Error> {
        let there = std::mem::take(&mut self.pending)
            || self.rows.advance().map_err(|e| fault::reading(&self.file, self.count, e))?;
        if !there {
            return Ok(None);
        }
        let numbers = self.numbers()?;
        self.count += 1;
        Ok(Some(numbers))
    }

    /// A fault in the field of the current row that goes into `slot`.
    pub fn fault(&self, slot: usize, problem: &str) -> Diagnostic {
        let index = self.slots.iter().position(|s| *s == Some(slot)).unwrap_or_default();
        self.field(index, slot).fault(problem)
    }

    fn field(&self, index: usize, slot: usize) -> Field<'_> {
        let name = self.names.get(slot).map_or("", String::as_str);
        Field { file: &self.file, rows: &self.rows, index, name }
    }

    /// The numbers of the current row in the order of their slots.
    fn numbers(&self) -> Result<[f64; SLOTS], Error> {
        if !self.rows.is_whole() {
            return Err(self.damaged().into());
        }
        let mut numbers = [0.0; SLOTS];
        let blank = self.rows.separator() == BLANK;
        let mut rest = self.rows.line();
        if blank {
            rest = rest[blanks(rest)..].trim_ascii_end();
        }
        for (index, slot) in self.slots.iter().enumerate() {
            let ends = |(_, used): &(f64, usize)| rest.get(*used).is_none_or(|b| self.rows.ends(*b));
            let known = slot.and_then(|_| number::leading(rest)).filter(ends);
            let end = match known {
                Some((_, used)) => used,
                None => rest.iter().position(|b| self.rows.ends(*b)).unwrap_or(rest.len()),
            };
            if let Some(slot) = *slot {
                let value = match known {
                    Some((value, _)) => Some(value),
                    None => {
                        std::str::from_utf8(rest[..end].trim_ascii()).ok().and_then(|text| text.parse().ok())
                    }
                };
                match value {
                    Some(value) if value.is_finite() => numbers[slot] = value,
                    _ => return Err(self.wrong_row(Some((index, slot)))),
                }
            }
            let last = index + 1 == self.slots.len();
            if last != (end == rest.len()) {
                return Err(self.wrong_row(None));
            }
            rest = match (last, blank) {
                (true, _) => &[],
                (false, false) => &rest[end + 1..],
                (false, true) => &rest[end + blanks(&rest[end..])..],
            };
        }
        Ok(numbers)
    }

    /// The error of a message that is not as it was sent.
    #[cold]
    fn damaged(&self) -> Diagnostic {
        self.field(0, SLOTS)
            .fault("the message does not fit its checksum")
            .expected("a message as the receiver wrote it")
            .help("the line is damaged: take it out, and mend the gap")
    }

    /// The error of a row that has another number of fields than the first, or no number at `(index, slot)`.
    #[cold]
    fn wrong_row(&self, place: Option<(usize, usize)>) -> Error {
        let (found, expected) = (self.rows.fields().count(), self.slots.len());
        match place {
            Some((index, slot)) if found == expected => self.field(index, slot).no_number().into(),
            _ => {
                let problem = if found < expected { "a short row" } else { "a long row" };
                let fault = self.field(found.min(expected), SLOTS).fault(problem);
                fault
                    .at(self.rows.number(), 0)
                    .expected(format!("{expected} fields, as in the first row"))
                    .found(format!("{found} fields"))
                    .into()
            }
        }
    }
}
