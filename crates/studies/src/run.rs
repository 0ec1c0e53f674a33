//! From a scenario to a record.

use crate::{Context, Error, Scenario, drift, imu_study, record::Record, scenario::Study};

/// Runs the study of a scenario and judges its `expect`. A pure function of the scenario and, for
/// `navigate`, of the log.
pub fn run(scenario: &Scenario, context: &Context) -> Result<Record, Error> {
    let mut record = match &scenario.study {
        Study::Imu(study) => imu_study::run(scenario, study, context)?,
        Study::Drift(_) => drift::run(scenario, context)?,
        Study::Navigate(_) => return Err(Error::Unsupported { what: "navigation of a log".into() }),
    };
    record.judge(scenario);
    Ok(record)
}
