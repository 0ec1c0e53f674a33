//! Sensitivity columns: what one standard deviation of a constant does, one transition for all of them.

use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use schuler_imu::Component;

use super::alignment;
use super::covariance::{TOGETHER, intervals};
use super::passage::{Drive, Passage, Passages, samples};
use super::scene::Scene;
use super::source::{Kind, Nine, Source};

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

/// Columns of the constant sources of a budget at their start, and what drives them.
pub struct Constants {
    /// The columns; each is driven by number 0 (nothing) or by that of a drive and one.
    pub columns: Columns,
    /// Number of the column of each source, if it is constant.
    pub places: Vec<Option<usize>>,
    /// Coefficients that differ.
    pub drives: Vec<Drive>,
}

impl Constants {
    /// At t = 0, after the alignment where there is one.
    pub fn new(scene: &Scene, sources: &[Source]) -> Constants {
        let law = alignment::Law::new(scene);
        let mut known: Vec<&Component> = Vec::new();
        let mut columns = Columns::new();
        let mut places = vec![None; sources.len()];
        for (place, source) in places.iter_mut().zip(sources) {
            let (x0, number, size) = match &source.kind {
                Kind::Initial(_) => (source.initial(), 0, 0.0),
                Kind::Noise(_) => continue,
                Kind::Sensor(component) => {
                    let Some(size) = source.size().filter(|size| size.rate == 0.0) else { continue };
                    let same = |known: &&Component| {
                        known.instrument() == component.instrument()
                            && known.term().name() == component.term().name()
                            && known.coefficient() == component.coefficient()
                    };
                    let number = known.iter().position(same).unwrap_or_else(|| {
                        known.push(component);
                        known.len() - 1
                    });
                    (aligned(scene, &law, source, size.value), 1 + number, size.value)
                }
            };
            *place = Some(columns.len());
            columns.push(x0, number, size);
        }
        let spec = &scene.study.imu.spec;
        let drives = known.into_iter().map(|component| Drive::of_truth(*component, spec)).collect();
        Constants { columns, places, drives }
    }

    /// Moves all columns by a transition and by what the drives have done.
    pub fn advance(&mut self, phi: &Nine, responses: &[SVector<f64, 9>]) {
        let none = std::iter::once(SVector::zeros());
        let numbered: Vec<_> = none.chain(responses.iter().copied()).collect();
        self.columns.advance(phi, &numbered);
    }

    /// Adds the columns as they are to the rows of their sources.
    pub fn keep(&self, rows: &mut [Vec<[f64; 9]>]) {
        for (rows, place) in rows.iter_mut().zip(&self.places) {
            rows.extend(place.map(|k| self.columns.column(k)));
        }
    }
}

/// Errors of one standard deviation of each source at each row, `result[source][row]`; empty for sources that are not
/// constant. With sign: the source is positive.
pub fn responses(scene: &Scene, sources: &[Source]) -> Vec<Vec<[f64; 9]>> {
    let mut constants = Constants::new(scene, sources);
    let mut passages = Passages::new(scene, constants.drives.clone());
    let mut result: Vec<Vec<[f64; 9]>> = vec![Vec::new(); sources.len()];
    constants.keep(&mut result);
    let intervals = intervals(scene);
    for some in intervals.chunks(TOGETHER) {
        let passed: Vec<Passage> = if scene.steady {
            some.iter().map(|[begin, end]| passages.pass(*begin, *end, &[])).collect()
        } else {
            let along = |[begin, end]: &[u64; 2]| passages.along(*begin, &samples(scene, *begin, *end));
            some.par_iter().map(along).collect()
        };
        for ([_, end], passage) in some.iter().zip(passed) {
            constants.advance(&passage.phi, &passage.responses);
            if scene.rows.binary_search(end).is_ok() {
                constants.keep(&mut result);
            }
        }
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
