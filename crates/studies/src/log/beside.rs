//! A log beside that of the IMU: a time and a few numbers a row, kept whole.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use super::ColumnRef;
use super::clock::Week;
use super::reader::Rows;
use super::slots::{SLOTS, Wanted};
use crate::{Diagnostic, Error};

/// One row: the numbers of the columns asked for, in their order, the time first; zero beyond them.
pub type Row = [f64; SLOTS];

/// What is known of a log beside the IMU but for its columns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Times are seconds of a GNSS week, which begin anew at its end.
    pub week: bool,
    /// How many fields a row has; any number where absent.
    pub fields: Option<usize>,
}

/// The rows of the log `file`, CSV or npy, either also gzipped. The first of `columns` is the time; there are seven
/// at most.
///
/// # Errors
/// As [`LogReader::open`](super::LogReader::open); another number of fields; a time that does not increase; no row.
pub fn rows(file: &Path, columns: &[ColumnRef], layout: Layout) -> Result<Vec<Row>, Error> {
    let wanted: Vec<Wanted> =
        columns.iter().take(SLOTS).enumerate().map(|(slot, column)| Wanted { slot, column }).collect();
    let handle = File::open(file).map_err(|source| Error::Read { path: file.into(), source })?;
    let mut rows = Rows::new(file, BufReader::new(handle), &wanted)?;
    if let Some(fields) = layout.fields.filter(|fields| *fields != rows.width()) {
        return Err(Diagnostic::new(file, "the log is not of this format")
            .expected(format!("{fields} fields in a row"))
            .found(format!("{} fields", rows.width()))
            .help("state `columns` instead of `format`")
            .into());
    }
    let mut week = Week::default();
    let mut out: Vec<Row> = Vec::new();
    while let Some(mut row) = rows.advance()? {
        if layout.week {
            row[0] = week.unrolled(row[0]);
        }
        if let Some(last) = out.last().filter(|last| row[0] <= last[0]) {
            let found = format!("{} s after {} s", row[0], last[0]);
            let fault = rows.fault(0, "times do not increase", found);
            return Err(fault.expected("rows in the order of time, each time once").into());
        }
        out.push(row);
    }
    match out.is_empty() {
        true => Err(Diagnostic::new(file, "the log has a header and no rows").into()),
        false => Ok(out),
    }
}
