//! A log as a stream of samples.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use flate2::bufread::MultiGzDecoder;
use schuler_strapdown::Increments;

use super::clock::Clock;
use super::fault::{self, Field};
use super::rows::Rows;
use super::{ColumnRef, Content, LogSpec, number};
use crate::{Diagnostic, Error};

/// One sample of a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogSample {
    /// End of the interval, s: as the time column has it, or k/rate for row k (from 1).
    pub t: f64,
    /// Integrals of angular rate (rad) and specific force (m/s) over the interval of 1/rate, along b.
    pub increments: Increments,
}

/// Reads a log row by row, in memory that does not grow. Ends after the first error.
pub struct LogReader {
    file: PathBuf,
    spec: LogSpec,
    rows: Rows,
    /// The first row, where it was read to see whether it is a header and is none.
    pending: bool,
    /// What each field of a row is for.
    slots: Vec<Option<usize>>,
    /// Names of what goes into the slots: three gyros, three accelerometers, time.
    names: Vec<String>,
    /// Factors from counts to increments and seconds.
    per_count: [f64; SLOTS],
    clock: Option<Clock>,
    /// Samples delivered so far.
    count: u64,
    done: bool,
}

/// Gyros, accelerometers, time.
const SLOTS: usize = 7;
const TIME: usize = 6;

/// Size of the buffers on both sides of the decompression.
const BUFFER: usize = 1 << 16;

impl LogReader {
    /// Opens the log `file`; gzip is recognised by its first bytes.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be opened, [`Error::Input`] if it is empty, a damaged gzip stream, or
    /// lacks a column.
    pub fn open(spec: &LogSpec, file: &Path) -> Result<Self, Error> {
        let failed = |source| Error::Read { path: file.into(), source };
        let bytes = BufReader::with_capacity(BUFFER, File::open(file).map_err(failed)?);
        Self::from_bytes(spec, file, bytes)
    }

    /// Reads a log from `bytes`; `file` is its name in messages.
    ///
    /// # Errors
    /// As [`LogReader::open`].
    pub fn from_bytes(
        spec: &LogSpec,
        file: &Path,
        mut bytes: impl BufRead + Send + 'static,
    ) -> Result<Self, Error> {
        let head = bytes.fill_buf().map_err(|e| fault::reading(file, 0, e))?;
        let text: Box<dyn BufRead + Send> = match head {
            [0x1f, 0x8b, ..] => Box::new(BufReader::with_capacity(BUFFER, MultiGzDecoder::new(bytes))),
            _ => Box::new(bytes),
        };
        let interval = match spec.content {
            Content::Increments => 1.0,
            Content::Rates => 1.0 / spec.rate,
        };
        let ([a, b, c], [d, e, f]) = (spec.scale.gyro, spec.scale.accel);
        let [a, b, c, d, e, f] = [a, b, c, d, e, f].map(|scale| scale * interval);
        let time = spec.columns.time.as_ref().map_or(1.0, |time| time.scale);
        let mut reader = LogReader {
            file: file.into(),
            spec: spec.clone(),
            rows: Rows::new(text),
            pending: false,
            slots: Vec::new(),
            names: Vec::new(),
            per_count: [a, b, c, d, e, f, time],
            clock: None,
            count: 0,
            done: false,
        };
        if !reader.advance()? {
            return Err(Diagnostic::new(file, "the log is empty").into());
        }
        reader.find_columns()?;
        Ok(reader)
    }

    /// Interval of every sample, s.
    pub fn dt(&self) -> f64 {
        1.0 / self.spec.rate
    }

