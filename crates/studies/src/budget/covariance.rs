//! Covariance and adjoint: any source, by the joint dynamics of navigation errors and source states.

use nalgebra::SMatrix;
use rayon::prelude::*;
use schuler_frames::Vec3;
use schuler_imu::Motion;
use schuler_strapdown::filter::{Accumulator, Form, Propagation};
use schuler_strapdown::{Increments, Pva};

use super::scene::Scene;
use super::source::{Joined, Joint, Nine, ROOM, Source};

/// Longest interval over which transitions are accumulated along a motion, s.
const INTERVAL: f64 = 1.0;

/// Covariances that each source causes, one for each row of the scene: `result[source][row]`.
pub fn covariance(scene: &Scene, sources: &[Source]) -> Vec<Vec<Nine>> {
    if scene.steady {
        sources.par_iter().map(|source| Steady::new(scene, source).forward(scene)).collect()
    } else {
        along(scene, sources)
    }
}

/// The variances of the nine errors at the last row, each by one pass backward in time: `lambda' x` at the end is carried back
/// to what a state at an earlier time does to it, and collects the process noise on its way.
///
/// ```text
/// lambda_k = Phi_k' lambda_(k+1),   var = lambda_0' P_0 lambda_0 + sum of lambda_(k+1)' Q_k lambda_(k+1)
/// ```
///
/// At rest only.
pub fn adjoint(scene: &Scene, source: &Source) -> Nine {
    let steady = Steady::new(scene, source);
    let mut lambda = SMatrix::<f64, 9, ROOM>::identity();
    let mut p = Nine::zeros();
    for pair in scene.rows.windows(2).rev() {
        let step = steady.step(pair[1] - pair[0]);
        p += lambda * step.q() * lambda.transpose();
        lambda *= step.phi();
    }
    p + lambda * steady.p0 * lambda.transpose()
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
        Steady { p0: source.start(&model), steps }
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
}

/// One source on its way along a motion.
struct Walker {
    model: Joined,
    accumulator: Accumulator<ROOM>,
    p: Joint,
    rows: Vec<Nine>,
}

/// Along any motion: transitions accumulated sample by sample, every source its own, all under the same truth.
fn along(scene: &Scene, sources: &[Source]) -> Vec<Vec<Nine>> {
    let start = scene.moment(0.0).0;
    let mut walkers: Vec<Walker> = sources
        .iter()
        .map(|source| {
            let model = source.model(&scene.study.imu.spec);
            let accumulator = Accumulator::new(&model, scene.dynamics(), &start);
            let p = source.start(&model);
            Walker { model, accumulator, p, rows: vec![nine(&p)] }
        })
        .collect();
    let longest = ((INTERVAL / scene.dt + 1e-9) as u64).max(1);
    for pair in scene.rows.windows(2) {
        let mut sample = pair[0];
        while sample < pair[1] {
            let end = pair[1].min(sample + longest);
            let steps: Vec<(Pva, schuler_imu::Truth, Increments)> = (sample..end)
                .map(|k| {
                    let seen = scene.seen(k, 1);
                    (scene.moment(scene.time(k + 1)).0, seen, increments(&seen, scene.dt))
                })
                .collect();
            walkers.par_iter_mut().for_each(|walker| {
                let Walker { model, accumulator, p, .. } = walker;
                for (pva, seen, increments) in &steps {
                    accumulator.step_seen(model, pva, seen, increments, scene.dt);
                }
                let step = accumulator.close(model);
                step.transport(p);
                step.diffuse(p);
            });
            sample = end;
        }
        for walker in &mut walkers {
            walker.rows.push(nine(&walker.p));
        }
    }
    walkers.into_iter().map(|walker| walker.rows).collect()
}

/// The true motion of one sample as increments.
pub fn increments(seen: &schuler_imu::Truth, dt: f64) -> Increments {
    let (dtheta, dv) = match seen.motion {
        Motion::Increments { dtheta, dv } => (dtheta, dv),
        Motion::Rates { omega, f } => (omega.map(|x| x * dt), f.map(|x| x * dt)),
    };
    Increments { dtheta: Vec3::claim(dtheta), dv: Vec3::claim(dv) }
}

fn nine(p: &Joint) -> Nine {
    SMatrix::from_fn(|i, j| p[(i, j)])
}
