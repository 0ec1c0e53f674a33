//! Errors of runs as Parquet: `run`, `t_s` and the nine errors at each row, run by run.

use std::{
    fs::File,
    io,
    path::{Path, PathBuf},
    sync::Arc,
};

use parquet::{
    basic::Compression,
    column::reader::ColumnReader,
    data_type::{DoubleType, Int64Type},
    errors::ParquetError,
    file::{
        metadata::KeyValue,
        properties::WriterProperties,
        reader::{FileReader, SerializedFileReader},
        writer::SerializedFileWriter,
    },
    schema::parser::parse_message_type,
};

use super::runs::Chunk;
use crate::{Error, record::columns};

/// Key of the digest in the file's own metadata.
const DIGEST: &str = "schuler.digest";
/// Rows that are gathered into a group.
const GROUP: usize = 1 << 16;

/// Digest of the errors of runs, in the order of their numbers: BLAKE3 over the number of each run and its errors row by row, as
/// 64 bits each, the lowest byte first. It says nothing of how the runs were made or kept.
#[derive(Clone, Default)]
pub struct Digest(blake3::Hasher);

impl Digest {
    /// One run more.
    pub fn add(&mut self, run: u64, errors: &[[f64; 9]]) {
        let mut bytes = Vec::with_capacity(8 + 72 * errors.len());
        bytes.extend(run.to_le_bytes());
        errors.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        self.0.update(&bytes);
    }

    /// All runs of a chunk.
    pub fn add_chunk(&mut self, chunk: &Chunk, rows: usize) {
        for (run, errors) in (chunk.first..).zip(chunk.runs(rows)) {
            self.add(run, errors);
        }
    }

    /// So far, hexadecimal.
    pub fn hex(&self) -> String {
        self.0.finalize().to_hex().to_string()
    }
}

/// Writes chunk after chunk into a new file.
pub struct Writer {
    path: PathBuf,
    inner: SerializedFileWriter<File>,
    times: Vec<f64>,
    pending: Option<Chunk>,
    digest: Digest,
}

impl Writer {
    /// A file of runs with rows at `times` (s).
    pub fn create(path: &Path, times: &[f64]) -> Result<Writer, Error> {
        let text: String =
            columns::MONTE_CARLO[3..12].iter().map(|name| format!("required double {name}; ")).collect();
        let schema =
            parse_message_type(&format!("message runs {{ required int64 run; required double t_s; {text}}}"));
        let schema = Arc::new(schema.expect("invariant: names of columns are words"));
        // Random numbers have no repetitions to keep in a dictionary.
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_dictionary_enabled(false)
            .set_created_by(concat!("schuler ", env!("CARGO_PKG_VERSION")).into());
        let file = File::create(path).map_err(|source| Error::Write { path: path.into(), source })?;
        let inner = SerializedFileWriter::new(file, schema, Arc::new(properties.build()))
            .map_err(|e| Error::Write { path: path.into(), source: system(e) })?;
        let times = times.to_vec();
        Ok(Writer { path: path.into(), inner, times, pending: None, digest: Digest::default() })
    }

    /// Takes the next runs.
    pub fn add(&mut self, chunk: &Chunk) -> Result<(), Error> {
        self.digest.add_chunk(chunk, self.times.len());
        match &mut self.pending {
            None => self.pending = Some(chunk.clone()),
            Some(pending) => pending.errors.extend_from_slice(&chunk.errors),
        }
        if self.pending.as_ref().is_some_and(|pending| pending.errors.len() >= GROUP) {
            self.flush()?;
        }
        Ok(())
    }

    /// Makes the file whole and waits until it is on the disk; gives the digest of what is in it.
    pub fn finish(mut self) -> Result<String, Error> {
        self.flush()?;
        let digest = self.digest.hex();
        self.inner.append_key_value_metadata(KeyValue::new(DIGEST.into(), digest.clone()));
        let path = self.path;
        let failed = |source| Error::Write { path, source };
        match self.inner.into_inner().map_err(system).and_then(|file| file.sync_all()) {
            Ok(()) => Ok(digest),
            Err(source) => Err(failed(source)),
        }
    }

