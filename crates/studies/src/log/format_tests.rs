//! Logs in formats with a name give what stands in them, and say where they are wrong. The files are those of
//! tests/data/log_formats; their numbers were written by hand.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use super::*;
use crate::scenario::{Scenario, Study};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/log_formats").join(name)
}

fn scenario(log: &str) -> Result<Scenario, crate::Error> {
    Scenario::load("a.yaml", &format!("schuler: 1\nstudy: allan\ntitle: A\nlog: {{ {log} }}\n"), &[])
}

fn spec(log: &str) -> LogSpec {
    match scenario(log).unwrap_or_else(|e| panic!("{e}")).study {
        Study::Allan(log) => log,
        _ => unreachable!(),
    }
}

fn read(spec: &LogSpec, name: &str) -> Vec<LogSample> {
    LogReader::open(spec, &file(name)).unwrap().collect::<Result<_, _>>().unwrap_or_else(|e| panic!("{e}"))
}

fn complaint(spec: &LogSpec, text: &str) -> String {
    let bytes = Cursor::new(text.as_bytes().to_vec());
    let reader = LogReader::from_bytes(spec, Path::new("log.txt"), bytes);
    reader.and_then(|rows| rows.collect::<Result<Vec<_>, _>>()).unwrap_err().to_string()
}

const KF_GINS: &str = "file: imu.txt, rate: 200 Hz, format: kf_gins";
const NOVATEL: &str = "file: rawimu.asc, rate: 200 Hz, format: novatel, scale: { gyro: 2 rad, accel: 3 m/s }";

/// Second, increments x, y, z of angle and velocity along forward, right, down; the third row begins a new week.
#[test]
fn text_of_kf_gins() {
    let rows = read(&spec(KF_GINS), "imu.txt");
    assert_eq!(rows.len(), 4);
    assert_eq!(rows[0].t, 604_799.990);
    assert_eq!(rows[0].increments.dtheta.as_array(), [1.0e-5, -2.0e-5, 3.0e-5]);
    assert_eq!(rows[0].increments.dv.as_array(), [1.0e-3, -2.0e-3, -4.9e-2]);
    assert_eq!(rows[3].t, 604_800.005);
    assert_eq!(rows[3].increments.dtheta.as_array(), [1.3e-5, -2.3e-5, 3.3e-5]);
}

/// Of a message 803, -20, 3, 5, 7, -9 the IMU has accelerometers (3, 20, 803) and gyros (-9, -7, 5) along right, front, up: along
/// forward, right, down (20, 3, -803) and (-7, -9, -5), times what a count is.
#[test]
fn messages_of_novatel() {
    let rows = read(&spec(NOVATEL), "rawimu.asc");
    assert_eq!(rows.len(), 6);
    for (k, row) in rows.iter().enumerate() {
        let n = k as f64;
        assert!((row.t - (604_799.985 + 0.005 * n)).abs() < 1e-9, "{k}");
        assert_eq!(row.increments.dv.as_array(), [20.0 + n, 3.0 + n, -803.0 - n].map(|x| 3.0 * x));
        assert_eq!(row.increments.dtheta.as_array(), [-7.0 - n, -9.0 - n, -5.0 - n].map(|x| 2.0 * x));
    }
    // Another mounting: sensor axes as they are.
    let plain = read(&spec(&format!("{NOVATEL}, axes: [x, y, z]")), "rawimu.asc");
    assert_eq!(plain[0].increments.dv.as_array(), [9.0, 60.0, 2409.0]);
}

