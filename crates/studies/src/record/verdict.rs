//! `expect` beside what the study found.

use super::{Cell, Record, Table, Verdict};
use crate::{
    Scenario,
    scenario::{Expect, Statistic},
};

impl Record {
    /// Compares each `expect` of the scenario with the tables.
    pub fn judge(&mut self, scenario: &Scenario) {
        self.verdicts = scenario.expect.iter().map(|expect| self.verdict(expect)).collect();
    }

    /// Whether every `expect` holds.
    pub fn holds(&self) -> bool {
        self.verdicts.iter().all(|verdict| verdict.holds)
    }

    fn verdict(&self, expect: &Expect) -> Verdict {
        let found = self.tables.iter().find_map(|table| find(table, expect)).unwrap_or(f64::NAN);
        Verdict {
            what: what(expect),
            expected: expect.value,
            tolerance: expect.tolerance,
            found,
            // Written so that NaN fails.
            holds: (found - expect.value).abs() <= expect.tolerance,
        }
    }
}

/// The number that `expect` speaks of, if the table has such rows.
fn find(table: &Table, expect: &Expect) -> Option<f64> {
    let values = table.numbers(&expect.quantity)?;
    let filters = [("source", &expect.source), ("way", &expect.way)];
    let wanted = |row: usize| {
        filters.iter().all(|(name, word)| {
            word.as_ref().is_none_or(|word| {
                table.column(name).is_some_and(|column| column.cell(row) == Cell::Word(word))
            })
        })
    };
    let rows: Vec<usize> = (0..table.len()).filter(|&row| wanted(row)).collect();
    let n = rows.len() as f64;
    let sum = |f: &dyn Fn(f64) -> f64| rows.iter().map(|&row| f(values[row])).sum::<f64>();
    match expect.at {
        _ if rows.is_empty() => None,
        Statistic::Time(t) => {
            let times = table.numbers("t_s")?;
            // Times of rows are multiples of an interval: rounding apart, a row is there or it is not.
            rows.iter().find(|&&row| (times[row] - t).abs() <= 1e-9 * t.max(1.0)).map(|&row| values[row])
        }
        Statistic::Final => rows.last().map(|&row| values[row]),
        Statistic::Largest => Some(rows.iter().fold(0.0, |m: f64, &row| m.max(values[row].abs()))),
        Statistic::Rms => Some((sum(&|x| x * x) / n).sqrt()),
        Statistic::Mean => Some(sum(&|x| x) / n),
        Statistic::Deviation => {
            let mean = sum(&|x| x) / n;
            Some((sum(&|x| (x - mean).powi(2)) / (n - 1.0)).sqrt())
        }
    }
}

fn what(expect: &Expect) -> String {
    let Expect { quantity, source, way, at, .. } = expect;
    let mut text = match at {
        Statistic::Time(t) => format!("{quantity} at {t} s"),
        Statistic::Final => format!("{quantity} at the end"),
        Statistic::Largest => format!("largest {quantity}"),
        Statistic::Rms => format!("rms of {quantity}"),
        Statistic::Mean => format!("mean of {quantity}"),
        Statistic::Deviation => format!("standard deviation of {quantity}"),
    };
    for (name, word) in [("source", source), ("way", way)] {
        if let Some(word) = word {
            text += &format!(", {name} {word}");
        }
    }
    text
}
