//! Covariance and adjoint: any source, by the joint dynamics of navigation errors and source states.

use nalgebra::SMatrix;
use rayon::prelude::*;

use super::passage::{Sample, samples};
use super::scene::Scene;
use super::source::{Joint, Nine, ROOM, Source};
use super::stepper::{Step, Stepper};

/// Longest interval over which transitions are accumulated along a motion, s. What they leave out grows with its square: a second
/// was wrong by 1e-5 in turns of a missile.
const INTERVAL: f64 = 0.2;

/// Intervals along a motion whose samples are kept at a time.
pub const TOGETHER: usize = 64;

/// How the nine errors at the end answer to the states at an earlier time.
type Lambda = SMatrix<f64, 9, ROOM>;

/// A source on its way.
struct Walker<'a> {
    stepper: Stepper<'a>,
    p: Joint,
    rows: Vec<Nine>,
}

impl<'a> Walker<'a> {
    fn all(scene: &'a Scene<'a>, sources: &[Source]) -> Vec<Walker<'a>> {
        let new = |source: &Source| {
            let stepper = Stepper::new(scene, source);
            let p = stepper.start(source);
            Walker { stepper, p, rows: vec![nine(&p)] }
        };
        sources.iter().map(new).collect()
    }
}

/// Covariances that each source causes, one for each row of the scene: `result[source][row]`. Exact at rest; along a motion
/// transitions are accumulated sample by sample, every source its own, all under the same truth.
pub fn covariance(scene: &Scene, sources: &[Source]) -> Vec<Vec<Nine>> {
    let mut walkers = Walker::all(scene, sources);
    for some in intervals(scene).chunks(TOGETHER) {
        let seen = Seen::new(scene, some);
        walkers.par_iter_mut().for_each(|walker| {
            for [begin, end] in some {
                walker.stepper.over(*begin, *end, seen.of(*begin, *end)).apply(&mut walker.p);
                if scene.rows.binary_search(end).is_ok() {
                    walker.rows.push(nine(&walker.p));
                }
            }
        });
    }
    walkers.into_iter().map(|walker| walker.rows).collect()
}

/// The covariances of the nine errors at the last row, each by one pass backward in time: `lambda' x` at the end is carried
/// back to what a state at an earlier time does to it, and collects the process noise on its way. Along a motion transitions are
/// made again, some intervals at a time from the last on.
///
/// ```text
/// lambda_k = Phi_k' lambda_(k+1),   var = lambda_0' P_0 lambda_0 + sum of lambda_(k+1)' Q_k lambda_(k+1)
/// ```
pub fn adjoint(scene: &Scene, sources: &[Source]) -> Vec<Nine> {
    let mut walkers: Vec<(Walker, Backward)> =
        Walker::all(scene, sources).into_iter().map(|walker| (walker, Backward::new())).collect();
    for some in intervals(scene).chunks(TOGETHER).rev() {
        let seen = Seen::new(scene, some);
        let at = scene.moment(scene.time(some[0][0])).0;
        walkers.par_iter_mut().for_each(|(walker, back)| {
            walker.stepper.begin(&at);
            let over = |[begin, end]: &[u64; 2]| walker.stepper.over(*begin, *end, seen.of(*begin, *end));
            let steps: Vec<Step> = some.iter().map(over).collect();
            steps.iter().rev().for_each(|step| back.over(step));
        });
    }
    walkers.into_iter().map(|(walker, back)| back.end(&walker.p)).collect()
}

/// The samples of some intervals along a motion.
struct Seen {
    first: u64,
    samples: Vec<Sample>,
}

impl Seen {
    fn new(scene: &Scene, some: &[[u64; 2]]) -> Seen {
        let (first, end) = (some[0][0], some[some.len() - 1][1]);
        Seen { first, samples: if scene.steady { Vec::new() } else { samples(scene, first, end) } }
    }

    /// At rest there are none.
    fn of(&self, begin: u64, end: u64) -> &[Sample] {
        self.samples.get((begin - self.first) as usize..(end - self.first) as usize).unwrap_or_default()
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

    fn over(&mut self, step: &Step) {
        self.p += self.lambda * step.q() * self.lambda.transpose();
        self.lambda *= step.phi();
    }

    fn end(&self, p0: &Joint) -> Nine {
        self.p + self.lambda * p0 * self.lambda.transpose()
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

fn nine(p: &Joint) -> Nine {
    SMatrix::from_fn(|i, j| p[(i, j)])
}
