//! From a scenario to a record.

use crate::{
    Context, Error, Scenario, align, allan_study, budget, drift, imu_study, monte_carlo, navigate,
    record::Record, scenario::Study, simulate,
};

/// Runs the study of a scenario and judges its `expect`. A pure function of the scenario and, for
/// `navigate` and `allan`, of the log.
pub fn run(scenario: &Scenario, context: &Context) -> Result<Record, Error> {
    let mut record = match &scenario.study {
        Study::Imu(study) => imu_study::run(scenario, study, context)?,
        Study::Simulate(study) => simulate::run(scenario, study, context)?,
        Study::Drift(_) => drift::run(scenario, context)?,
        Study::Navigate(_) => navigate::run(scenario, context)?,
        Study::Aided(aided) => navigate::aided::run(scenario, aided, context)?,
        Study::Align(_) => align::run(scenario, context)?,
        Study::Budget(study) => budget::run(scenario, study, context)?,
        Study::MonteCarlo(study) => monte_carlo::run(scenario, study, context)?,
        Study::Allan(_) => allan_study::run(scenario, context)?,
    };
    record.judge(scenario);
    Ok(record)
}
