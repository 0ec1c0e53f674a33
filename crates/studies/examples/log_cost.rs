//! What reading a log costs beside the Allan deviation of it: the same numbers as text, gzipped text and npy.
//!
//! `cargo run --release -p schuler-studies --example log_cost`
use std::fmt::Write as _;
use std::hint::black_box;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

use flate2::{Compression, write::GzEncoder};
use schuler_allan::Pyramid;
use schuler_studies::log::{AxisMap, ColumnRef, Columns, Content, LogReader, LogSpec, Scale};

const ROWS: usize = 500_000;
const AXES: usize = 6;
const REPEATS: usize = 3;

type Done = Result<(), Box<dyn std::error::Error>>;

fn main() -> Done {
    let folder = std::env::temp_dir().join(format!("schuler-log-cost-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let done = measure(&folder);
    std::fs::remove_dir_all(&folder)?;
    done
}

fn measure(folder: &Path) -> Done {
    let numbers = numbers();
    let seconds = best(|| pyramid(&numbers));
    let pyramid = 1e9 * seconds / numbers.len() as f64;
    println!("{ROWS} rows of {AXES} numbers; the pyramid of all octaves takes {pyramid:.2} ns a number\n");
    println!("| log | bytes a number | ns a number | times the pyramid |\n|---|---|---|---|");
    let counts: Vec<f64> = numbers.iter().map(|x| (x * 1e3).round()).collect();
    let full = text(&numbers, |x| format!("{x:e}"));
    for (name, bytes) in [
        ("csv, 16 digits", full.clone()),
        ("csv.gz, 16 digits", gzip(&full)?),
        ("csv, whole counts", text(&counts, |x| format!("{x}"))),
        ("csv.gz, whole counts", gzip(&text(&counts, |x| format!("{x}")))?),
        ("npy, float64", npy("<f8", numbers.iter().flat_map(|x| x.to_le_bytes()))),
        ("npy, float32", npy("<f4", numbers.iter().flat_map(|x| (*x as f32).to_le_bytes()))),
        ("npy, int32", npy("<i4", counts.iter().flat_map(|x| (*x as i32).to_le_bytes()))),
    ] {
        let file = folder.join("log");
        std::fs::write(&file, &bytes)?;
        let ns = 1e9 * best(|| read(&file)) / numbers.len() as f64;
        let size = bytes.len() as f64 / numbers.len() as f64;
        println!("| {name} | {size:.1} | {ns:.1} | {:.1} |", ns / pyramid);
    }
    Ok(())
}

/// Uniform between -1 and 1, with all digits.
fn numbers() -> Vec<f64> {
    let mut n: u64 = 1_234_567_890;
    (0..ROWS * AXES)
        .map(|_| {
            n = n * 16807 % 2_147_483_647;
            2.0 * n as f64 / 2_147_483_647.0 - 1.0
        })
        .collect()
}

fn best(mut work: impl FnMut() -> Done) -> f64 {
    let time = |_| {
        let start = Instant::now();
        work().expect("invariant: the log was written as it is read");
        start.elapsed().as_secs_f64()
    };
    (0..REPEATS).map(time).fold(f64::INFINITY, f64::min)
}

fn pyramid(numbers: &[f64]) -> Done {
    let mut pyramid = Pyramid::new(0.01)?;
    for block in numbers.chunks(4096) {
        pyramid.push(black_box(block))?;
    }
    black_box(pyramid.curve()?);
    Ok(())
}

fn read(file: &Path) -> Done {
    let spec = LogSpec {
        file: String::new(),
        source: String::new(),
        rate: 100.0,
        content: Content::Increments,
        columns: Columns {
            time: None,
            gyro: [1, 2, 3].map(ColumnRef::Number).to_vec(),
            accel: [4, 5, 6].map(ColumnRef::Number).to_vec(),
        },
        scale: Scale { gyro: [1.0; 3], accel: [1.0; 3] },
        axes: AxisMap::IDENTITY,
        stationary: false,
    };
    let mut count = 0;
    for sample in LogReader::open(&spec, file)? {
        black_box(sample?);
        count += 1;
    }
    if count == ROWS { Ok(()) } else { Err(format!("{count} rows").into()) }
}

fn text(numbers: &[f64], show: impl Fn(f64) -> String) -> Vec<u8> {
    let mut text = String::new();
    for row in numbers.as_chunks::<AXES>().0 {
        let _ = writeln!(text, "{}", row.map(&show).join(","));
    }
    text.into_bytes()
}

fn gzip(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes)?;
    encoder.finish()
}

fn npy(descr: &str, body: impl Iterator<Item = u8>) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({ROWS}, {AXES}), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(body);
    bytes
}
