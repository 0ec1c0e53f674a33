//! From a scenario to a record.

use crate::{Context, Error, Scenario, record::Record};

/// Runs the study of a scenario. A pure function of the scenario and, for `navigate`, of the log.
pub fn run(scenario: &Scenario, context: &Context) -> Result<Record, Error> {
    let _ = context;
    Err(Error::Unsupported { what: format!("the study of {}", scenario.file.display()) })
}
