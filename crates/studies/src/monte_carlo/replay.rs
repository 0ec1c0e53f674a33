//! A single run, sample by sample.

use super::{
    runs::{runs, units},
    scene::Scene,
};
use crate::{
    Context, Diagnostic, Error, Record, Scenario,
    record::{Cell, Table, columns},
    scenario::MonteCarlo,
};

/// Rows at most; longer runs have one every so many samples.
const MOST_ROWS: u64 = 1_000_000;

/// The errors of run `run` at every sample, or of a long run at every so many that a million rows are not exceeded: the numbers
/// that it has among all others.
///
/// # Errors
/// The study has no such run; it gives no numbers.
pub fn replay(scenario: &Scenario, study: &MonteCarlo, run: u64, context: &Context) -> Result<Record, Error> {
    if run >= study.runs {
        let fault = Diagnostic::new(&scenario.file, "the study has no such run")
            .path("monte_carlo.runs")
            .expected(format!("0 to {}", study.runs - 1))
            .found(run.to_string());
        return Err(fault.into());
    }
    // Rows are states after whole updates.
    let update = study.mechanization.coning.samples() as u64;
    let stride = study.samples.div_ceil(MOST_ROWS).next_multiple_of(update);
    let scene = Scene::with_stride(study, scenario.seed, stride);
    context.progress.begin("run", units(&scene));
    let chunk = runs(&scene, run, run + 1, context.progress)?;
    let mut errors = Table::new("errors", &columns::ERRORS, &["source", "way"]);
    let mut summary = Table::new("summary", &columns::ERRORS, &["source", "way"]);
    let name = format!("run {run}");
    for (row, error) in chunk.errors.iter().enumerate() {
        let mut cells: Vec<Cell> =
            vec![scene.time(scene.rows[row]).into(), name.as_str().into(), "run".into()];
        cells.extend(error.map(Cell::from));
        errors.push(&cells);
        if row + 1 == chunk.errors.len() {
            summary.push(&cells);
        }
    }
    let mut record = Record::new(scenario, summary);
    record.tables.push(errors);
    Ok(record)
}
