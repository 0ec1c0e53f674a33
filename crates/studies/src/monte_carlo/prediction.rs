//! What linear theory predicts of all runs together: mean and covariance of their errors at each row.

use nalgebra::{SMatrix, SVector};
use schuler_frames::Vec3;
use schuler_imu::Motion;
use schuler_strapdown::Increments;
use schuler_strapdown::filter::{Accumulator, Form, Model, NavStates, Propagation};

use super::scene::Scene;
use crate::scenario::Vertical;

/// Longest interval over which transitions are accumulated along a motion, s.
const INTERVAL: f64 = 1.0;

/// Mean and covariance of the nine errors at one row.
#[derive(Clone, Debug)]
pub struct Predicted {
    /// Of fixed values; zero where everything is drawn about zero.
    pub mean: SVector<f64, 9>,
    /// About the mean.
    pub p: SMatrix<f64, 9, 9>,
}

impl Predicted {
    /// Standard deviation of error `k`, or from 9 on the root of both horizontal variances.
    pub fn sd(&self, k: usize) -> f64 {
        if k < 9 { self.p[(k, k)].max(0.0).sqrt() } else { self.sd(0).hypot(self.sd(1)) }
    }

    /// Mean of error `k`, or from 9 on the length of the horizontal mean.
    pub fn mean(&self, k: usize) -> f64 {
        if k < 9 { self.mean[k] } else { self.mean[0].hypot(self.mean[1]) }
    }

    /// Root of the mean square.
    pub fn rms(&self, k: usize) -> f64 {
        self.mean(k).hypot(self.sd(k))
    }
}

/// Mean and covariance at each row of the scene, from the joint dynamics of the navigation errors and the states of all error
/// sources: exact at rest, accumulated sample by sample along a motion.
///
/// # Errors
/// A sentence (without its full stop) that says why there is none.
pub fn prediction(scene: &Scene) -> Result<Vec<Predicted>, String> {
    if let Vertical::Damped(damping) = scene.study.mechanization.vertical
        && damping.order != 2
    {
        return Err(
            "no covariance is predicted for a third-order vertical loop, which has a state of its own".into(),
        );
    }
    // As small as holds them: what is not used costs room on the stack. No more widths, each of which is compiled by itself.
    sized::<24>(scene)
        .or_else(|| sized::<64>(scene))
        .or_else(|| sized::<192>(scene))
        .ok_or_else(|| "no covariance is predicted: the error sources have more than 183 states".into())
}

fn sized<const N: usize>(scene: &Scene) -> Option<Vec<Predicted>> {
    let model = Model::<N>::new(Form::Phi, NavStates::ALL, &scene.study.imu.spec).ok()?;
    Some(if scene.steady { at_rest(scene, &model) } else { along(scene, &model) })
}

/// State of the prediction.
struct Moments<const N: usize> {
    x: SVector<f64, N>,
    p: Box<SMatrix<f64, N, N>>,
}

impl<const N: usize> Moments<N> {
    fn start(scene: &Scene, model: &Model<N>) -> Self {
        let p =
            model.p0(&scene.initial_sigmas()).expect("invariant: standard deviations of a valid scenario");
        Moments { x: model.x0(), p: Box::new(p) }
    }

    fn carry(&mut self, step: &Propagation<N>) {
        step.carry(&mut self.x);
        step.transport(&mut self.p);
        step.diffuse(&mut self.p);
    }

    fn row(&self) -> Predicted {
        Predicted { mean: SVector::from_fn(|i, _| self.x[i]), p: SMatrix::from_fn(|i, j| self.p[(i, j)]) }
    }
}

fn at_rest<const N: usize>(scene: &Scene, model: &Model<N>) -> Vec<Predicted> {
    let moment = scene.truth.moment(0.0);
    let system = Form::Phi.system(&scene.dynamics(), &moment.pva, moment.f_b);
    let mut steps: Vec<(u64, Box<Propagation<N>>)> = Vec::new();
    let mut moments = Moments::start(scene, model);
    let mut rows = vec![moments.row()];
    for pair in scene.rows.windows(2) {
        let count = pair[1] - pair[0];
        if !steps.iter().any(|(c, _)| *c == count) {
            let seen = scene.seen(0, count);
            steps.push((count, Box::new(Propagation::exact(model, &system, &seen, scene.time(count)))));
        }
        let step = steps.iter().find(|(c, _)| *c == count);
        moments.carry(&step.expect("invariant: made for each distance of rows").1);
        rows.push(moments.row());
    }
    rows
}

fn along<const N: usize>(scene: &Scene, model: &Model<N>) -> Vec<Predicted> {
    let mut accumulator = Box::new(Accumulator::new(model, scene.dynamics(), &scene.states[0]));
    let mut moments = Moments::start(scene, model);
    let mut rows = vec![moments.row()];
    let longest = ((INTERVAL / scene.dt + 1e-9) as u64).max(1);
    for pair in scene.rows.windows(2) {
        let mut sample = pair[0];
        while sample < pair[1] {
            let end = pair[1].min(sample + longest);
            for k in sample..end {
                let seen = scene.seen(k, 1);
                let pva = scene.truth.moment(scene.time(k + 1)).pva;
                accumulator.step_seen(model, &pva, &seen, &increments(&seen, scene.dt), scene.dt);
            }
            moments.carry(&accumulator.close(model));
            sample = end;
        }
        rows.push(moments.row());
    }
    rows
}

/// The true motion of one sample as increments.
fn increments(seen: &schuler_imu::Truth, dt: f64) -> Increments {
    let (dtheta, dv) = match seen.motion {
        Motion::Increments { dtheta, dv } => (dtheta, dv),
        Motion::Rates { omega, f } => (omega.map(|x| x * dt), f.map(|x| x * dt)),
    };
    Increments { dtheta: Vec3::claim(dtheta), dv: Vec3::claim(dv) }
}
