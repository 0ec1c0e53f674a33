//! The motion of the runs and their rows of time.

use schuler_imu::Truth as Seen;
use schuler_strapdown::{ErrorDynamics, Pva, Vertical};

use crate::{
    Scenario, channel,
    scenario::{MonteCarlo, Motion, Temperature},
    trajectory::Truth,
};

/// What all runs share.
pub struct Scene<'a> {
    /// The study.
    pub study: &'a MonteCarlo,
    /// Master seed.
    pub seed: u64,
    /// The motion.
    pub truth: Truth,
    /// The vertical channel of the navigator.
    pub vertical: Vertical,
    /// Sample interval, s.
    pub dt: f64,
    /// Numbers of samples after which there is a row, the first 0.
    pub rows: Vec<u64>,
    /// What is true at each row.
    pub states: Vec<Pva>,
    /// At rest, under one temperature: every sample sees the same.
    pub steady: bool,
}

impl<'a> Scene<'a> {
    /// The scene of a valid study, with the rows that its scenario asks for.
    pub fn new(scenario: &Scenario, study: &'a MonteCarlo) -> Scene<'a> {
        let stride =
            scenario.output.every.map_or(1, |every| (every * study.imu.rate).round().max(1.0) as u64);
        Scene::with_stride(study, scenario.seed, stride)
    }

    /// The same with a row every `stride` samples and at the end.
    pub fn with_stride(study: &'a MonteCarlo, seed: u64, stride: u64) -> Scene<'a> {
        let mut rows: Vec<u64> = (0..=study.samples / stride).map(|k| k * stride).collect();
        if !study.samples.is_multiple_of(stride) {
            rows.push(study.samples);
        }
        let dt = 1.0 / study.imu.rate;
        let gravity = study.mechanization.gravity;
        let trajectory = study.motion.trajectory(&study.start, gravity, study.samples, dt);
        let trajectory = trajectory.ok().flatten().expect(
            "invariant: the motion of a valid scenario is possible, and neither zero truth nor a file",
        );
        let truth = Truth::boxed(trajectory, gravity);
        let states = rows.iter().map(|&k| truth.moment(k as f64 * dt).pva).collect();
        Scene {
            study,
            seed,
            truth,
            vertical: channel::vertical(&study.mechanization, study.start.position),
            dt,
            rows,
            states,
            steady: matches!(study.motion, Motion::Static)
                && matches!(study.imu.temperature, None | Some(Temperature::Constant(_))),
        }
    }

    /// Time of a sample, s.
    pub fn time(&self, sample: u64) -> f64 {
        sample as f64 * self.dt
    }

    /// What the sensors go through during `count` samples from the one of number `sample`, as one interval.
    pub fn seen(&self, sample: u64, count: u64) -> Seen {
        let (t, dt) = (self.time(sample), count as f64 * self.dt);
        let seen = self.truth.imu_truth(t, dt);
        match &self.study.imu.temperature {
            None => seen,
            Some(temperature) => seen.at_temperature(&temperature.profile(), t, dt),
        }
    }

    /// Error dynamics of the navigator.
    pub fn dynamics(&self) -> ErrorDynamics {
        ErrorDynamics { gravity: self.study.mechanization.gravity, vertical: self.vertical }
    }

    /// Standard deviations of the nine initial errors.
    pub fn initial_sigmas(&self) -> [f64; 9] {
        let mut sum = [0.0f64; 9];
        for initial in &self.study.initial_sigmas {
            let all = [initial.position, initial.velocity, initial.phi];
            for (k, sum) in sum.iter_mut().enumerate() {
                *sum = sum.hypot(all[k / 3][k % 3]);
            }
        }
        sum
    }
}