    fn flush(&mut self) -> Result<(), Error> {
        let Some(chunk) = self.pending.take() else { return Ok(()) };
        write_group(&mut self.inner, &chunk, &self.times)
            .map_err(|e| Error::Write { path: self.path.clone(), source: system(e) })
    }
}

fn write_group(
    file: &mut SerializedFileWriter<File>,
    chunk: &Chunk,
    times: &[f64],
) -> Result<(), ParquetError> {
    let mut group = file.next_row_group()?;
    let mut next = 0;
    while let Some(mut column) = group.next_column()? {
        match next {
            0 => {
                let run = |k: usize| (chunk.first + (k / times.len()) as u64) as i64;
                let values: Vec<i64> = (0..chunk.errors.len()).map(run).collect();
                column.typed::<Int64Type>().write_batch(&values, None, None)?;
            }
            _ => {
                let value = |k: usize| match next {
                    1 => times[k % times.len()],
                    _ => chunk.errors[k][next - 2],
                };
                let values: Vec<f64> = (0..chunk.errors.len()).map(value).collect();
                column.typed::<DoubleType>().write_batch(&values, None, None)?;
            }
        }
        column.close()?;
        next += 1;
    }
    group.close().map(drop)
}

/// What the system said, where it was the system.
fn system(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

/// Reads chunk after chunk of a file.
pub struct Reader {
    file: SerializedFileReader<File>,
    rows: usize,
    next: usize,
}

impl Reader {
    /// A file of runs with `rows` rows each; what is wrong with it, if it is none.
    pub fn open(path: &Path, rows: usize) -> Result<Reader, String> {
        let file = File::open(path).map_err(|e| e.to_string())?;
        let file = SerializedFileReader::new(file).map_err(|e| e.to_string())?;
        Ok(Reader { file, rows, next: 0 })
    }

    /// The digest that stands in the file.
    pub fn digest(&self) -> Option<String> {
        let pairs = self.file.metadata().file_metadata().key_value_metadata()?;
        pairs.iter().find(|pair| pair.key == DIGEST)?.value.clone()
    }

    fn chunk(&self, group: usize) -> Result<Chunk, String> {
        let text = |e: ParquetError| e.to_string();
        let group = self.file.get_row_group(group).map_err(text)?;
        let n = group.metadata().num_rows() as usize;
        let other = || "columns of another table".to_string();
        if group.metadata().num_columns() != 11 || n == 0 || !n.is_multiple_of(self.rows) {
            return Err(other());
        }
        let mut numbers = Vec::with_capacity(n);
        match group.get_column_reader(0).map_err(text)? {
            ColumnReader::Int64ColumnReader(mut column) => {
                column.read_records(n, None, None, &mut numbers).map_err(text)?;
            }
            _ => return Err(other()),
        }
        let mut errors = vec![[0.0; 9]; n];
        for k in 0..9 {
            let mut values = Vec::with_capacity(n);
            match group.get_column_reader(2 + k).map_err(text)? {
                ColumnReader::DoubleColumnReader(mut column) => {
                    column.read_records(n, None, None, &mut values).map_err(text)?;
                }
                _ => return Err(other()),
            }
            if values.len() != n {
                return Err("rows are missing".into());
            }
            errors.iter_mut().zip(values).for_each(|(row, x)| row[k] = x);
        }
        let first = numbers.first().copied().unwrap_or(-1);
        let in_order = |(k, &number): (usize, &i64)| number == first + (k / self.rows) as i64;
        if first < 0 || numbers.len() != n || !numbers.iter().enumerate().all(in_order) {
            return Err("runs are not in their order".into());
        }
        Ok(Chunk { first: first as u64, errors })
    }
}

impl Iterator for Reader {
    type Item = Result<Chunk, String>;

    fn next(&mut self) -> Option<Self::Item> {
        (self.next < self.file.num_row_groups()).then(|| {
            self.next += 1;
            self.chunk(self.next - 1)
        })
    }
}
