//! Logs that are right give what they say; logs that are wrong say where and how.

use std::io::{Cursor, Write};
use std::path::Path;

use flate2::{Compression, write::GzEncoder};

use super::*;
use crate::Error;

const HEADER: &str = "t,gx,gy,gz,ax,ay,az\n";

fn name(text: &str) -> ColumnRef {
    ColumnRef::Name(text.into())
}

/// Right-front-up axes, 100 Hz, unit scales.
pub(super) fn spec() -> LogSpec {
    LogSpec {
        file: "log.csv".into(),
        source: "the archive of the institute".into(),
        rate: 100.0,
        content: Content::Increments,
        columns: Columns {
            time: Some(TimeColumn { column: name("t"), scale: 1.0, week: false }),
            gyro: ["gx", "gy", "gz"].map(name).to_vec(),
            accel: ["ax", "ay", "az"].map(name).to_vec(),
        },
        scale: Scale { gyro: [1.0; 3], accel: [1.0; 3] },
        axes: AxisMap::parse(["y", "x", "-z"]).unwrap(),
        stationary: true,
    }
}

fn read(spec: &LogSpec, text: impl AsRef<[u8]>) -> Result<Vec<LogSample>, Error> {
    LogReader::from_bytes(spec, Path::new("log.csv"), Cursor::new(text.as_ref().to_vec()))?.collect()
}

fn complaint(spec: &LogSpec, text: impl AsRef<[u8]>) -> String {
    read(spec, text).unwrap_err().to_string()
}

fn rows(n: usize) -> String {
    let row = |k: usize| format!("{},1,2,3,4,5,6\n", k as f64 / 100.0);
    HEADER.to_string() + &(1..=n).map(row).collect::<String>()
}

fn gz(text: &str) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(text.as_bytes()).unwrap();
    encoder.finish().unwrap()
}

#[test]
fn counts_become_increments_along_body_axes() {
    let mut spec = spec();
    // 0.1 arcsec and 125e-6 · 9.780327 m/s, as the ring-laser log has it.
    let arcsec = std::f64::consts::PI / 648_000.0;
    spec.scale = Scale { gyro: [0.1 * arcsec; 3], accel: [1.222540875e-3; 3] };
    let [sample] = read(&spec, "t,gx,gy,gz,ax,ay,az\n0.01,10,-20,30,1,2,80\n").unwrap()[..] else { panic!() };
    let dtheta = sample.increments.dtheta.as_array().map(|x| x / arcsec);
    for (found, expected) in dtheta.iter().zip([-2.0, 1.0, -3.0]) {
        assert!((found - expected).abs() < 1e-14, "{dtheta:?}");
    }
    assert_eq!(
        sample.increments.dv.as_array(),
        [2.0 * 1.222540875e-3, 1.222540875e-3, -80.0 * 1.222540875e-3]
    );
    assert_eq!(sample.t, 0.01);
}

#[test]
fn rates_become_increments() {
    let mut spec = spec();
    spec.content = Content::Rates;
    spec.axes = AxisMap::IDENTITY;
    let samples = read(&spec, rows(3)).unwrap();
    assert_eq!(samples[2].increments.dtheta.as_array(), [0.01, 0.02, 0.03]);
    assert_eq!(samples[2].increments.dv.as_array(), [0.04, 0.05, 0.06]);
}

#[test]
fn rows_without_time_end_at_multiples_of_the_interval() {
    let mut spec = spec();
    spec.columns.time = None;
    let samples = read(&spec, "gx,gy,gz,ax,ay,az\n0,0,0,0,0,1\n0,0,0,0,0,1\n").unwrap();
    assert_eq!(samples.iter().map(|s| s.t).collect::<Vec<_>>(), [0.01, 0.02]);
}

#[test]
fn the_look_of_the_file_does_not_matter() {
    let plain = read(&spec(), rows(3)).unwrap();
    let variants = [
        rows(3).replace('\n', "\r\n"),
        format!("\u{feff}{}", rows(3)),
        rows(3).replace(',', ";"),
        rows(3).replace(',', "\t"),
        rows(3).replace(',', " , "),
        rows(3).replace(",1,", ",1.0e0,").replace(",2,", ",+2,"),
        rows(3).replace('\n', "\n\n# a remark\n"),
        rows(3).trim_end().to_string(),
        rows(3).replace("gx", "\"gx\""),
    ];
    for text in variants {
        assert_eq!(read(&spec(), &text).unwrap(), plain, "{text:?}");
    }
    assert_eq!(read(&spec(), gz(&rows(3))).unwrap(), plain);
    // Two gzip members, one after the other, are one text.
    let (head, tail) = (HEADER.to_string(), rows(3)[HEADER.len()..].to_string());
    assert_eq!(read(&spec(), [gz(&head), gz(&tail)].concat()).unwrap(), plain);
}

