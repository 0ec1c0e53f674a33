//! A log as a stream of samples.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use flate2::bufread::MultiGzDecoder;
use schuler_strapdown::Increments;

use super::bytes::Counted;
use super::clock::{Clock, Week};
use super::npy::{self, NpyRows};
use super::parquet_rows::{self, ParquetRows};
use super::slots::{SLOTS, TIME, Wanted, wanted};
use super::text::TextRows;
use super::{Content, LogSpec, fault};
use crate::{Diagnostic, Error, Progress};

/// One sample of a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogSample {
    /// End of the interval, s: as the time column has it, or k/rate for row k (from 1).
    pub t: f64,
    /// Integrals of angular rate (rad) and specific force (m/s) over the interval of 1/rate, along b; zero where the
    /// log has no column.
    pub increments: Increments,
}

/// Reads a log row by row, in memory that does not grow. Ends after the first error.
pub struct LogReader {
    file: PathBuf,
    spec: LogSpec,
    rows: Rows,
    /// Factors from counts to increments and seconds.
    per_count: [f64; SLOTS],
    clock: Option<Clock>,
    week: Option<Week>,
    /// Samples delivered so far.
    count: u64,
    done: bool,
    /// Bytes of the file read so far, and all of them; none for a log that is no file.
    size: Option<(Counted, u64)>,
}

/// The rows of a log, in counts.
pub(super) enum Rows {
    Text(TextRows),
    Npy(NpyRows),
    Parquet(ParquetRows),
}

/// Size of the buffers on both sides of the decompression.
const BUFFER: usize = 1 << 16;

/// Shares of a log after which progress is told.
const STEPS: u64 = 500;

impl Rows {
    pub fn new(
        file: &Path,
        mut bytes: impl BufRead + Send + 'static,
        wanted: &[Wanted<'_>],
    ) -> Result<Self, Error> {
        let failed = |e| fault::reading(file, 0, e);
        let mut plain: Box<dyn BufRead + Send> = match bytes.fill_buf().map_err(failed)? {
            [0x1f, 0x8b, ..] => Box::new(BufReader::with_capacity(BUFFER, MultiGzDecoder::new(bytes))),
            _ => Box::new(bytes),
        };
        Ok(match plain.fill_buf().map_err(failed)? {
            // It is read from its end on, which a stream does not have.
            first if first.starts_with(parquet_rows::FIRST) => {
                Rows::Parquet(ParquetRows::open(file, wanted)?)
            }
            [npy::FIRST, ..] => Rows::Npy(NpyRows::new(file, plain, wanted)?),
            _ => Rows::Text(TextRows::new(file, plain, wanted)?),
        })
    }

    /// The next row, `None` at the end.
    pub fn advance(&mut self) -> Result<Option<[f64; SLOTS]>, Error> {
        match self {
            Rows::Text(rows) => rows.advance(),
            Rows::Npy(rows) => rows.advance(),
            Rows::Parquet(rows) => rows.advance(),
        }
    }

    /// Number of columns, read or not.
    pub fn width(&self) -> usize {
        match self {
            Rows::Text(rows) => rows.titles.len(),
            Rows::Npy(rows) => rows.titles.len(),
            Rows::Parquet(rows) => rows.titles.len(),
        }
    }

    /// A fault in the number of the current row that goes into `slot`.
    pub fn fault(&self, slot: usize, problem: &str, found: String) -> Diagnostic {
        match self {
            Rows::Text(rows) => rows.fault(slot, problem).found(found),
            Rows::Npy(rows) => rows.fault(slot, problem).found(format!("{found}, in {}", rows.place(slot))),
            Rows::Parquet(rows) => rows.fault(slot, problem).found(format!("{found}, in {}", rows.place())),
        }
    }
}

/// The names of the columns of the log `file`: the fields of its first row; empty ones for an array without names.
///
/// # Errors
/// As [`LogReader::open`].
pub fn titles(file: &Path) -> Result<Vec<String>, Error> {
    let failed = |source| Error::Read { path: file.into(), source };
    let bytes = BufReader::with_capacity(BUFFER, File::open(file).map_err(failed)?);
    Ok(match Rows::new(file, bytes, &[])? {
        Rows::Text(rows) => rows.titles,
        Rows::Npy(rows) => rows.titles,
        Rows::Parquet(rows) => rows.titles,
    })
}

impl LogReader {
    /// Opens the log `file`; gzip, npy and Parquet are recognised by their first bytes.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be opened, [`Error::Input`] if it is empty, a damaged gzip stream, an array
    /// that is no table of numbers, or lacks a column.
    pub fn open(spec: &LogSpec, file: &Path) -> Result<Self, Error> {
        let failed = |source| Error::Read { path: file.into(), source };
        let handle = File::open(file).map_err(failed)?;
        let size = handle.metadata().map_err(failed)?.len();
        let counted = Counted::default();
        let bytes = BufReader::with_capacity(BUFFER, counted.of(handle));
        let reader = Self::from_bytes(spec, file, bytes)?;
        Ok(LogReader { size: Some((counted, size)), ..reader })
    }

