use std::fs;

use super::{Cell, Folder, Record, Table};
use crate::{
    Error, Scenario, figure,
    scenario::{Expect, Statistic},
};

const SCENARIO: &str = "\
schuler: 1
study: imu
title: A test
motion: zero_truth
duration: 1 s
imu: { rate: 4 Hz }
expect:
  - { quantity: omega_x_radps, at: mean, value: 2.5 rad/s, tolerance: 0 rad/s }
  - { quantity: omega_x_radps, at: sd, value: 1.2909944487358056 rad/s, tolerance: 1e-15 rad/s }
  - { quantity: omega_x_radps, at: 0.5 s, value: 2 rad/s, tolerance: 10 % }
  - { quantity: omega_x_radps, at: largest, value: 4.1 rad/s, tolerance: 1 % }
  - { quantity: omega_y_radps, at: final, value: 0 rad/s, tolerance: 1 rad/s }
";

fn record() -> (Scenario, Record) {
    let scenario = Scenario::load("a.yaml", SCENARIO, &[]).expect("valid");
    let mut record = Record::new(&scenario, Table::new("summary", &["axis", "mean_radps"], &["axis"]));
    record.summary.push(&["gyro, x".into(), f64::NAN.into()]);
    let mut table = Table::new("imu", &["t_s", "omega_x_radps"], &[]);
    for k in 1..=4 {
        table.push(&[(0.25 * f64::from(k)).into(), f64::from(k).into()]);
    }
    record.tables.push(table);
    let panel = figure::Panel::new(figure::Axis::linear("rate (rad/s)"));
    let panel = panel.with(figure::Series::line("x", [[0.0, 0.0], [1.0, 1.0]]));
    record
        .figures
        .push(("gyro".into(), figure::Figure::new("Rate", figure::Axis::time("time")).panel(panel)));
    record.judge(&scenario);
    (scenario, record)
}

/// 1, 2, 3, 4: mean 2.5, standard deviation sqrt(5/3).
#[test]
fn verdicts() {
    let (_, record) = record();
    let holds: Vec<bool> = record.verdicts.iter().map(|v| v.holds).collect();
    assert_eq!(holds, [true, true, true, false, false], "{:#?}", record.verdicts);
    assert!(record.verdicts[4].found.is_nan());
    assert!(!record.holds());
}

/// An `expect` that speaks of nothing fails, and says what there is to speak of.
#[test]
fn what_is_not_found_is_said() {
    let (scenario, mut record) = record();
    let mut table = Table::new("errors", &["t_s", "source", "way", "dn_m"], &["source", "way"]);
    table.push(&[60.0.into(), "gyro.bias.constant.x".into(), "nonlinear".into(), 1.0.into()]);
    table.push(&[60.0.into(), "all".into(), "linear".into(), 1.0.into()]);
    record.tables.push(table);
    let mut reason = |quantity: &str, source: Option<&str>, way: Option<&str>, at: Statistic| {
        let mut scenario = scenario.clone();
        let expect = Expect {
            quantity: quantity.into(),
            source: source.map(Into::into),
            way: way.map(Into::into),
            at,
            value: 1.0,
            tolerance: 1.0,
        };
        scenario.expect = vec![expect];
        record.judge(&scenario);
        assert!(!record.holds());
        let reason = record.verdicts[0].not_found.clone().expect("a reason");
        let json: serde_json::Value = serde_json::from_str(&record.summary_json(&[])).expect("JSON");
        assert_eq!(json["expect"][0]["not_found"], reason.as_str());
        let text = record.summary_text();
        assert!(
            text.contains("is not found (expected 1.0000 ± 1.0000): ") && text.contains(&reason),
            "{text}"
        );
        reason
    };
    let rate = "omega_x_radps";
    assert_eq!(
        reason(rate, None, None, Statistic::Time(0.6)),
        "there is no row at 0.6 s; the nearest are at 0.5 s and 0.75 s"
    );
    assert_eq!(reason(rate, None, None, Statistic::Time(2.0)), "there is no row at 2 s; the last is at 1 s");
    assert_eq!(
        reason(rate, None, None, Statistic::Time(0.0)),
        "there is no row at 0 s; the first is at 0.25 s"
    );
    assert_eq!(
        reason(rate, Some("all"), None, Statistic::Final),
        "the rows of `imu` have no source: leave `source` out"
    );
    assert_eq!(
        reason("omega_y_radps", None, None, Statistic::Final),
        "this run has no column `omega_y_radps`; there are `omega_x_radps`, `dn_m`; did you mean `omega_x_radps`?"
    );
    assert_eq!(
        reason("dn_m", Some("gyro.bias.constnat.x"), None, Statistic::Final),
        "there is no source `gyro.bias.constnat.x`; there are `gyro.bias.constant.x`, `all`; did you mean \
         `gyro.bias.constant.x`?"
    );
    assert_eq!(
        reason("dn_m", Some("all"), Some("exact"), Statistic::Final),
        "there is no way `exact` of source `all`; there is `linear`"
    );
    assert_eq!(
        reason("dn_m", Some("all"), None, Statistic::Deviation),
        "a standard deviation needs two rows; there is one"
    );
}

#[test]
fn csv_reads_back() {
    let mut table = Table::new("t", &["source", "x"], &["source"]);
    let values = [1.0 / 3.0, 1e-300, 0.0, 1e17, f64::MIN_POSITIVE, f64::NAN];
    for value in values {
        table.push(&["a \"b\", c".into(), Cell::Number(value)]);
    }
    let mut text = Vec::new();
    table.write_csv(&mut text).expect("a vector takes all");
    let text = String::from_utf8(text).expect("UTF-8");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("source,x"));
    for (line, value) in lines.zip(values) {
        let number = line.strip_prefix("\"a \"\"b\"\", c\",").expect("a quoted word");
        match number {
            "" => assert!(value.is_nan()),
            _ => assert_eq!(number.parse::<f64>().map(f64::to_bits), Ok(value.to_bits())),
        }
    }
}

