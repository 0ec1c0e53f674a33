//! The Monte Carlo study: many runs of the full navigator, each with draws of its own, beside what the covariance predicts.
//!
//! Run i is a pure function of the scenario, the seed and i. Figures are gathered in the order of the runs, so that they are the
//! same to the last bit on any number of threads and in any number of parts.

mod bands;
mod figures;
mod gather;
pub(crate) mod group;
mod magnitude;
mod prediction;
mod replay;
mod report;
mod runs;
mod scene;
mod shard;
mod sketch;
mod state;
mod statistics;
mod store;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use crate::{Context, Error, Scenario, record::Record, scenario::MonteCarlo};
use gather::{Chunks, Gathered};
use prediction::prediction;
use scene::Scene;
use state::{Identity, State};

pub use replay::replay;
pub use shard::{Origin, Part, merge, part};
pub use state::remove as discard;

/// Runs a Monte Carlo study in memory.
///
/// # Errors
/// A run without numbers; an IMU that refuses its list.
pub fn run(scenario: &Scenario, study: &MonteCarlo, context: &Context) -> Result<Record, Error> {
    let scene = Scene::new(scenario, study);
    gathered(scenario, &scene, None, context)
}

/// Runs a Monte Carlo study whose finished runs are kept in the folder `kept`: killed at any moment and started again, it goes on
/// and ends with the same record. Once that is written, [`discard`] takes the folder away.
///
/// # Errors
/// As [`run`]; `kept` cannot be written, or holds something else or runs of another scenario, seed or version.
pub fn run_kept(
    scenario: &Scenario,
    study: &MonteCarlo,
    context: &Context,
    kept: &Path,
) -> Result<Record, Error> {
    let scene = Scene::new(scenario, study);
    let state = open(scenario, &scene, kept)?;
    gathered(scenario, &scene, Some(&state), context)
}

fn gathered(
    scenario: &Scenario,
    scene: &Scene,
    state: Option<&State>,
    context: &Context,
) -> Result<Record, Error> {
    let mut chunks = Chunks::new(scene, 0..scene.study.runs, state, context.progress)?;
    // Nothing is compared with the prediction before the first runs are there.
    let (predicted, mut next) = rayon::join(|| prediction(scene), || chunks.next());
    let mut gathered = Gathered::new(scene, predicted);
    while let Some(chunk) = next? {
        gathered.add(&chunk);
        if gathered.done {
            break;
        }
        next = chunks.next();
    }
    let mut record = gathered.record(scenario);
    record.judge(scenario);
    Ok(record)
}

fn open(scenario: &Scenario, scene: &Scene, kept: &Path) -> Result<State, Error> {
    let times = scene.rows.iter().map(|&k| scene.time(k)).collect();
    State::open(kept, &Identity::of(scenario, scene), times)
}

/// The folder in which finished runs are kept until the results are in `out`: beside it, `out.partial`.
pub fn kept(out: &Path) -> PathBuf {
    let mut name = out.file_name().unwrap_or_default().to_os_string();
    name.push(".partial");
    out.with_file_name(name)
}