    /// Reads a log from `bytes`; `file` is its name in messages.
    ///
    /// # Errors
    /// As [`LogReader::open`].
    pub fn from_bytes(
        spec: &LogSpec,
        file: &Path,
        bytes: impl BufRead + Send + 'static,
    ) -> Result<Self, Error> {
        let rows = Rows::new(file, bytes, &wanted(&spec.columns))?;
        let interval = match spec.content {
            Content::Increments => 1.0,
            Content::Rates => 1.0 / spec.rate,
        };
        let ([a, b, c], [d, e, f]) = (spec.scale.gyro, spec.scale.accel);
        let [a, b, c, d, e, f] = [a, b, c, d, e, f].map(|scale| scale * interval);
        let time = spec.columns.time.as_ref().map_or(1.0, |time| time.scale);
        Ok(LogReader {
            file: file.into(),
            spec: spec.clone(),
            rows,
            per_count: [a, b, c, d, e, f, time],
            clock: None,
            week: spec.columns.time.as_ref().filter(|time| time.week).map(|_| Week::default()),
            count: 0,
            done: false,
            size: None,
        })
    }

    /// Interval of every sample, s.
    pub fn dt(&self) -> f64 {
        1.0 / self.spec.rate
    }

    /// Samples delivered so far.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The samples, while `progress` is told how much of the file is read.
    pub fn watched(self, progress: &dyn Progress) -> impl Iterator<Item = Result<LogSample, Error>> {
        let (counted, size) = self.size.clone().unwrap_or_default();
        progress.begin("log", size.max(1));
        let mut told = 0;
        self.inspect(move |_| {
            let read = counted.bytes().min(size);
            if read > told + size / STEPS {
                progress.advance(read - told);
                told = read;
            }
        })
    }

    fn sample(&mut self, counts: [f64; SLOTS]) -> LogSample {
        let mut values = counts;
        for (value, per_count) in values.iter_mut().zip(&self.per_count) {
            *value *= per_count;
        }
        let [a, b, c, d, e, f, time] = values;
        let time = self.week.as_mut().map_or(time, |week| week.unrolled(time));
        let t =
            if self.spec.columns.time.is_some() { time } else { (self.count + 1) as f64 / self.spec.rate };
        let axes = &self.spec.axes;
        LogSample {
            t,
            increments: Increments { dtheta: axes.to_body([a, b, c]), dv: axes.to_body([d, e, f]) },
        }
    }

    fn check_time(&mut self, t: f64) -> Result<(), Error> {
        if self.spec.columns.time.is_none() {
            return Ok(());
        }
        let Some(clock) = &mut self.clock else {
            self.clock = Some(Clock::new(t, self.spec.rate));
            return Ok(());
        };
        clock.tick(t).map_err(|wrong| {
            let help = "lost samples have to be mended before; the rate stated is `log.rate` of a scenario, or `--rate`";
            let fault = self.rows.fault(TIME, wrong.problem, wrong.found);
            fault.help(help).expected(format!("a row every {} s", 1.0 / self.spec.rate)).into()
        })
    }

    fn advance(&mut self) -> Result<Option<LogSample>, Error> {
        let Some(counts) = self.rows.advance()? else {
            return match self.count {
                0 => Err(Diagnostic::new(&self.file, "the log has a header and no rows").into()),
                _ => Ok(None),
            };
        };
        let sample = self.sample(counts);
        self.check_time(sample.t)?;
        self.count += 1;
        Ok(Some(sample))
    }
}

impl Iterator for LogReader {
    type Item = Result<LogSample, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.done {
            return None;
        }
        let sample = self.advance().transpose();
        self.done = !matches!(sample, Some(Ok(_)));
        sample
    }
}
