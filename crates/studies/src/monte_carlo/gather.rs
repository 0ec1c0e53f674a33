//! From runs, made or kept, to their statistics.

use std::time::{Duration, Instant};

use super::{
    prediction::{Predicted, prediction},
    runs::{Chunk, runs, units},
    scene::Scene,
    state::State,
    statistics::Statistics,
    store::Digest,
};
use crate::{Error, Progress, Record, Scenario, scenario::Until};

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
                // Of what does not move, nothing becomes known by more runs.
                self.done = found.value > 0.0 && found.high - found.low <= 2.0 * until.relative * found.value;
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

/// The runs `first..last` in their order, some at a time: those that `state` has from there, the others made and kept there. Ends
/// early when `take` wants no more.
pub fn each_chunk(
    scene: &Scene,
    first: u64,
    last: u64,
    state: Option<&State>,
    progress: &dyn Progress,
    mut take: impl FnMut(&Chunk) -> Result<bool, Error>,
) -> Result<(), Error> {
    let known = state.map_or(Ok(Vec::new()), State::ranges)?;
    let kept = |at: u64| known.iter().find(|range| range.start == at && range.end <= last).cloned();
    let next =
        |at: u64| known.iter().map(|range| range.start).filter(|start| *start > at).min().unwrap_or(last);
    let (mut at, mut missing) = (first, 0);
    while at < last {
        let end = kept(at).map_or(next(at).min(last), |range| range.end);
        missing += if kept(at).is_some() { 0 } else { end - at };
        at = end;
    }
    progress.begin("runs", units(scene) * missing);
    // Together as many as keep all threads busy; the motion is calculated once for them.
    let together = 128.max(32 * rayon::current_num_threads() as u64);
    let mut keeper = Keeper::new(state, scene.rows.len());
    at = first;
    while at < last {
        let there = kept(at).and_then(|range| state?.load(&range));
        let chunk = match there {
            Some(chunk) => {
                keeper.keep()?;
                chunk
            }
            None => {
                let made = runs(scene, at, last.min(at + together).min(next(at)), progress)?;
                keeper.take(&made)?;
                made
            }
        };
        at += (chunk.errors.len() / scene.rows.len()) as u64;
        if !take(&chunk)? {
            return Ok(());
        }
    }
    keeper.keep()
}

/// Runs that are made and not yet kept. Waiting for the disk shall not cost more than a fifth of the time.
struct Keeper<'a> {
    state: Option<&'a State>,
    rows: usize,
    pending: Option<Chunk>,
    since: Instant,
    cost: Duration,
}

impl<'a> Keeper<'a> {
    /// Errors that are in memory at most, before more come.
    const MOST: usize = 1 << 16;
    /// Shortest time between files.
    const SHORTEST: Duration = Duration::from_millis(100);

    fn new(state: Option<&'a State>, rows: usize) -> Self {
        Keeper { state, rows, pending: None, since: Instant::now(), cost: Duration::ZERO }
    }

    /// Takes the next runs, and keeps them when it is time.
    fn take(&mut self, chunk: &Chunk) -> Result<(), Error> {
        if self.state.is_none() {
            return Ok(());
        }
        match &mut self.pending {
            None => self.pending = Some(chunk.clone()),
            Some(pending) => pending.errors.extend_from_slice(&chunk.errors),
        }
        let many = self.pending.as_ref().is_some_and(|pending| pending.errors.len() > Self::MOST);
        if many || self.since.elapsed() > Self::SHORTEST.max(4 * self.cost) { self.keep() } else { Ok(()) }
    }

    /// Keeps what there is.
    fn keep(&mut self) -> Result<(), Error> {
        if let (Some(state), Some(chunk)) = (self.state, self.pending.take()) {
            let begin = Instant::now();
            state.save(&chunk, self.rows)?;
            self.cost = begin.elapsed();
            self.since = Instant::now();
        }
        Ok(())
    }
}
