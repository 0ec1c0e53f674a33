//! Sensitivity columns: what one standard deviation of a constant does, one transition for all of them.

use nalgebra::{SMatrix, SVector};
use schuler_imu::Instrument;
use schuler_strapdown::{ErrorDynamics, Transition};

use super::alignment;
use super::scene::Scene;
use super::source::{Kind, Nine, Source};

/// Longest step along a motion over which the motion is sampled, s; at rest a step is as long as the distance of rows.
const STEP: f64 = 0.1;

/// Longest interval along a motion over which transitions are gathered before columns are moved, s.
const INTERVAL: f64 = 1.0;

/// Columns moved together.
const LANES: usize = 8;

/// The nine navigation errors of any number of columns.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// [`LANES`] columns side by side: error, column.
    blocks: Vec<[[f64; LANES]; 9]>,
    /// For each of them, what it answers to (number of a response) and how much.
    driven: Vec<[(usize, f64); LANES]>,
    len: usize,
}

impl Columns {
    /// No columns.
    pub fn new() -> Columns {
        Columns::default()
    }

    /// One more column: its errors at the start, and the number and the multiple of the response that drives it.
    pub fn push(&mut self, x0: [f64; 9], response: usize, size: f64) {
        let lane = self.len % LANES;
        if lane == 0 {
            self.blocks.push([[0.0; LANES]; 9]);
            self.driven.push([(response, 0.0); LANES]);
        }
        let Some(driven) = self.driven.last_mut() else { return };
        driven[lane] = (response, size);
        self.len += 1;
        self.set(self.len - 1, x0);
    }

    /// Number of columns.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The errors of column `k`.
    pub fn column(&self, k: usize) -> [f64; 9] {
        std::array::from_fn(|row| self.blocks[k / LANES][row][k % LANES])
    }

    /// The errors of column `k` from now on.
    pub fn set(&mut self, k: usize, x: [f64; 9]) {
        for (row, x) in self.blocks[k / LANES].iter_mut().zip(x) {
            row[k % LANES] = x;
        }
    }

    /// Moves every column over an interval: `x := phi x + size response`.
    pub fn advance(&mut self, phi: &Nine, responses: &[SVector<f64, 9>]) {
        for (block, driven) in self.blocks.iter_mut().zip(&self.driven) {
            let mut next = [[0.0; LANES]; 9];
            for (lane, (response, size)) in driven.iter().enumerate() {
                let response = &responses[*response];
                for (row, next) in next.iter_mut().enumerate() {
                    next[lane] = size * response[row];
                }
            }
            for (column, x) in block.iter().enumerate() {
                for (row, next) in next.iter_mut().enumerate() {
                    let phi = phi[(row, column)];
                    for (next, x) in next.iter_mut().zip(x) {
                        *next += phi * x;
                    }
                }
            }
            *block = next;
        }
    }
}

/// What drives constants: one coefficient of a sensor error, and what a unit of it has done since the interval began.
struct Drive<'a> {
    source: &'a Source,
    response: SVector<f64, 9>,
}

/// Columns of the constant sources of a budget, and what moves them.
pub struct Moving<'a> {
    scene: &'a Scene<'a>,
    /// The columns at the time that was reached.
    pub columns: Columns,
    /// Number of the column of each source, if it is constant.
    pub places: Vec<Option<usize>>,
    drives: Vec<Drive<'a>>,
    /// Answers to a unit over the last interval; number 0 is for what nothing drives.
    responses: Vec<SVector<f64, 9>>,
    last: Option<(u64, Transition)>,
}