    /// Samples delivered so far.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Finds in the first row, or by number, where the columns stand.
    fn find_columns(&mut self) -> Result<(), Error> {
        self.rows.settle_separator();
        let title = |field: &[u8]| String::from_utf8_lossy(field).trim().trim_matches('"').to_string();
        let header: Vec<String> = self.rows.fields().map(title).collect();
        let columns = &self.spec.columns;
        let time = columns.time.as_ref().map(|time| &time.column);
        let wanted: Vec<&ColumnRef> = columns.gyro.iter().chain(&columns.accel).chain(time).collect();
        self.slots = vec![None; header.len()];
        for (slot, column) in wanted.iter().enumerate() {
            let place = match column {
                ColumnRef::Number(number) => number.checked_sub(1).filter(|index| *index < header.len()),
                ColumnRef::Name(name) => header.iter().position(|title| title == name.trim()),
            };
            let problem = match place {
                None => "the log has no such column",
                Some(index) if self.slots[index].is_some() => "the column is named twice",
                Some(index) => {
                    self.slots[index] = Some(slot);
                    continue;
                }
            };
            return Err(Diagnostic::new(&self.file, problem)
                .at(self.rows.number(), 0)
                .path(column.to_string())
                .expected(format!("the columns {}", list(&wanted)))
                .found(format!("{} columns: {}", header.len(), list(&header)))
                .into());
        }
        // Names need a header. Numbers do not: the first row is one if none of its columns is a number.
        let by_name = wanted.iter().any(|column| matches!(column, ColumnRef::Name(_)));
        let is_number =
            |(slot, title): (&Option<usize>, &String)| slot.is_some() && title.parse::<f64>().is_ok();
        self.pending = !by_name && self.slots.iter().zip(&header).any(is_number);
        self.names = wanted.iter().map(|column| column.to_string()).collect();
        Ok(())
    }

    fn advance(&mut self) -> Result<bool, Error> {
        self.rows.advance().map_err(|e| fault::reading(&self.file, self.count, e))
    }

    fn field(&self, index: usize, slot: usize) -> Field<'_> {
        let name = self.names.get(slot).map_or("", String::as_str);
        Field { file: &self.file, rows: &self.rows, index, name }
    }

    /// The numbers of the current row in the order of their slots, in SI.
    fn numbers(&self) -> Result<[f64; SLOTS], Error> {
        let mut numbers = [0.0; SLOTS];
        let separator = self.rows.separator();
        let mut rest = self.rows.line();
        for (index, slot) in self.slots.iter().enumerate() {
            let ends = |(_, used): &(f64, usize)| rest.get(*used).is_none_or(|b| *b == separator);
            let known = slot.and_then(|_| number::leading(rest)).filter(ends);
            let end = match known {
                Some((_, used)) => used,
                None => rest.iter().position(|b| *b == separator).unwrap_or(rest.len()),
            };
            if let Some(slot) = *slot {
                let value = match known {
                    Some((value, _)) => Some(value),
                    None => {
                        std::str::from_utf8(rest[..end].trim_ascii()).ok().and_then(|text| text.parse().ok())
                    }
                };
                match value {
                    Some(value) if value.is_finite() => numbers[slot] = value * self.per_count[slot],
                    _ => return Err(self.wrong_row(Some((index, slot)))),
                }
            }
            let last = index + 1 == self.slots.len();
            if last != (end == rest.len()) {
                return Err(self.wrong_row(None));
            }
            rest = if last { &[] } else { &rest[end + 1..] };
        }
        Ok(numbers)
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

    fn sample(&mut self) -> Result<LogSample, Error> {
        let [a, b, c, d, e, f, time] = self.numbers()?;
        let t = if self.spec.columns.time.is_some() {
            self.check_time(time)?;
            time
        } else {
            (self.count + 1) as f64 / self.spec.rate
        };
        self.count += 1;
        let axes = &self.spec.axes;
        Ok(LogSample {
            t,
            increments: Increments { dtheta: axes.to_body([a, b, c]), dv: axes.to_body([d, e, f]) },
        })
    }

    fn check_time(&mut self, t: f64) -> Result<(), Error> {
        let Some(clock) = &mut self.clock else {
            self.clock = Some(Clock::new(t, self.spec.rate));
            return Ok(());
        };
        clock.tick(t).map_err(|wrong| {
            let index = self.slots.iter().position(|slot| *slot == Some(TIME)).unwrap_or_default();
            let help = "lost samples have to be mended before; the rate is `log.rate` of the scenario";
            let fault = self.field(index, TIME).fault(wrong.problem).found(wrong.found).help(help);
            fault.expected(format!("a row every {} s", 1.0 / self.spec.rate)).into()
        })
    }
}

impl Iterator for LogReader {
    type Item = Result<LogSample, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.done {
            return None;
        }
        let row = if std::mem::take(&mut self.pending) { Ok(true) } else { self.advance() };
        let sample = match row {
            Ok(true) => Some(self.sample()),
            Ok(false) if self.count == 0 => {
                Some(Err(Diagnostic::new(&self.file, "the log has a header and no rows").into()))
            }
            Ok(false) => None,
            Err(error) => Some(Err(error)),
        };
        self.done = !matches!(sample, Some(Ok(_)));
        sample
    }
}

fn list(names: &[impl ToString]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{}`", name.to_string())).collect();
    names.join(", ")
}