#[test]
fn logs_beside_that_of_the_imu() {
    let numbers = |range: std::ops::RangeInclusive<usize>| range.map(ColumnRef::Number).collect::<Vec<_>>();
    let week = Layout { week: true, fields: Some(7) };
    let gnss = rows(&file("gnss.txt"), &numbers(1..=7), week).unwrap();
    assert_eq!(gnss[0], [604_799.0, 30.4447873701, 114.4718632047, 20.899, 0.005, 0.006, 0.011]);
    assert_eq!(gnss[1][0], 604_800.0);
    let short = rows(&file("gnss.txt"), &numbers(1..=7), Layout { fields: Some(11), ..week });
    let short = short.unwrap_err().to_string();
    assert!(short.contains("11 fields in a row") && short.contains("found: 7 fields"), "{short}");
    // Without the week, time goes back.
    let back = rows(&file("gnss.txt"), &numbers(1..=4), Layout::default()).unwrap_err().to_string();
    assert!(back.contains("gnss.txt:2:") && back.contains("times do not increase"), "{back}");
}

#[test]
fn faults_say_file_line_and_column() {
    let imu = spec(KF_GINS);
    for (text, words) in [
        ("1.0 1 2 3 4 5 6\n1.005 1 2 x 4 5 6\n", "log.txt:2:11: column 4: text where a number belongs"),
        ("1.0 1 2 3 4 5 6\n  1.005  1 2 3 4 5\n", "log.txt:2: a short row"),
        ("1.0 1 2 3 4 5 6\n1.005 1 2 3 4 5 6 7\n", "log.txt:2: a long row"),
        ("1.0 1 2 3 4 5 6\n1.1 1 2 3 4 5 6\n", "log.txt:2:1: column 1: a gap in time"),
        ("1.0 1 2 3 4 5\n", "log.txt:1: column 7: the log has no such column"),
    ] {
        let found = complaint(&imu, text);
        assert!(found.starts_with(words), "{words}\n{found}");
    }
    // Further columns and tabs are fine.
    for text in
        ["1.0 1 2 3 4 5 6 7\n1.005 1 2 3 4 5 6 8 \n", "1.0\t1\t2\t3\t4\t5\t6\n", "1.0, 1, 2, 3, 4, 5, 6\n"]
    {
        let rows = LogReader::from_bytes(&imu, Path::new("log.txt"), Cursor::new(text.as_bytes().to_vec()));
        let rows: Vec<_> = rows.unwrap().collect::<Result<_, _>>().unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(rows[0].increments.dv.as_array(), [4.0, 5.0, 6.0], "{text}");
    }
    let novatel = spec(NOVATEL);
    let text = std::fs::read_to_string(file("rawimu.asc")).unwrap();
    let damaged = complaint(&novatel, &text.replace(",804,", ",805,"));
    assert!(damaged.starts_with("log.txt:4:"), "{damaged}");
    assert!(damaged.contains("the message does not fit its checksum"), "{damaged}");
    // Without checksum a message is taken as it is, and its columns are those of the line.
    let wrong = complaint(&novatel, "%RAWIMUSA,1,2.0;1,2.0,0,803,-20,3,5,?,-9\n");
    assert!(wrong.starts_with("log.txt:1:37: column 8: text where a number belongs"), "{wrong}");
}

#[test]
fn scenarios_say_a_format_or_its_parts() {
    for (log, words) in [
        (
            "file: a, rate: 1 Hz, columns: { gyro: [1] }, scale: { gyro: 1 rad }",
            "the key `content` is missing",
        ),
        ("file: a, rate: 1 Hz, content: rates, scale: { gyro: 1 rad/s }", "the key `columns` is missing"),
        ("file: a, rate: 1 Hz, format: novatel", "what one count is, is not known"),
        ("file: a, rate: 1 Hz, format: kf_gins, scale: { gyro: 1 rad }", "the format says what `scale` is"),
        ("file: a, rate: 1 Hz, format: novatel, content: rates", "the format says what `content` is"),
        ("file: a, rate: 1 Hz, format: rinex", "expected: one of `kf_gins`, `novatel`"),
    ] {
        let found = scenario(log).map(drop).unwrap_err().to_string();
        assert!(found.contains(words), "{words}\n{found}");
    }
}
