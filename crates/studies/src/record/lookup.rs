//! The number that an `expect` speaks of, or why there is none and what there is instead.

use super::{Cell, Column, Table, columns};
use crate::{
    scenario::{Expect, Statistic},
    similar::similar,
};

/// Words that a message names before it counts the rest.
const NAMED: usize = 12;

/// The number in the first table that has the quantity; else a sentence without a full stop.
pub fn look(tables: &[Table], expect: &Expect) -> Result<f64, String> {
    let quantity = &expect.quantity;
    let Some((table, values)) = tables.iter().find_map(|t| Some((t, t.numbers(quantity)?))) else {
        let known = tables.iter().flat_map(|t| &t.columns).map(Column::name);
        let known = distinct(known.filter(|name| *name != "t_s" && columns::unit(name).is_some()));
        return Err(format!("this run has no column `{quantity}`{}", there_is(quantity, &known)));
    };
    let mut rows: Vec<usize> = (0..table.len()).collect();
    let mut of = String::new();
    for (name, word) in [("source", &expect.source), ("way", &expect.way)] {
        let Some(word) = word else { continue };
        let Some(column) = table.column(name) else {
            let table = &table.name;
            return Err(format!("the rows of `{table}` have no {name}: leave `{name}` out"));
        };
        let known = distinct(rows.iter().filter_map(|&row| match column.cell(row) {
            Cell::Word(word) => Some(word),
            Cell::Number(_) => None,
        }));
        if !known.contains(&word.as_str()) {
            return Err(format!("there is no {name} `{word}`{of}{}", there_is(word, &known)));
        }
        rows.retain(|&row| column.cell(row) == Cell::Word(word));
        of = format!(" of {name} `{word}`");
    }
    if rows.is_empty() {
        return Err(format!("`{}` has no rows", table.name));
    }
    let found = match expect.at {
        Statistic::Time(t) => values[row_at(table, &rows, t)?],
        Statistic::Deviation if rows.len() < 2 => {
            return Err("a standard deviation needs two rows; there is one".into());
        }
        statistic => of_rows(statistic, &rows, values),
    };
    if found.is_nan() { Err("there the table has no number".into()) } else { Ok(found) }
}

/// The row at a time. Times of rows are multiples of an interval: rounding apart, a row is there or it is not.
fn row_at(table: &Table, rows: &[usize], t: f64) -> Result<usize, String> {
    let times = table.numbers("t_s").ok_or_else(|| format!("`{}` has no times", table.name))?;
    if let Some(row) = rows.iter().find(|&&row| (times[row] - t).abs() <= 1e-9 * t.max(1.0)) {
        return Ok(*row);
    }
    let before = rows.iter().map(|&row| times[row]).filter(|x| *x < t).fold(f64::NAN, f64::max);
    let after = rows.iter().map(|&row| times[row]).filter(|x| *x > t).fold(f64::NAN, f64::min);
    Err(match (before.is_nan(), after.is_nan()) {
        (false, false) => format!("there is no row at {t} s; the nearest are at {before} s and {after} s"),
        (false, true) => format!("there is no row at {t} s; the last is at {before} s"),
        _ => format!("there is no row at {t} s; the first is at {after} s"),
    })
}

fn of_rows(statistic: Statistic, rows: &[usize], values: &[f64]) -> f64 {
    let n = rows.len() as f64;
    let sum = |f: &dyn Fn(f64) -> f64| rows.iter().map(|&row| f(values[row])).sum::<f64>();
    match statistic {
        Statistic::Time(_) | Statistic::Final => rows.last().map_or(f64::NAN, |&row| values[row]),
        Statistic::Largest => rows.iter().fold(0.0, |m: f64, &row| m.max(values[row].abs())),
        Statistic::Rms => (sum(&|x| x * x) / n).sqrt(),
        Statistic::Mean => sum(&|x| x) / n,
        Statistic::Deviation => {
            let mean = sum(&|x| x) / n;
            (sum(&|x| (x - mean).powi(2)) / (n - 1.0)).sqrt()
        }
    }
}

/// Each word once, in order of first appearance.
fn distinct<'a>(words: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen = std::collections::HashSet::new();
    words.filter(|word| seen.insert(*word)).collect()
}

/// `; there are …; did you mean …?`
fn there_is(word: &str, known: &[&str]) -> String {
    if known.is_empty() {
        return "; there are none".into();
    }
    let named: Vec<String> = known.iter().take(NAMED).map(|word| format!("`{word}`")).collect();
    let verb = if known.len() == 1 { "is" } else { "are" };
    let mut text = format!("; there {verb} {}", named.join(", "));
    if known.len() > NAMED {
        text += &format!(" and {} more", known.len() - NAMED);
    }
    if let Some(near) = similar(word, known.iter().copied()) {
        text += &format!("; did you mean `{near}`?");
    }
    text
}
