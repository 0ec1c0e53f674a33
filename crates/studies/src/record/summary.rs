//! `summary.json`, and the summary for the terminal.

use std::fmt::{self, Display, Formatter, Write};

use serde::{Serialize, Serializer, ser::SerializeMap};

use super::{Cell, Header, Record, Table, Verdict, columns};

#[derive(Serialize)]
struct Summary<'a> {
    header: &'a Header,
    table: Rows<'a>,
    notes: &'a [String],
    expect: &'a [Verdict],
    files: &'a [String],
}

/// The rows of a table as maps from column to value.
struct Rows<'a>(&'a Table);

struct Row<'a>(&'a Table, usize);

impl Serialize for Rows<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.0.len()).map(|row| Row(self.0, row)))
    }
}

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Row(table, row) = self;
        let mut map = serializer.serialize_map(Some(table.columns.len()))?;
        for column in &table.columns {
            match column.cell(*row) {
                Cell::Number(value) if value.is_finite() && columns::is_count(column.name()) => {
                    map.serialize_entry(column.name(), &(value as u64))?
                }
                // A sum with 0 has no negative zero.
                Cell::Number(value) => map.serialize_entry(column.name(), &(value + 0.0))?,
                Cell::Word(word) => map.serialize_entry(column.name(), word)?,
            }
        }
        map.end()
    }
}

impl Record {
    /// Header, table, notes and verdicts as JSON; numbers that are not finite are `null`.
    pub fn summary_json(&self, files: &[String]) -> String {
        let Record { header, summary, notes, verdicts, .. } = self;
        let summary = Summary { header, table: Rows(summary), notes, expect: verdicts, files };
        let mut text = serde_json::to_string_pretty(&summary).expect("invariant: a record is a JSON value");
        text.push('\n');
        text
    }

    /// Title, table, notes and verdicts for a terminal.
    pub fn summary_text(&self) -> String {
        let Header { title, study, seed, gravity, vertical, scenario_hash, .. } = &self.header;
        let mut text = format!("{title}\n{study} study, seed {seed}, scenario {}", &scenario_hash[..12]);
        for (name, value) in [("gravity", gravity), ("vertical channel", vertical)] {
            if let Some(value) = value {
                let _ = write!(text, ", {name} {value}");
            }
        }
        text.push_str("\n\n");
        text.push_str(&self.summary.text());
        for note in &self.notes {
            let _ = writeln!(text, "\n{note}.");
        }
        if !self.verdicts.is_empty() {
            text.push('\n');
        }
        for verdict in &self.verdicts {
            let word = if verdict.holds { "holds" } else { "FAILS" };
            let _ = writeln!(text, "expect {word}: {verdict}");
        }
        text
    }
}

/// What was compared, what it is and what was expected; or why it is not there.
impl Display for Verdict {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Verdict { what, expected, tolerance, found, not_found, .. } = self;
        let expected = digits(*expected, *tolerance);
        let end = format!("expected {expected} ± {}", number(*tolerance));
        match not_found {
            Some(reason) => write!(f, "{what} is not found ({end}): {reason}"),
            None => write!(f, "{what} is {}, {end}", digits(*found, *tolerance)),
        }
    }
}

impl Table {
    /// The table in columns of equal width, words to the left, numbers to the right.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let cells: Vec<Vec<String>> = self
            .columns
            .iter()
            .map(|column| {
                let show = |row| match column.cell(row) {
                    Cell::Number(x) if x.is_finite() && columns::is_count(column.name()) => format!("{x:.0}"),
                    Cell::Number(x) => number(x),
                    Cell::Word(word) => word.into(),
                };
                std::iter::once(column.name().to_string()).chain((0..column.len()).map(show)).collect()
            })
            .collect();
        let widths: Vec<usize> =
            cells.iter().map(|c| c.iter().map(|s| s.chars().count()).max().unwrap_or(0)).collect();
        for row in 0..=self.len() {
            let mut line = String::new();
            for (i, column) in self.columns.iter().enumerate() {
                let (cell, width) = (&cells[i][row], widths[i]);
                let _ = match column {
                    super::Column::Word { .. } => write!(line, "{cell:<width$}  "),
                    super::Column::Number { .. } => write!(line, "{cell:>width$}  "),
                };
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }
}

/// As many digits as it takes to see the tolerance.
fn digits(x: f64, tolerance: f64) -> String {
    let seen = (x.abs() / tolerance).log10().ceil();
    significant(x, if seen.is_finite() { (seen as i32 + 2).clamp(5, 15) } else { 5 })
}

/// Five significant digits; `-` where there is no number.
pub(crate) fn number(x: f64) -> String {
    significant(x, 5)
}

fn significant(x: f64, digits: i32) -> String {
    if !x.is_finite() {
        return "-".into();
    }
    if x == 0.0 {
        return "0".into();
    }
    let exponent = x.abs().log10().floor() as i32;
    if (-3..7).contains(&exponent) {
        let decimals = (digits - 1 - exponent).max(0) as usize;
        format!("{x:.decimals$}")
    } else {
        format!("{x:.*e}", digits as usize - 1)
    }
}
