//! The motion of a budget and its rows of time.

use schuler_frames::{B, Vec3};
use schuler_imu::Truth as Seen;
use schuler_strapdown::{ErrorDynamics, Pva, Vertical};

use crate::{
    channel,
    scenario::{Budget, Motion},
    trajectory::Truth,
};

/// What all ways of a budget share.
pub struct Scene<'a> {
    pub study: &'a Budget,
    /// The motion.
    pub truth: Truth,
    /// The vertical channel of the navigator.
    pub vertical: Vertical,
    /// Sample interval, s.
    pub dt: f64,
    /// Numbers of samples after which there is a row, the first 0.
    pub rows: Vec<u64>,
    /// At rest, under one temperature: every sample sees the same.
    pub steady: bool,
}

impl<'a> Scene<'a> {
    /// The scene of a valid study with rows every `every` seconds.
    pub fn new(study: &'a Budget, every: Option<f64>) -> Scene<'a> {
        let dt = 1.0 / study.imu.rate;
        let gravity = study.mechanization.gravity;
        let trajectory = study.motion.trajectory(&study.start, gravity, study.samples, dt);
        let trajectory = trajectory.ok().flatten().expect(
            "invariant: the motion of a valid scenario is possible, and neither zero truth nor a file",
        );
        let stride = every.map_or(1, |every| (every / dt).round().max(1.0) as u64);
        let mut rows: Vec<u64> = (0..=study.samples / stride).map(|k| k * stride).collect();
        if !study.samples.is_multiple_of(stride) {
            rows.push(study.samples);
        }
        let temperature = &study.imu.temperature;
        Scene {
            study,
            truth: Truth::boxed(trajectory, gravity),
            vertical: channel::vertical(&study.mechanization, study.start.position),
            dt,
            rows,
            steady: matches!(study.motion, Motion::Static)
                && matches!(temperature, None | Some(crate::scenario::Temperature::Constant(_))),
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

    /// State and specific force at the time `t` (s).
    pub fn moment(&self, t: f64) -> (Pva, Vec3<B>) {
        let moment = self.truth.moment(t);
        (moment.pva, moment.f_b)
    }

    /// Error dynamics of the navigator.
    pub fn dynamics(&self) -> ErrorDynamics {
        ErrorDynamics { gravity: self.study.mechanization.gravity, vertical: self.vertical }
    }
}