#[test]
fn columns_by_number_need_no_header() {
    let mut spec = spec();
    spec.columns.time = None;
    spec.columns.gyro = [2, 3, 4].map(ColumnRef::Number).to_vec();
    spec.columns.accel = [5, 6, 7].map(ColumnRef::Number).to_vec();
    let body = rows(4)[HEADER.len()..].to_string();
    let samples = read(&spec, &body).unwrap();
    assert_eq!(samples.len(), 4);
    assert_eq!(read(&spec, rows(4)).unwrap(), samples);
    spec.columns.accel[2] = ColumnRef::Number(8);
    assert!(complaint(&spec, &body).contains("column 8: the log has no such column"));
    spec.columns.accel[2] = ColumnRef::Number(0);
    assert!(complaint(&spec, &body).contains("column 0: the log has no such column"));
}

#[test]
fn a_wrong_row_is_named_with_line_and_column() {
    let with = |row: &str| complaint(&spec(), rows(2) + row + "\n");
    let message = with("0.03,1,2,x,4,5,6");
    assert!(message.starts_with("log.csv:4:10: gz: text where a number belongs"), "{message}");
    assert!(message.contains("found: `x`"), "{message}");
    for (row, start) in [
        (
            "0.03,1,2,3,4,5",
            "log.csv:4: a short row\n  expected: 7 fields, as in the first row\n  found: 6 fields",
        ),
        ("0.03,1,2,3,4,5,6,7", "log.csv:4: a long row"),
        ("0.03,1,2,3", "log.csv:4: a short row"),
        ("0.03,1,2,3,4,,6", "log.csv:4:14: ay: an empty field where a number belongs"),
        ("0.03,1,2,3,4,NaN,6", "log.csv:4:14: ay: a number that is not finite"),
        ("0.03,1,2,3,4,inf,6", "log.csv:4:14: ay: a number that is not finite"),
        ("0.03,1,2,3,4,1e999,6", "log.csv:4:14: ay: a number that is not finite"),
        ("0.01,1,2,3,4,5,6", "log.csv:4:1: t: time goes backwards"),
        ("0.02,1,2,3,4,5,6", "log.csv:4:1: t: the same time twice"),
        ("0.04,1,2,3,4,5,6", "log.csv:4:1: t: a gap in time"),
        ("0.024,1,2,3,4,5,6", "log.csv:4:1: t: an interval that is too short"),
    ] {
        let message = with(row);
        assert!(message.starts_with(start), "{message}\n{start}");
    }
}

#[test]
fn bytes_that_are_no_text_are_named() {
    let mut text = rows(1).into_bytes();
    text.extend(b"0.02,1,2,\xff\xfe,4,5,6\n");
    let message = complaint(&spec(), text);
    assert!(
        message.starts_with("log.csv:3:10: gz: bytes that are no text where a number belongs"),
        "{message}"
    );
    let message = complaint(&spec(), [0_u8; 200_000]);
    assert!(message.contains("is this a text file?"), "{message}");
}

#[test]
fn a_missing_column_is_named_beside_those_there() {
    let message = complaint(&spec(), rows(2).replace("az", "acc_z"));
    assert!(message.starts_with("log.csv:1: az: the log has no such column"), "{message}");
    assert!(message.contains("found: 7 columns: `t`, `gx`, `gy`, `gz`, `ax`, `ay`, `acc_z`"), "{message}");
}

#[test]
fn a_rate_that_the_time_column_contradicts_is_named() {
    let mut spec = spec();
    spec.rate = 99.0;
    let message = complaint(&spec, rows(1000));
    assert!(message.contains("t: rows do not come at the rate stated"), "{message}");
    assert!(message.contains("100"), "{message}");
    // Time stamps rounded to a millisecond, and a clock that is 100 ppm fast, are no fault.
    spec.rate = 300.0;
    let stamp = |k: usize| format!("{:.3},1,2,3,4,5,6\n", k as f64 * 1.0001 / 300.0);
    let text = HEADER.to_string() + &(1..=5000).map(stamp).collect::<String>();
    assert_eq!(read(&spec, text).unwrap().len(), 5000);
}

