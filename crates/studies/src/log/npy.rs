//! A log as a NumPy array of shape (rows, columns), or of records whose fields are the columns.

use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

use super::fault;
use super::npy_header::{self, Field, Kind};
use super::slots::{SLOTS, TIME, Wanted, names, settle};
use crate::{Diagnostic, Error};

/// First byte of an npy file; no text begins with it.
pub(super) const FIRST: u8 = b'\x93';

/// Bytes that are read at a time, about.
const BLOCK: usize = 1 << 16;

/// Rows of an array, in counts.
pub(super) struct NpyRows {
    file: PathBuf,
    bytes: Box<dyn BufRead + Send>,
    /// Bytes before the first row.
    start: u64,
    /// Bytes a row, and rows that the header promises.
    width: usize,
    rows: u64,
    /// What is read of a row, in the order of the slots.
    fields: Vec<(usize, Field)>,
    names: [String; SLOTS],
    /// The names of all columns.
    pub titles: Vec<String>,
    /// Some rows as they stand, their numbers, and how many of these are delivered.
    block: Vec<u8>,
    numbers: Vec<[f64; SLOTS]>,
    at: usize,
    /// Rows delivered so far.
    count: u64,
}

impl NpyRows {
    /// Reads the header, and finds the columns by number or by the names of record fields.
    pub fn new(
        file: &Path,
        mut bytes: Box<dyn BufRead + Send>,
        wanted: &[Wanted<'_>],
    ) -> Result<Self, Error> {
        let header = npy_header::read(file, &mut bytes)?;
        let titles: Vec<String> = header.fields.iter().map(|field| field.name.clone()).collect();
        let slots = settle(file, wanted, &titles)?;
        let mut fields: Vec<(usize, Field)> =
            slots.into_iter().zip(header.fields).filter_map(|(slot, field)| Some((slot?, field))).collect();
        fields.sort_by_key(|(slot, _)| *slot);
        Ok(NpyRows {
            file: file.into(),
            bytes,
            start: header.start,
            width: header.width,
            rows: header.rows,
            fields,
            names: names(wanted),
            titles,
            block: Vec::new(),
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
        // A sum is finite where all of its parts are; where they are huge, a closer look decides.
        if !numbers.iter().sum::<f64>().is_finite() && !numbers.iter().all(|x| x.is_finite()) {
            return Err(self.not_finite(&numbers));
        }
        self.at += 1;
        self.count += 1;
        Ok(Some(numbers))
    }

    /// Reads rows into the block; false where there are no more.
    fn refill(&mut self) -> Result<bool, Error> {
        let rest = self.rows - self.count;
        let rows = rest.min((BLOCK / self.width).max(1) as u64);
        let size = rows as usize * self.width;
        self.at = 0;
        self.block.clear();
        self.numbers.clear();
        // One byte more than there should be tells an array that ends from one that goes on.
        let limit = size as u64 + u64::from(rows == rest);
        let taken = self.bytes.by_ref().take(limit).read_to_end(&mut self.block);
        let taken = taken.map_err(|e| fault::reading(&self.file, self.count, e))?;
        if taken == size {
            self.numbers.resize(rows as usize, [0.0; SLOTS]);
            for (slot, field) in &self.fields {
                field.column(&self.block, self.width, *slot, &mut self.numbers);
            }
            return Ok(size > 0);
        }
        let whole = self.count + (taken / self.width) as u64;
        let problem = if taken < size { "the array is cut off" } else { "the array goes on behind its end" };
        Err(Diagnostic::new(&self.file, problem)
            .expected(format!("{} rows of {} bytes, as the header says", self.rows, self.width))
            .found(match taken < size {
                true => format!("{whole} rows, the end at byte {}", self.byte(0) + taken as u64),
                false => format!("more at byte {}", self.byte(0) + size as u64),
            })
            .help("the file is not whole, or more than one array was saved into it")
            .into())
    }

    #[cold]
    fn not_finite(&self, numbers: &[f64; SLOTS]) -> Error {
        let slot = numbers.iter().position(|value| !value.is_finite()).unwrap_or(TIME);
        self.fault(slot, "a number that is not finite")
            .expected("a finite number in every row")
            .found(format!("{} in {}", numbers[slot], self.at_place(slot, self.count)))
            .into()
    }

    /// A fault in the column that goes into `slot`.
    pub fn fault(&self, slot: usize, problem: &str) -> Diagnostic {
        Diagnostic::new(&self.file, problem).path(self.names[slot].clone())
    }

    /// Where the number of the row just delivered stands.
    pub fn place(&self, slot: usize) -> String {
        self.at_place(slot, self.count.saturating_sub(1))
    }

    fn at_place(&self, slot: usize, row: u64) -> String {
        let offset = self.fields.iter().find(|(s, _)| *s == slot).map_or(0, |(_, field)| field.offset);
        let byte = self.start + row * self.width as u64 + offset as u64;
        format!("row {} (from 1), at byte {byte}", row + 1)
    }

    fn byte(&self, offset: u64) -> u64 {
        self.start + self.count * self.width as u64 + offset
    }
}

impl Field {
    /// Takes the numbers of this column from rows of `width` bytes into `slot`.
    fn column(&self, block: &[u8], width: usize, slot: usize, numbers: &mut [[f64; SLOTS]]) {
        match self.kind {
            Kind::F8 => self.each(block, width, slot, numbers, f64::from_le_bytes),
            Kind::F4 => self.each(block, width, slot, numbers, |b| f64::from(f32::from_le_bytes(b))),
            Kind::I8 => self.each(block, width, slot, numbers, |b| i64::from_le_bytes(b) as f64),
            Kind::I4 => self.each(block, width, slot, numbers, |b| f64::from(i32::from_le_bytes(b))),
            Kind::I2 => self.each(block, width, slot, numbers, |b| f64::from(i16::from_le_bytes(b))),
        }
    }

    #[inline]
    fn each<const N: usize>(
        &self,
        block: &[u8],
        width: usize,
        slot: usize,
        numbers: &mut [[f64; SLOTS]],
        number: impl Fn([u8; N]) -> f64,
    ) {
        for (row, numbers) in block.chunks_exact(width).zip(numbers) {
            let bytes = row[self.offset..].first_chunk().expect("invariant: a field lies within its row");
            numbers[slot] = number(*bytes);
        }
    }
}