impl<'a> Moving<'a> {
    /// At t = 0, after the alignment where there is one.
    pub fn new(scene: &'a Scene, sources: &'a [Source]) -> Moving<'a> {
        let law = alignment::Law::new(scene);
        let mut drives: Vec<Drive> = Vec::new();
        let mut columns = Columns::new();
        let mut places = vec![None; sources.len()];
        for (place, source) in places.iter_mut().zip(sources) {
            let (x0, number, size) = match &source.kind {
                Kind::Initial(_) => (source.initial(), 0, 0.0),
                Kind::Noise(_) => continue,
                Kind::Sensor(component) => {
                    let Some(size) = source.size().filter(|size| size.rate == 0.0) else { continue };
                    let same = |d: &Drive| match &d.source.kind {
                        Kind::Sensor(known) => {
                            known.instrument() == component.instrument()
                                && known.term().name() == component.term().name()
                                && known.coefficient() == component.coefficient()
                        }
                        _ => false,
                    };
                    let number = drives.iter().position(same).unwrap_or_else(|| {
                        drives.push(Drive { source, response: SVector::zeros() });
                        drives.len() - 1
                    });
                    (aligned(scene, &law, source, size.value), 1 + number, size.value)
                }
            };
            *place = Some(columns.len());
            columns.push(x0, number, size);
        }
        let responses = vec![SVector::zeros(); 1 + drives.len()];
        Moving { scene, columns, places, drives, responses, last: None }
    }

    /// On from sample `begin` to `end`.
    pub fn over(&mut self, begin: u64, end: u64) {
        let scene = self.scene;
        let longest = if scene.steady { u64::MAX } else { ((STEP / scene.dt + 1e-9) as u64).max(1) };
        let mut phi = Nine::identity();
        let mut sample = begin;
        while sample < end {
            let count = longest.min(end - sample);
            let known = self.last.filter(|(c, _)| scene.steady && *c == count);
            let moved = known.map_or_else(|| transition(scene, sample, count), |(_, moved)| moved);
            self.last = Some((count, moved));
            phi = nine(&moved) * phi;
            let (seen, dt) = (scene.seen(sample, count), scene.time(count));
            for drive in &mut self.drives {
                let pushed = scene.regressor(drive.source, &seen, dt);
                drive.response = nine(&moved) * drive.response + push(&moved, pushed);
            }
            sample += count;
        }
        for (response, drive) in self.responses[1..].iter_mut().zip(&mut self.drives) {
            *response = std::mem::take(&mut drive.response);
        }
        self.columns.advance(&phi, &self.responses);
    }
}

/// Errors of one standard deviation of each source at each row, `result[source][row]`; empty for sources that are not
/// constant. With sign: the source is positive.
pub fn responses(scene: &Scene, sources: &[Source]) -> Vec<Vec<[f64; 9]>> {
    let mut moving = Moving::new(scene, sources);
    let mut result: Vec<Vec<[f64; 9]>> = vec![Vec::new(); sources.len()];
    let mut keep = |moving: &Moving| {
        for (rows, place) in result.iter_mut().zip(&moving.places) {
            rows.extend(place.map(|k| moving.columns.column(k)));
        }
    };
    keep(&moving);
    let interval = if scene.steady { u64::MAX } else { ((INTERVAL / scene.dt + 1e-9) as u64).max(1) };
    for pair in scene.rows.windows(2) {
        let mut sample = pair[0];
        while sample < pair[1] {
            let end = pair[1].min(sample.saturating_add(interval));
            moving.over(sample, end);
            sample = end;
        }
        keep(&moving);
    }
    result
}

/// The covariance of a response of one standard deviation.
pub fn covariance(x: &[f64; 9]) -> Nine {
    let x = SMatrix::<f64, 9, 1>::from(*x);
    x * x.transpose()
}

/// The errors after the alignment by a coefficient of this value, zero without.
fn aligned(scene: &Scene, law: &alignment::Law, source: &Source, value: f64) -> [f64; 9] {
    let mut x = [0.0; 9];
    if scene.study.alignment > 0
        && let Some((instrument, column)) = scene.regressor(source, &scene.at_rest(scene.dt), scene.dt)
    {
        x[6..].copy_from_slice(&law.phi(instrument, column.map(|c| c * value)));
    }
    x
}

/// The nine errors of a transition; its tenth is of a loop that no budget has.
fn nine(step: &Transition) -> Nine {
    step.phi.fixed_view::<9, 9>(0, 0).into_owned()
}

/// What a sensor error does over a step.
fn push(step: &Transition, error: Option<(Instrument, [f64; 3])>) -> SVector<f64, 9> {
    let Some((instrument, column)) = error else { return SVector::zeros() };
    let first = match instrument {
        Instrument::Gyro => 0,
        Instrument::Accel => 3,
    };
    step.gamma.fixed_view::<9, 3>(0, first) * SVector::<f64, 3>::from(column)
}

fn transition(scene: &Scene, sample: u64, count: u64) -> Transition {
    let (t, dt) = (scene.time(sample), scene.time(count));
    let [a, b] = ErrorDynamics::NODES.map(|node| scene.moment(t + node * dt));
    scene.dynamics().transition([(&a.0, a.1), (&b.0, b.1)], dt)
}
