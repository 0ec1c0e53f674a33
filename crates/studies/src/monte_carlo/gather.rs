//! From runs, made or kept, to their statistics.

use super::{
    prediction::{Predicted, prediction},
    runs::{Chunk, runs, units},
    scene::Scene,
    state::State,
    statistics::Statistics,
    store::Digest,
};
use crate::{Error, Progress, Record, Scenario, scenario::Until};

/// Runs that are kept together, counted from run 0 on.
pub const CHUNK: u64 = 64;

/// Everything gathered so far, run by run in the order of their numbers.
pub struct Gathered<'a> {
    scene: &'a Scene<'a>,
    predicted: Result<Vec<Predicted>, String>,
    statistics: Statistics<'a>,
    digest: Digest,
    until: Option<(Until, usize)>,
    /// Whether `until` is met.
    pub done: bool,
}

impl<'a> Gathered<'a> {
    /// Nothing yet.
    pub fn new(scene: &'a Scene<'a>) -> Gathered<'a> {
        let predicted = prediction(scene);
        let rows = scene.rows.len();
        let until = scene.study.until.map(|until| {
            let row = scene.rows.iter().position(|&k| (scene.time(k) - until.at).abs() < 0.5 * scene.dt);
            (until, row.expect("invariant: the time of a valid `until` is that of a row"))
        });
        Gathered {
            scene,
            statistics: Statistics::new(rows, predicted.as_deref().ok(), &scene.study.thresholds),
            predicted,
            digest: Digest::default(),
            until,
            done: false,
        }
    }

    /// The next runs; those after the one with which `until` is met are left out.
    pub fn add(&mut self, chunk: &Chunk) {
        for (run, errors) in (chunk.first..).zip(chunk.runs(self.scene.rows.len())) {
            if self.done {
                return;
            }
            self.statistics.add(errors);
            self.digest.add(run, errors);
            if let Some((until, row)) = self.until
                && is_milestone(self.statistics.runs)
            {
                let found = self.statistics.figure(row, until.quantity, until.figure);
                self.done = found.high - found.low <= 2.0 * until.relative * found.value;
            }
        }
    }

    /// The record of all runs.
    pub fn record(&self, scenario: &Scenario) -> Record {
        let Gathered { scene, statistics, predicted, .. } = self;
        let rows = predicted.as_deref().ok();
        let mut record = Record::new(scenario, super::report::summary(statistics, rows));
        record.tables = super::report::tables(scene, statistics, rows);
        record.notes = super::report::notes(scene, statistics, predicted);
        if let Some((until, _)) = self.until {
            record.notes.push(if self.done {
                format!(
                    "Ended after {} of at most {} runs: the figure of `until` is known to {} %",
                    statistics.runs,
                    scene.study.runs,
                    100.0 * until.relative
                )
            } else {
                format!("All {} runs did not make the figure of `until` as certain as asked", statistics.runs)
            });
        }
        record.notes.push(format!("Digest of the errors of all runs: {}", self.digest.hex()));
        if scenario.output.formats.png || scenario.output.formats.svg {
            record.figures = super::figures::figures(&scenario.title, scene, statistics, rows);
        }
        record
    }
}

/// Numbers of runs at which `until` is looked at, so that where it ends does not depend on how the runs are made: 128, 192, 256, 384, …
fn is_milestone(runs: u64) -> bool {
    runs >= 128 && (runs.is_power_of_two() || (runs.is_multiple_of(3) && (runs / 3).is_power_of_two()))
}

/// End of the chunk that begins with run `first`, no later than `last`.
fn chunk_end(first: u64, last: u64) -> u64 {
    last.min((first / CHUNK + 1) * CHUNK)
}

/// The runs `first..last` chunk by chunk in their order: those that `state` has from there, the others made and kept there. Ends
/// early when `take` wants no more.
pub fn each_chunk(
    scene: &Scene,
    first: u64,
    last: u64,
    state: Option<&State>,
    progress: &dyn Progress,
    mut take: impl FnMut(&Chunk) -> Result<bool, Error>,
) -> Result<(), Error> {
    let has = |at: u64| state.is_some_and(|state| state.has(at, chunk_end(at, last)));
    let chunks =
        || std::iter::successors(Some(first), |at| Some(chunk_end(*at, last))).take_while(|at| *at < last);
    let missing: u64 = chunks().filter(|at| !has(*at)).map(|at| chunk_end(at, last) - at).sum();
    progress.begin("runs", units(scene) * missing);
    // Together as many as keep all threads busy; the motion is calculated once for them.
    let together = 2 * CHUNK.max(16 * rayon::current_num_threads() as u64);
    let rows = scene.rows.len();
    let mut at = first;
    while at < last {
        let end = chunk_end(at, last);
        if let Some(chunk) = state.and_then(|state| state.load(at, end)) {
            if !take(&chunk)? {
                return Ok(());
            }
            at = end;
            continue;
        }
        let mut stop = end;
        while stop < last && stop - at < together && !has(stop) {
            stop = chunk_end(stop, last);
        }
        let Chunk { errors, .. } = runs(scene, at, stop, progress)?;
        let mut rest = &errors[..];
        while at < stop {
            let end = chunk_end(at, last);
            let (now, later) = rest.split_at((end - at) as usize * rows);
            let chunk = Chunk { first: at, errors: now.to_vec() };
            if let Some(state) = state {
                state.save(&chunk)?;
            }
            if !take(&chunk)? {
                return Ok(());
            }
            (at, rest) = (end, later);
        }
    }
    Ok(())
}
