//! From runs, made or kept, to their statistics.

use std::{
    ops::Range,
    time::{Duration, Instant},
};

use super::{
    prediction::Predicted,
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
    /// Nothing yet, beside what is predicted.
    pub fn new(scene: &'a Scene<'a>, predicted: Result<Vec<Predicted>, String>) -> Gathered<'a> {
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
        let rows = self.scene.rows.len();
        let (mut first, mut rest) = (chunk.first, &chunk.errors[..]);
        while !self.done && !rest.is_empty() {
            // As far as the next number of runs at which `until` is looked at.
            let known = self.statistics.runs;
            let all = (rest.len() / rows) as u64;
            let count = (1..all).find(|k| self.until.is_some() && is_milestone(known + k)).unwrap_or(all);
            let (now, later) = rest.split_at(count as usize * rows);
            self.statistics.add(now);
            now.chunks_exact(rows).zip(first..).for_each(|(errors, run)| self.digest.add(run, errors));
            if let Some((until, row)) = self.until
                && is_milestone(self.statistics.runs)
            {
                let found = self.statistics.figure(row, until.quantity, until.figure);
                // Of what does not move, nothing becomes known by more runs.
                self.done = found.value > 0.0 && found.high - found.low <= 2.0 * until.relative * found.value;
            }
            (first, rest) = (first + count, later);
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

/// The runs `first..last` in their order, some at a time: those that `state` has from there, the others made and kept there.
pub struct Chunks<'a> {
    scene: &'a Scene<'a>,
    state: Option<&'a State>,
    progress: &'a dyn Progress,
    known: Vec<Range<u64>>,
    keeper: Keeper<'a>,
    at: u64,
    last: u64,
}

impl<'a> Chunks<'a> {
    /// Before the first of them.
    ///
    /// # Errors
    /// What is in `state` cannot be found out.
    pub fn new(
        scene: &'a Scene<'a>,
        runs: Range<u64>,
        state: Option<&'a State>,
        progress: &'a dyn Progress,
    ) -> Result<Chunks<'a>, Error> {
        let known = state.map_or(Ok(Vec::new()), State::ranges)?;
        let keeper = Keeper::new(state, scene.rows.len());
        let chunks = Chunks { scene, state, progress, known, keeper, at: runs.start, last: runs.end };
        let (mut at, mut missing) = (runs.start, 0);
        while at < runs.end {
            let kept = chunks.kept(at);
            let end = kept.as_ref().map_or(chunks.next_known(at), |range| range.end);
            missing += if kept.is_some() { 0 } else { end - at };
            at = end;
        }
        progress.begin("runs", units(scene) * missing);
        Ok(chunks)
    }

    /// The file of the runs from `at` on.
    fn kept(&self, at: u64) -> Option<Range<u64>> {
        self.known.iter().find(|range| range.start == at && range.end <= self.last).cloned()
    }

    /// Where the runs of the next file begin.
    fn next_known(&self, at: u64) -> u64 {
        let starts = self.known.iter().map(|range| range.start).filter(|start| *start > at);
        starts.min().unwrap_or(self.last).min(self.last)
    }

    /// The next runs; after the last, when all are kept, none.
    ///
    /// # Errors
    /// A run without numbers; an IMU that refuses its list; runs cannot be kept.
    pub fn next(&mut self) -> Result<Option<Chunk>, Error> {
        if self.at >= self.last {
            self.keeper.keep()?;
            return Ok(None);
        }
        let there = self.kept(self.at).and_then(|range| self.state?.load(&range));
        let chunk = match there {
            Some(chunk) => {
                self.keeper.keep()?;
                chunk
            }
            None => {
                // Together as many as keep all threads busy; the motion is calculated once for them.
                let together = 128.max(32 * rayon::current_num_threads() as u64);
                let end = (self.at + together).min(self.next_known(self.at));
                let made = runs(self.scene, self.at, end, self.progress)?;
                self.keeper.take(&made)?;
                made
            }
        };
        self.at += (chunk.errors.len() / self.scene.rows.len()) as u64;
        Ok(Some(chunk))
    }
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
