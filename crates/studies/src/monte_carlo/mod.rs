//! The Monte Carlo study: many runs of the full navigator, each with draws of its own, beside what the covariance predicts.
//!
//! Run i is a pure function of the scenario, the seed and i. Figures are gathered in the order of the runs, so that they are the
//! same to the last bit on any number of threads and in any number of parts.

mod bands;
mod figures;
mod prediction;
mod report;
mod runs;
mod scene;
mod sketch;
mod statistics;
#[cfg(test)]
mod tests;

use crate::{Context, Error, Scenario, record::Record, scenario::MonteCarlo};
use prediction::prediction;
use runs::{runs, units};
use scene::Scene;
use statistics::Statistics;

/// Runs that are made, kept and gathered together.
const CHUNK: u64 = 128;

/// Runs a Monte Carlo study in memory.
///
/// # Errors
/// A run without numbers; an IMU that refuses its list.
pub fn run(scenario: &Scenario, study: &MonteCarlo, context: &Context) -> Result<Record, Error> {
    let scene = Scene::new(scenario, study);
    let predicted = prediction(&scene);
    let rows = scene.rows.len();
    let mut statistics = Statistics::new(rows, predicted.as_deref().ok(), &study.thresholds);
    context.progress.begin("runs", units(&scene) * study.runs);
    for first in (0..study.runs).step_by(CHUNK as usize) {
        let chunk = runs(&scene, first, study.runs.min(first + CHUNK), context.progress)?;
        chunk.runs(rows).for_each(|run| statistics.add(run));
    }
    Ok(record(scenario, &scene, &statistics, &predicted))
}

/// The record of all runs.
fn record(
    scenario: &Scenario,
    scene: &Scene,
    statistics: &Statistics,
    predicted: &Result<Vec<prediction::Predicted>, String>,
) -> Record {
    let rows = predicted.as_deref().ok();
    let mut record = Record::new(scenario, report::summary(statistics, rows));
    record.tables = report::tables(scene, statistics, rows);
    record.notes = report::notes(scene, statistics, predicted);
    if scenario.output.formats.png || scenario.output.formats.svg {
        record.figures = figures::figures(&scenario.title, scene, statistics, rows);
    }
    record
}
