//! Covariance and adjoint: any source, by the joint dynamics of navigation errors and source states.

use nalgebra::SMatrix;
use rayon::prelude::*;
use schuler_strapdown::Pva;
use schuler_strapdown::filter::{Accumulator, Form, Propagation};

use super::passage::{Sample, samples};
use super::scene::Scene;
use super::source::{Joined, Joint, Nine, ROOM, Source};

/// Longest interval over which transitions are accumulated along a motion, s. What they leave out grows with its square: a second
/// was wrong by 1e-5 in turns of a missile.
const INTERVAL: f64 = 0.2;

/// Intervals along a motion whose samples are kept at a time.
pub const TOGETHER: usize = 64;

/// How the nine errors at the end answer to the states at an earlier time.
type Lambda = SMatrix<f64, 9, ROOM>;

/// Covariances that each source causes, one for each row of the scene: `result[source][row]`.
pub fn covariance(scene: &Scene, sources: &[Source]) -> Vec<Vec<Nine>> {
    if scene.steady {
        sources.par_iter().map(|source| Steady::new(scene, source).forward(scene)).collect()
    } else {
        along(scene, sources)
    }
}

/// The covariances of the nine errors at the last row, each by one pass backward in time: `lambda' x` at the end is carried
/// back to what a state at an earlier time does to it, and collects the process noise on its way.
///
/// ```text
/// lambda_k = Phi_k' lambda_(k+1),   var = lambda_0' P_0 lambda_0 + sum of lambda_(k+1)' Q_k lambda_(k+1)
/// ```
pub fn adjoint(scene: &Scene, sources: &[Source]) -> Vec<Nine> {
    if scene.steady {
        sources.par_iter().map(|source| Steady::new(scene, source).backward(scene)).collect()
    } else {
        back(scene, sources)
    }
}

/// A pass backward.
struct Backward {
    lambda: Lambda,
    p: Nine,
}

impl Backward {
    fn new() -> Backward {
        Backward { lambda: Lambda::identity(), p: Nine::zeros() }
    }

    fn over(&mut self, step: &Propagation<ROOM>) {
        self.p += self.lambda * step.q() * self.lambda.transpose();
        self.lambda *= step.phi();
    }

    fn end(&self, p0: &Joint) -> Nine {
        self.p + self.lambda * p0 * self.lambda.transpose()
    }
}

/// A source at rest: dynamics that stay as they are, discretised exactly over any interval.
struct Steady {
    p0: Joint,
    /// Number of samples and what they do.
    steps: Vec<(u64, Propagation<ROOM>)>,
}

impl Steady {
    fn new(scene: &Scene, source: &Source) -> Steady {
        let model = source.model(&scene.study.imu.spec);
        let (pva, f_b) = scene.moment(0.0);
        let system = Form::Phi.system(&scene.dynamics(), &pva, f_b);
        let mut steps: Vec<(u64, _)> = Vec::new();
        for pair in scene.rows.windows(2) {
            let count = pair[1] - pair[0];
            if !steps.iter().any(|(c, _)| *c == count) {
                let seen = scene.seen(0, count);
                steps.push((count, Propagation::exact(&model, &system, &seen, scene.time(count))));
            }
        }
        Steady { p0: source.start(scene, &model), steps }
    }

    fn step(&self, count: u64) -> &Propagation<ROOM> {
        let known = self.steps.iter().find(|(c, _)| *c == count);
        &known.expect("invariant: made for each distance of rows").1
    }

    fn forward(&self, scene: &Scene) -> Vec<Nine> {
        let mut p = self.p0;
        let mut rows = vec![nine(&p)];
        for pair in scene.rows.windows(2) {
            let step = self.step(pair[1] - pair[0]);
            step.transport(&mut p);
            step.diffuse(&mut p);
            rows.push(nine(&p));
        }
        rows
    }

    fn backward(&self, scene: &Scene) -> Nine {
        let mut back = Backward::new();
        for pair in scene.rows.windows(2).rev() {
            back.over(self.step(pair[1] - pair[0]));
        }
        back.end(&self.p0)
    }
}

