//! Arrays that are right give what they say; arrays that are wrong say where and how.

use std::io::{Cursor, Write};
use std::path::Path;

use flate2::{Compression, write::GzEncoder};

use super::tests::spec;
use super::*;
use crate::Error;

/// A file as NumPy writes it: the header padded with blanks so that the numbers begin at a multiple of 64.
fn file(descr: &str, order: &str, shape: &str, body: &[u8]) -> Vec<u8> {
    let mut text = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}");
    while !(10 + text.len() + 1).is_multiple_of(64) {
        text.push(' ');
    }
    text.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.extend(body);
    bytes
}

/// Three rows of time (s) and six numbers.
fn body() -> Vec<f64> {
    (1..=3).flat_map(|k| [f64::from(k) / 100.0, 1.0, 2.0, 3.0, 4.0, 5.0, -f64::from(k)]).collect()
}

fn f8(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn by_number() -> LogSpec {
    let mut spec = spec();
    spec.columns = Columns {
        time: Some(TimeColumn { column: ColumnRef::Number(1), scale: 1.0, week: false }),
        gyro: [2, 3, 4].map(ColumnRef::Number).to_vec(),
        accel: [5, 6, 7].map(ColumnRef::Number).to_vec(),
    };
    spec
}

fn read(spec: &LogSpec, bytes: Vec<u8>) -> Result<Vec<LogSample>, Error> {
    LogReader::from_bytes(spec, Path::new("log.npy"), Cursor::new(bytes))?.collect()
}

fn complaint(spec: &LogSpec, bytes: Vec<u8>) -> String {
    read(spec, bytes).unwrap_err().to_string()
}

/// Whatever the type of the numbers, and with or without names, an array says what the same text says.
#[test]
fn an_array_is_the_same_log_as_the_text() {
    let text: String =
        body().as_chunks::<7>().0.iter().map(|row| row.map(|x| x.to_string()).join(",") + "\n").collect();
    let log = |bytes: Vec<u8>| LogReader::from_bytes(&by_number(), Path::new("log"), Cursor::new(bytes));
    let samples: Vec<_> = log(text.into_bytes()).unwrap().map(|s| s.unwrap()).collect();
    assert_eq!(samples.len(), 3);

    assert_eq!(read(&by_number(), file("'<f8'", "False", "(3, 7)", &f8(&body()))).unwrap(), samples);
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&file("'<f8'", "False", "(3, 7)", &f8(&body()))).unwrap();
    assert_eq!(read(&by_number(), encoder.finish().unwrap()).unwrap(), samples);

    // Records: time in whole milliseconds, the rest in types of their own.
    let record = |row: &[f64; 7]| {
        let mut bytes = ((row[0] * 1000.0).round() as i64).to_le_bytes().to_vec();
        bytes.extend((row[1] as f32).to_le_bytes());
        bytes.extend((row[2] as i32).to_le_bytes());
        bytes.extend((row[3] as i16).to_le_bytes());
        bytes.extend(f8(&row[4..]));
        bytes
    };
    let records: Vec<u8> = body().as_chunks::<7>().0.iter().flat_map(record).collect();
    let descr = "[('t', '<i8'), ('gx', '<f4'), ('gy', '<i4'), ('gz', '<i2'), ('ax', '<f8'), ('ay', '<f8'), ('az', '<f8')]";
    let mut by_name = spec();
    by_name.columns.time = Some(TimeColumn { column: ColumnRef::Name("t".into()), scale: 1e-3, week: false });
    assert_eq!(read(&by_name, file(descr, "False", "(3,)", &records)).unwrap(), samples);
}

#[test]
fn a_single_column_needs_no_second_dimension() {
    let mut spec = spec();
    spec.columns = Columns { time: None, gyro: vec![ColumnRef::Number(1)], accel: Vec::new() };
    spec.axes = AxisMap::IDENTITY;
    // One dimension has no order.
    let samples = read(&spec, file("'<f8'", "True", "(2,)", &f8(&[1.5, -2.0]))).unwrap();
    let dtheta: Vec<_> = samples.iter().map(|s| s.increments.dtheta.as_array()).collect();
    assert_eq!(dtheta, [[1.5, 0.0, 0.0], [-2.0, 0.0, 0.0]]);
}

