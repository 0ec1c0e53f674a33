//! A Parquet table says what the same text says; a wrong one says where and how.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::{
    basic::Compression,
    data_type::{DoubleType, Int32Type},
    file::{properties::WriterProperties, writer::SerializedFileWriter},
    schema::parser::parse_message_type,
};

use super::tests::spec;
use super::*;
use crate::Error;

const ROWS: usize = 20_000;

/// Time and six numbers of a row, from 1.
fn numbers(row: usize) -> [f64; 7] {
    let k = row as f64;
    [k / 100.0, 0.1 * k, 0.2, -0.3, (k % 7.0).trunc(), 5.0, -k]
}

/// A table of two groups of rows whose fifth column holds integers; with one cell empty, if wanted.
fn table(name: &str, empty: Option<usize>) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("schuler-parquet-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    let text = "message log { required double t; required double wx; optional double wy; required double wz; \
                required int32 fx; required double fy; required double fz; required binary note; }";
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let schema = Arc::new(parse_message_type(text).unwrap());
    let mut writer =
        SerializedFileWriter::new(File::create(&path).unwrap(), schema, Arc::new(properties)).unwrap();
    for group in [1..ROWS / 3, ROWS / 3..ROWS + 1] {
        let mut rows = writer.next_row_group().unwrap();
        for k in 0..8 {
            let mut column = rows.next_column().unwrap().unwrap();
            let values: Vec<f64> = group
                .clone()
                .filter(|row| k != 2 || Some(*row) != empty)
                .map(|row| numbers(row)[k.min(6)])
                .collect();
            let levels: Vec<i16> = group.clone().map(|row| i16::from(Some(row) != empty)).collect();
            match k {
                4 => {
                    let values: Vec<i32> = values.iter().map(|x| *x as i32).collect();
                    column.typed::<Int32Type>().write_batch(&values, None, None).unwrap();
                }
                7 => {
                    let notes = vec!["-".into(); values.len()];
                    column
                        .typed::<parquet::data_type::ByteArrayType>()
                        .write_batch(&notes, None, None)
                        .unwrap();
                }
                _ => {
                    let levels = (k == 2).then_some(&levels[..]);
                    column.typed::<DoubleType>().write_batch(&values, levels, None).unwrap();
                }
            }
            column.close().unwrap();
        }
        rows.close().unwrap();
    }
    writer.close().unwrap();
    path
}

fn named(names: [&str; 7]) -> LogSpec {
    let [t, triads @ ..] = names.map(|name| ColumnRef::Name(name.into()));
    let mut spec = spec();
    spec.columns = Columns {
        time: Some(TimeColumn { column: t, scale: 1.0, week: false }),
        gyro: triads[..3].to_vec(),
        accel: triads[3..].to_vec(),
    };
    spec
}

const NAMES: [&str; 7] = ["t", "wx", "wy", "wz", "fx", "fy", "fz"];

fn read(spec: &LogSpec, path: &Path) -> Result<Vec<LogSample>, Error> {
    LogReader::open(spec, path)?.collect()
}

#[test]
fn a_table_is_the_same_log_as_the_text() {
    let path = table("whole.parquet", None);
    let text: String = (1..=ROWS).map(|row| numbers(row).map(|x| x.to_string()).join(",") + "\n").collect();
    let csv = path.with_extension("csv");
    std::fs::write(&csv, NAMES.join(",") + "\n" + &text).unwrap();
    let (table, text) = (read(&named(NAMES), &path).unwrap(), read(&named(NAMES), &csv).unwrap());
    assert_eq!(table.len(), ROWS);
    assert_eq!(table, text);
    assert_eq!(titles(&path).unwrap()[..7], NAMES.map(String::from));
}

#[test]
fn faults_say_what_and_where() {
    let whole = table("faults.parquet", None);
    let complaint = |spec: &LogSpec, path: &Path| read(spec, path).unwrap_err().to_string();
    let hole = complaint(&named(NAMES), &table("hole.parquet", Some(12_345)));
    assert!(hole.contains("hole.parquet: wy: an empty cell\n"), "{hole}");
    let absent = complaint(&named(["t", "wx", "wy", "wz", "fx", "fy", "gz"]), &whole);
    assert!(absent.contains("gz: the log has no such column\n"), "{absent}");
    let words = complaint(&named(["t", "wx", "wy", "wz", "fx", "fy", "note"]), &whole);
    assert!(words.contains("note: a column that holds no numbers\n"), "{words}");
    let bytes = std::fs::read(&whole).unwrap();
    let cut = whole.with_file_name("cut.parquet");
    std::fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    let found = complaint(&named(NAMES), &cut);
    assert!(found.contains("cut.parquet: a Parquet file that cannot be read\n"), "{found}");
}