/// Begin and end of the intervals, in samples: each ends at a row or, along a motion, after [`INTERVAL`].
pub fn intervals(scene: &Scene) -> Vec<[u64; 2]> {
    let longest = longest(scene);
    let between = |pair: &[u64]| {
        let (begin, end) = (pair[0], pair[1]);
        (begin..end)
            .step_by(usize::try_from(longest).unwrap_or(usize::MAX))
            .map(move |k| [k, end.min(k.saturating_add(longest))])
    };
    scene.rows.windows(2).flat_map(between).collect()
}

/// Samples of the longest interval.
pub fn longest(scene: &Scene) -> u64 {
    if scene.steady { u64::MAX } else { ((INTERVAL / scene.dt + 1e-9) as u64).max(1) }
}

/// One source on its way along a motion.
struct Walker {
    model: Joined,
    accumulator: Accumulator<ROOM>,
    p: Joint,
    rows: Vec<Nine>,
}

impl Walker {
    fn new(scene: &Scene, source: &Source, at: &Pva) -> Walker {
        let model = source.model(&scene.study.imu.spec);
        let accumulator = Accumulator::new(&model, scene.dynamics(), at);
        let p = source.start(scene, &model);
        Walker { model, accumulator, p, rows: vec![nine(&p)] }
    }

    fn step(&mut self, samples: &[Sample], dt: f64) -> Propagation<ROOM> {
        for Sample { pva, seen, increments, .. } in samples {
            self.accumulator.step_seen(&self.model, pva, seen, increments, dt);
        }
        self.accumulator.close(&self.model)
    }
}

/// Along any motion: transitions accumulated sample by sample, every source its own, all under the same truth.
fn along(scene: &Scene, sources: &[Source]) -> Vec<Vec<Nine>> {
    let start = scene.moment(0.0).0;
    let mut walkers: Vec<Walker> = sources.iter().map(|source| Walker::new(scene, source, &start)).collect();
    let intervals = intervals(scene);
    for some in intervals.chunks(TOGETHER) {
        let (first, end) = (some[0][0], some[some.len() - 1][1]);
        let samples = samples(scene, first, end);
        walkers.par_iter_mut().for_each(|walker| {
            for [begin, end] in some {
                let step = walker.step(&samples[(begin - first) as usize..(end - first) as usize], scene.dt);
                step.transport(&mut walker.p);
                step.diffuse(&mut walker.p);
                if scene.rows.binary_search(end).is_ok() {
                    walker.rows.push(nine(&walker.p));
                }
            }
        });
    }
    walkers.into_iter().map(|walker| walker.rows).collect()
}

/// Along any motion backward: transitions are made again, some intervals at a time from the last on.
fn back(scene: &Scene, sources: &[Source]) -> Vec<Nine> {
    let start = scene.moment(0.0).0;
    let mut walkers: Vec<(Walker, Backward)> =
        sources.iter().map(|source| (Walker::new(scene, source, &start), Backward::new())).collect();
    let intervals = intervals(scene);
    for some in intervals.chunks(TOGETHER).rev() {
        let (first, end) = (some[0][0], some[some.len() - 1][1]);
        let samples = samples(scene, first, end);
        let at = scene.moment(scene.time(first)).0;
        walkers.par_iter_mut().for_each(|(walker, back)| {
            walker.accumulator.begin(&walker.model, &at);
            let steps: Vec<Propagation<ROOM>> = some
                .iter()
                .map(|[begin, end]| {
                    walker.step(&samples[(begin - first) as usize..(end - first) as usize], scene.dt)
                })
                .collect();
            steps.iter().rev().for_each(|step| back.over(step));
        });
    }
    walkers.into_iter().map(|(walker, back)| back.end(&walker.p)).collect()
}

fn nine(p: &Joint) -> Nine {
    SMatrix::from_fn(|i, j| p[(i, j)])
}
