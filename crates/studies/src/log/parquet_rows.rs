//! A log as a Parquet table.

use std::fs::File;
use std::path::{Path, PathBuf};

use parquet::{
    column::reader::{ColumnReader, ColumnReaderImpl},
    data_type::DataType,
    errors::ParquetError,
    file::reader::{FileReader, SerializedFileReader},
};

use super::slots::{SLOTS, TIME, Wanted, names, settle};
use crate::{Diagnostic, Error};

/// What a Parquet file begins with.
pub(super) const FIRST: &[u8] = b"PAR1";

/// Rows that are read at a time.
const BLOCK: usize = 1 << 13;

/// Rows of a table, in counts.
pub(super) struct ParquetRows {
    path: PathBuf,
    file: SerializedFileReader<File>,
    /// Slot and column of what is read, in the order of the slots.
    wanted: Vec<(usize, usize)>,
    names: [String; SLOTS],
    /// The names of all columns.
    pub titles: Vec<String>,
    /// The group of rows that comes next; of the current one its columns and how many rows they still have.
    group: usize,
    columns: Vec<ColumnReader>,
    left: usize,
    /// Some rows, and how many of these are delivered.
    numbers: Vec<[f64; SLOTS]>,
    at: usize,
    /// Rows delivered so far.
    count: u64,
}

impl ParquetRows {
    /// Reads the description of the table `path`, and finds the columns by number or name.
    pub fn open(path: &Path, wanted: &[Wanted<'_>]) -> Result<Self, Error> {
        let file = File::open(path).map_err(|source| Error::Read { path: path.into(), source })?;
        let file = SerializedFileReader::new(file).map_err(|e| damaged(path, &e))?;
        let columns = file.metadata().file_metadata().schema_descr().columns();
        let titles: Vec<String> = columns.iter().map(|column| column.path().string()).collect();
        let slots = settle(path, wanted, &titles)?;
        let mut wanted_columns: Vec<(usize, usize)> =
            slots.into_iter().enumerate().filter_map(|(column, slot)| Some((slot?, column))).collect();
        wanted_columns.sort_unstable();
        Ok(ParquetRows {
            path: path.into(),
            file,
            wanted: wanted_columns,
            names: names(wanted),
            titles,
            group: 0,
            columns: Vec::new(),
            left: 0,
            numbers: Vec::new(),
            at: 0,
            count: 0,
        })
    }

    /// The next row, `None` at the end.
    pub fn advance(&mut self) -> Result<Option<[f64; SLOTS]>, Error> {
        if self.at == self.numbers.len() && !self.refill()? {
            return Ok(None);
        }
        let numbers = self.numbers[self.at];
        if let Some(slot) = numbers.iter().position(|x| !x.is_finite()) {
            return Err(self
                .fault(slot, "a number that is not finite")
                .expected("a finite number in every row")
                .found(format!("{} in row {} (from 1)", numbers[slot], self.count + 1))
                .into());
        }
        self.at += 1;
        self.count += 1;
        Ok(Some(numbers))
    }

    /// Reads some rows; false where there are no more.
    fn refill(&mut self) -> Result<bool, Error> {
        while self.left == 0 {
            if self.group == self.file.num_row_groups() {
                return Ok(false);
            }
            let failed = |e: ParquetError| damaged(&self.path, &e);
            let group = self.file.get_row_group(self.group).map_err(failed)?;
            self.left = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
            let column = |(_, column): &(usize, usize)| group.get_column_reader(*column).map_err(failed);
            self.columns = self.wanted.iter().map(column).collect::<Result<_, _>>()?;
            self.group += 1;
        }
        let rows = self.left.min(BLOCK);
        (self.at, self.left) = (0, self.left - rows);
        self.numbers.clear();
        self.numbers.resize(rows, [0.0; SLOTS]);
        for (k, (slot, _)) in self.wanted.iter().enumerate() {
            let mut set = |row: usize, x: f64| self.numbers[row][*slot] = x;
            let found = match &mut self.columns[k] {
                ColumnReader::DoubleColumnReader(column) => take(column, rows, |x| *x, &mut set),
                ColumnReader::FloatColumnReader(column) => take(column, rows, |x| f64::from(*x), &mut set),
                ColumnReader::Int64ColumnReader(column) => take(column, rows, |x| *x as f64, &mut set),
                ColumnReader::Int32ColumnReader(column) => take(column, rows, |x| f64::from(*x), &mut set),
                _ => {
                    return Err(self
                        .fault(*slot, "a column that holds no numbers")
                        .expected("numbers of type double, float, int64 or int32")
                        .into());
                }
            };
            let whole = found.map_err(|e| damaged(&self.path, &e))?;
            if !whole {
                return Err(self
                    .fault(*slot, "an empty cell")
                    .expected("a number in every row")
                    .found(format!("one or more in rows {} to {}", self.count + 1, self.count + rows as u64))
                    .into());
            }
        }
        Ok(true)
    }

    /// A fault in the column that goes into `slot`.
    pub fn fault(&self, slot: usize, problem: &str) -> Diagnostic {
        Diagnostic::new(&self.path, problem).path(self.names[slot.min(TIME)].clone())
    }

    /// Where the number of the row just delivered stands.
    pub fn place(&self) -> String {
        format!("row {} (from 1)", self.count)
    }
}

/// Hands the next `rows` numbers of a column to `set`; false where a cell is empty.
fn take<T: DataType>(
    column: &mut ColumnReaderImpl<T>,
    rows: usize,
    number: impl Fn(&T::T) -> f64,
    set: &mut impl FnMut(usize, f64),
) -> Result<bool, ParquetError> {
    let (mut values, mut levels) = (Vec::with_capacity(rows), Vec::new());
    column.read_records(rows, Some(&mut levels), None, &mut values)?;
    values.iter().enumerate().for_each(|(row, x)| set(row, number(x)));
    Ok(values.len() == rows)
}

fn damaged(path: &Path, error: &ParquetError) -> Error {
    Diagnostic::new(path, "a Parquet file that cannot be read")
        .expected("a whole table, not compressed or by snappy")
        .found(error.to_string())
        .help("with pandas: `to_parquet(LOG)` writes one; `to_csv(LOG, index=False)` a text")
        .into()
}