/// A negative zero is rounding and no direction; samples are counted in whole numbers.
#[test]
fn zero_has_no_sign_and_a_count_no_decimals() {
    let mut table = Table::new("t", &["x_m", "samples_count"], &[]);
    table.push(&[Cell::Number(-0.0), 184_718.0.into()]);
    table.push(&[Cell::Number(-0.5), 12_345_678.0.into()]);
    let mut csv = Vec::new();
    table.write_csv(&mut csv).expect("a vector takes all");
    assert_eq!(String::from_utf8(csv).expect("UTF-8"), "x_m,samples_count\n0.0,184718\n-0.5,12345678\n");
    assert!(table.text().contains("12345678"), "{}", table.text());
    let (_, mut record) = record();
    record.summary = table;
    let json = record.summary_json(&[]);
    assert!(json.contains("\"x_m\": 0.0,") && json.contains("\"samples_count\": 184718\n"), "{json}");
}

#[test]
fn a_folder_is_whole_or_not_there() {
    let (scenario, record) = record();
    let base = std::env::temp_dir().join(format!("schuler-record-{}", std::process::id()));
    let path = base.join("deep/run");
    // Twice: the second run takes the place of the first.
    for _ in 0..2 {
        let folder = Folder::check(&path).expect("a place");
        folder.write(&record, scenario.output.formats).expect("written");
    }
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path.join("summary.json")).expect("a summary"))
            .expect("JSON");
    assert_eq!(summary["header"]["seed"], 1);
    assert_eq!(summary["expect"][0]["holds"], true);
    assert_eq!(summary["table"][0]["mean_radps"], serde_json::Value::Null);
    assert_eq!(summary["files"], serde_json::json!(["imu.csv", "figures/gyro.png", "summary.json"]));
    assert!(path.join("figures/gyro.png").is_file());
    let beside = |path: &std::path::Path| fs::read_dir(path).expect("a folder").count();
    assert_eq!(beside(&base.join("deep")), 1);

    // Somebody's own files stay, whatever they are called.
    for name in ["notes.txt", "mine.csv", "sources.yaml", "figures/mine.png", "figures/deep"] {
        match name {
            "figures/deep" => fs::create_dir(path.join(name)).expect("made"),
            _ => fs::write(path.join(name), "mine").expect("written"),
        }
        let message = Folder::check(&path).expect_err(name).to_string();
        assert!(message.contains(&format!("found: `{name}`")), "{message}");
        assert!(message.contains("expected: a new folder") && message.contains("--out DIR"), "{message}");
        match name {
            "figures/deep" => fs::remove_dir(path.join(name)).expect("still there"),
            _ => fs::remove_file(path.join(name)).expect("still there"),
        }
    }
    // One that comes while the study runs stays too, and so does the earlier result.
    let folder = Folder::check(&path).expect("a place");
    fs::write(path.join("late.csv"), "mine").expect("written");
    assert!(matches!(folder.write(&record, scenario.output.formats), Err(Error::Input(_))));
    assert_eq!(fs::read_to_string(path.join("late.csv")).expect("still there"), "mine");
    assert!(path.join("imu.csv").is_file());
    assert_eq!(beside(&base.join("deep")), 1);
    // What killed programs left is in nobody's way: a probe, results half written, earlier ones between two places.
    fs::remove_file(path.join("late.csv")).expect("still there");
    let earlier = fs::read(path.join("imu.csv")).expect("a table");
    for inside in [path.clone(), path.join("figures")] {
        fs::create_dir(inside.join(".schuler-probe-1")).expect("made");
    }
    fs::create_dir(base.join("deep/.run.part")).expect("made");
    fs::write(base.join("deep/.run.part/imu.csv"), "half").expect("written");
    fs::rename(&path, base.join("deep/.run.old")).expect("moved");
    let folder = Folder::check(&path).expect("a place");
    assert_eq!(fs::read(path.join("imu.csv")).expect("back"), earlier);
    folder.write(&record, scenario.output.formats).expect("written");
    assert_eq!(fs::read(path.join("imu.csv")).expect("a table"), earlier);
    assert_eq!((beside(&path), beside(&base.join("deep"))), (3, 1));
    // An earlier result whose removal was cut off.
    fs::create_dir(base.join("deep/.run.old")).expect("made");
    fs::copy(path.join("summary.json"), base.join("deep/.run.old/summary.json")).expect("copied");
    folder.write(&record, scenario.output.formats).expect("written");
    assert_eq!(beside(&base.join("deep")), 1);
    fs::write(path.join("late.csv"), "mine").expect("written");
    // A summary that is none of ours lists nothing.
    let foreign = base.join("deep/foreign");
    fs::create_dir(&foreign).expect("made");
    fs::write(foreign.join("summary.json"), "{}").expect("written");
    assert!(matches!(Folder::check(&foreign), Err(Error::Input(_))));
    // A file is no folder, and nothing can be made below it.
    assert!(matches!(Folder::check(path.join("late.csv")), Err(Error::Input(_))));
    assert!(matches!(Folder::check(path.join("late.csv/run")), Err(Error::Input(_))));
    // A record that cannot be written leaves what was there.
    let mut broken = record.clone();
    broken.tables[0].name = "no/such/folder".into();
    let other = Folder::check(base.join("other/below")).expect("a place");
    assert!(other.write(&broken, scenario.output.formats).is_err());
    assert_eq!(beside(&base), 1);
    fs::remove_dir_all(&base).expect("removed");
}
