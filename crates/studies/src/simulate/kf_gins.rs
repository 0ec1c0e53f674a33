//! The logs once more, as KF-GINS reads them (its README, "Data format"): tables of numbers with blanks between them.

use std::fmt::Write;

use crate::record::{Table, columns};

/// `imu.txt`, `truth.nav` and, where a position was measured, `gnss.txt`. `dt` is the sample interval, s.
pub fn texts(tables: &[Table], dt: f64) -> Vec<(String, String)> {
    let table = |name: &str| tables.iter().find(|table| table.name == name);
    let mut texts = Vec::new();
    if let Some(imu) = table("imu") {
        // Rates of the one form are increments of the other over the interval.
        let (names, factor) = match imu.numbers(columns::INCREMENTS[1]) {
            Some(_) => (columns::INCREMENTS, 1.0),
            None => (columns::RATES, dt),
        };
        let factors = [1.0, factor, factor, factor, factor, factor, factor];
        texts.push(("imu.txt".into(), text(imu, "", &names, &factors)));
    }
    const DEG: f64 = 180.0 / std::f64::consts::PI;
    if let Some(position) = table("position") {
        let factors = [1.0, DEG, DEG, 1.0, 1.0, 1.0, 1.0];
        texts.push(("gnss.txt".into(), text(position, "", &columns::POSITION_AID, &factors)));
    }
    if let Some(truth) = table("truth") {
        let factors = [1.0, DEG, DEG, 1.0, 1.0, 1.0, 1.0, DEG, DEG, DEG];
        texts.push(("truth.nav".into(), text(truth, "0 ", &columns::TRAJECTORY, &factors)));
    }
    texts
}

/// The columns `names` times `factors`, each row with `first` before it. Numbers are as short as reading them back allows.
fn text(table: &Table, first: &str, names: &[&str], factors: &[f64]) -> String {
    let columns: Vec<&[f64]> = names.iter().filter_map(|name| table.numbers(name)).collect();
    let mut text = String::new();
    for row in 0..table.len() {
        text += first;
        for (k, (column, factor)) in columns.iter().zip(factors).enumerate() {
            let separator = if k + 1 < columns.len() { ' ' } else { '\n' };
            let value = column[row] * factor;
            let _ = match value.abs() {
                0.0 | 1e-3..1e9 => write!(text, "{value}{separator}"),
                _ => write!(text, "{value:e}{separator}"),
            };
        }
    }
    text
}
