//! `expect` beside what the study found.

use super::{Record, Verdict, lookup::look};
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
        let (found, not_found) = match look(&self.tables, expect) {
            Ok(found) => (found, None),
            Err(reason) => (f64::NAN, Some(reason)),
        };
        Verdict {
            what: what(expect),
            expected: expect.value,
            tolerance: expect.tolerance,
            found,
            not_found,
            // Written so that NaN fails.
            holds: (found - expect.value).abs() <= expect.tolerance,
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