/// More rows than are read at a time.
#[test]
fn a_long_array_is_read_whole() {
    let mut spec = spec();
    spec.columns =
        Columns { time: None, gyro: vec![ColumnRef::Number(1)], accel: vec![ColumnRef::Number(2)] };
    spec.axes = AxisMap::IDENTITY;
    let numbers: Vec<f64> = (0..60_000).map(f64::from).collect();
    let samples = read(&spec, file("'<f8'", "False", "(30000, 2)", &f8(&numbers))).unwrap();
    assert_eq!(samples.len(), 30_000);
    for (k, sample) in samples.iter().enumerate() {
        assert_eq!(sample.increments.dtheta.as_array()[0], 2.0 * k as f64);
        assert_eq!(sample.increments.dv.as_array()[0], 2.0 * k as f64 + 1.0);
    }
}

#[test]
fn a_wrong_number_is_named_with_row_and_byte() {
    let with = |index: usize, value: f64| {
        let mut numbers = body();
        numbers[index] = value;
        complaint(&by_number(), file("'<f8'", "False", "(3, 7)", &f8(&numbers)))
    };
    // The header takes 128 bytes, a row 56: the fourth number of row 2 stands at 128 + 56 + 24.
    assert_eq!(
        with(10, f64::NAN),
        "log.npy: column 4: a number that is not finite\n  expected: a finite number in every row\n  found: NaN in row 2 (from 1), at byte 208"
    );
    let message = with(7, 0.04);
    assert!(
        message.starts_with("log.npy: column 1: a gap in time\n  expected: a row every 0.01 s"),
        "{message}"
    );
    assert!(message.contains("in row 2 (from 1), at byte 184"), "{message}");
}

#[test]
fn an_array_that_is_no_log_is_named() {
    let whole = file("'<f8'", "False", "(3, 7)", &f8(&body()));
    let begins = |bytes: Vec<u8>, start: &str| {
        let message = complaint(&by_number(), bytes);
        assert!(message.starts_with(start), "{message}\n{start}");
    };
    begins(
        whole[..whole.len() - 1].to_vec(),
        "log.npy: the array is cut off\n  expected: 3 rows of 56 bytes, as the header says\n  found: 2 rows, the end at byte 295",
    );
    begins([&whole[..], b"x"].concat(), "log.npy: the array goes on behind its end");
    begins(whole[..50].to_vec(), "log.npy: the header of the array is cut off");
    begins(b"\x93NUMPI\x01\x00".to_vec(), "log.npy: neither text nor an npy file");
    begins(
        b"\x93NUMPY\x09\x00\x00\x00\x00\x00".to_vec(),
        "log.npy: an npy version or header that is not known",
    );
    let of = |descr: &str, order: &str, shape: &str, start: &str| {
        begins(file(descr, order, shape, &f8(&body())), &format!("log.npy: {start}"));
    };
    of("'>f8'", "False", "(3, 7)", "numbers of type `>f8`");
    of("'|O'", "False", "(3, 7)", "numbers of type `|O`");
    of("'<f8'", "True", "(3, 7)", "an array in Fortran order");
    of("'<f8'", "False", "(3, 7, 1)", "an array of 3 dimensions");
    of("'<f8'", "False", "()", "an array of 0 dimensions");
    of("'<f8'", "False", "(3, 0)", "an array of 0 columns");
    of("'<f8'", "False", "(3, 6)", "column 7: the log has no such column");
    of("'<f8'", "False", "(0, 7)", "the array goes on behind its end");
    of("[('a', '<f8', (7,))]", "False", "(3,)", "a record field that is no single number");
    of("[]", "False", "(3,)", "records without fields");
    of("((((((((((", "False", "(3,)", "the header of the array cannot be read");
    of("'<f8'", "False", "3", "the header of the array cannot be read");
    begins(file("'<f8'", "False", "(0, 7)", b""), "log.npy: the log has a header and no rows");
    let message = complaint(&spec(), whole);
    assert!(message.starts_with("log.npy: gx: the log has no such column"), "{message}");
    assert!(message.contains("found: 7 columns: without names"), "{message}");
}