#[test]
fn a_file_that_is_not_whole_is_named() {
    assert_eq!(complaint(&spec(), ""), "log.csv: the log is empty");
    assert_eq!(complaint(&spec(), gz("")), "log.csv: the log is empty");
    assert_eq!(complaint(&spec(), HEADER), "log.csv: the log has a header and no rows");
    let whole = gz(&rows(5000));
    let message = complaint(&spec(), &whole[..whole.len() / 2]);
    assert!(message.starts_with("log.csv: the gzip stream is cut off after "), "{message}");
    let message = complaint(&spec(), &whole[..5]);
    assert!(message.starts_with("log.csv: the gzip stream is cut off before the first row"), "{message}");
    let mut damaged = whole.clone();
    let last = damaged.len() - 6;
    damaged[last] ^= 0x55;
    let message = complaint(&spec(), damaged);
    assert!(message.starts_with("log.csv: the gzip stream is damaged after "), "{message}");
}

#[test]
fn reading_ends_with_the_first_error() {
    let text = rows(1) + "0.02,1,2,x,4,5,6\n0.03,1,2,3,4,5,6\n";
    let mut reader = LogReader::from_bytes(&spec(), Path::new("log.csv"), Cursor::new(text)).unwrap();
    assert!(reader.next().unwrap().is_ok());
    assert!(reader.next().unwrap().is_err());
    assert!(reader.next().is_none());
}

#[test]
fn a_log_that_is_absent_says_where_it_comes_from() {
    let message =
        find(&spec(), Some(Path::new("/data")), Path::new("configs/a.yaml")).unwrap_err().to_string();
    assert!(message.starts_with("configs/a.yaml: log.file: the log log.csv is not there"), "{message}");
    assert!(message.contains("/data/log.csv, configs/log.csv"), "{message}");
    assert!(message.contains("where it comes from: the archive of the institute"), "{message}");
    assert!(message.contains("--data DIR") && message.contains("SCHULER_DATA"), "{message}");
}

#[test]
fn axes_must_be_a_proper_rotation() {
    let complaint = |words: [&str; 3]| AxisMap::parse(words).unwrap_err().to_string();
    assert_eq!(
        complaint(["y", "x", "z"]),
        "[y, x, z] is left-handed (determinant -1): a sign or the order of two axes is wrong"
    );
    assert_eq!(complaint(["x", "y", "y"]), "sensor axis `y` is named twice: each of x, y, z stands once");
    assert_eq!(complaint(["x", "y", "up"]), "`up` is no axis: expected `x`, `y`, `z`, `-x`, `-y` or `-z`");
    // Of the 48 signed permutations half are rotations, and each of those keeps vector products.
    const WORDS: [&str; 6] = ["x", "y", "z", "-x", "-y", "-z"];
    let all = (0..216).map(|k| [WORDS[k / 36], WORDS[k / 6 % 6], WORDS[k % 6]]);
    let maps: Vec<AxisMap> = all.filter_map(|words| AxisMap::parse(words).ok()).collect();
    assert_eq!(maps.len(), 24);
    for map in maps {
        let (a, b, c) = ([1.0, 2.0, 3.0], [-2.0, 5.0, 7.0], [-1.0, -13.0, 9.0]);
        // c = a × b
        assert_eq!(map.to_body(a).cross(map.to_body(b)), map.to_body(c));
    }
}

/// A log in SI with its time in the last column; it is not part of the repository. 10 001 rows, 100 Hz, 100 s.
#[test]
fn the_mems_vehicle_log_is_read_whole() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let Some(data) = crate::recorded::folder(&root) else {
        crate::recorded::skipped("the_mems_vehicle_log_is_read_whole");
        return;
    };
    let mut spec = spec();
    spec.file = "psins/mems_vehicle_imu.csv.gz".into();
    spec.columns = Columns {
        time: Some(TimeColumn { column: name("t_s"), scale: 1.0, week: false }),
        gyro: ["dthx_rad", "dthy_rad", "dthz_rad"].map(name).to_vec(),
        accel: ["dvx_mps", "dvy_mps", "dvz_mps"].map(name).to_vec(),
    };
    let file = find(&spec, Some(Path::new(&data)), Path::new("a.yaml")).unwrap();
    let samples: Vec<LogSample> = LogReader::open(&spec, &file).unwrap().collect::<Result<_, _>>().unwrap();
    assert_eq!((samples.len(), samples[0].t, samples[10_000].t), (10_001, 0.0, 100.0));
    // Its first row, with right-front-up turned to forward-right-down.
    assert_eq!(samples[0].increments.dv.as_array(), [-3.029662959e-03, -1.753637522e-03, -8.627579352e-02]);
}
