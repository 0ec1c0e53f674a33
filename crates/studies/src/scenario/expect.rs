//! `expect`: one number of the output, its value and tolerance.

use schuler_imu::Unit;

use super::{
    de::{At, one_of},
    document::{Document, Spot},
    schema::Scalar,
    valid::{Expect, Statistic},
    written::{self, StudyKind},
};
use crate::{Diagnostic, record::columns, similar::similar, units};

/// Words of `at`.
const STATISTICS: [(&str, Statistic); 5] = [
    ("final", Statistic::Final),
    ("largest", Statistic::Largest),
    ("rms", Statistic::Rms),
    ("mean", Statistic::Mean),
    ("sd", Statistic::Deviation),
];

impl Document {
    pub(super) fn expect(
        &self,
        expect: &At<written::Expect>,
        study: StudyKind,
    ) -> Result<Expect, Diagnostic> {
        let w = &expect.value;
        let unit = self.quantity_unit(&w.quantity, study)?;
        if let Some(way) = w.way.as_ref().filter(|way| !columns::WAYS.contains(&way.value.as_str())) {
            return Err(self.unknown_word(way, "way", &columns::WAYS));
        }
        let value = self.quantity(&w.value, unit, super::quantity::Range::Any)?;
        Ok(Expect {
            quantity: w.quantity.value.clone(),
            source: w.source.clone(),
            way: w.way.as_ref().map(|way| way.value.clone()),
            at: self.statistic(&w.at)?,
            value,
            tolerance: self.tolerance(&w.tolerance, value, unit)?,
        })
    }

    /// The unit of an output column of the study.
    fn quantity_unit(&self, quantity: &At<String>, study: StudyKind) -> Result<Unit, Diagnostic> {
        let known: Vec<&str> = match study {
            StudyKind::Imu => [
                &columns::IMU_ERRORS[..],
                &columns::RATES,
                &columns::INCREMENTS,
                &columns::IMU_FLAGS,
                &columns::ALLAN,
            ]
            .concat(),
            StudyKind::Simulate => [
                &columns::TRUTH[..],
                &columns::RATES[1..],
                &columns::INCREMENTS,
                &columns::POSITION_AID[4..],
                &columns::VELOCITY_AID[4..],
            ]
            .concat(),
            StudyKind::Drift => columns::ERRORS.to_vec(),
            // Its parameters are estimates with intervals of their own; the deviations are facts of the log.
            StudyKind::Allan => vec!["deviation_radps", "deviation_mps2"],
            StudyKind::Budget => {
                let others = ["radius_mps", "derivative_mps", "radius_rad", "derivative_rad"];
                [&columns::BUDGET[3..], &columns::REQUIREMENT[2..], &columns::AGREEMENT[2..], &others]
                    .concat()
            }
            StudyKind::MonteCarlo => {
                [&columns::MONTE_CARLO[3..], &columns::EXCEEDANCE[2..], &columns::RUNS_NEES[1..]].concat()
            }
            StudyKind::Align => {
                [&columns::ERRORS[3..], &columns::CONSISTENCY[2..], &columns::WINDOWS[2..]].concat()
            }
            StudyKind::Navigate => [
                &columns::TRAJECTORY[..],
                &columns::ERRORS[3..],
                &columns::LOG[2..],
                &columns::SIGMAS[1..],
                &columns::UPDATES[1..],
                &["normalized_ratio"],
                &columns::NEES[1..],
                &columns::IMU_ERRORS[1..],
            ]
            .concat(),
        };
        let known: Vec<&str> =
            known.into_iter().filter(|name| columns::unit(name).is_some() && *name != "t_s").collect();
        match columns::unit(&quantity.value).filter(|_| known.contains(&quantity.value.as_str())) {
            Some(unit) => Ok(unit),
            None => Err(self.unknown_word(quantity, "quantity", &known)),
        }
    }

    fn unknown_word(&self, word: &At<String>, what: &str, known: &[&str]) -> Diagnostic {
        let problem = format!("unknown {what} `{}`", word.value);
        let diagnostic = self.diagnostic(Spot::Node(word.node), problem).expected(one_of(known));
        match similar(&word.value, known.iter().copied()) {
            Some(similar) => diagnostic.help(format!("did you mean `{similar}`?")),
            None => diagnostic,
        }
    }

    fn statistic(&self, at: &At<String>) -> Result<Statistic, Diagnostic> {
        if let Some((_, statistic)) = STATISTICS.iter().find(|(word, _)| *word == at.value) {
            return Ok(*statistic);
        }
        match units::parse_quantity(&at.value) {
            Ok(time) if time.unit == Unit::SECOND && time.value >= 0.0 => Ok(Statistic::Time(time.value)),
            _ => {
                let words = STATISTICS.map(|(word, _)| word);
                Err(self
                    .diagnostic(Spot::Node(at.node), "neither a time nor a statistic")
                    .expected(format!("a time, or {}", one_of(&words)))
                    .found(format!("`{}`", at.value))
                    .example("at: 24 h"))
            }
        }
    }

    /// In the unit of the value, or as a ratio of it.
    fn tolerance(&self, tolerance: &At<Scalar>, value: f64, unit: Unit) -> Result<f64, Diagnostic> {
        let (quantity, found) = self.parse_scalar(tolerance.node, &tolerance.value, unit)?;
        let size = match quantity.unit {
            given if given == unit => quantity.value,
            Unit::ONE => quantity.value * value.abs(),
            _ => {
                return Err(self
                    .diagnostic(Spot::Node(tolerance.node), "wrong dimension")
                    .expected(format!("{}, or a ratio", units::describe(unit)))
                    .found(found)
                    .example("tolerance: 0.1 %"));
            }
        };
        if size < 0.0 {
            let fault = self.diagnostic(Spot::Node(tolerance.node), "must not be negative");
            return Err(fault.found(found).example("tolerance: 0.1 %"));
        }
        Ok(size)
    }
}
