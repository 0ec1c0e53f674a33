//! The motion of a budget and its rows of time.

use schuler_frames::{B, Vec3};
use schuler_imu::{Input, Instrument, Motion as Sensed, Truth as Seen};
use schuler_strapdown::{ErrorDynamics, Increments, Pva, Vertical};

use crate::{
    channel,
    scenario::{Budget, Motion},
    trajectory::{Moment, Still, Truth},
};

use super::source::{Kind, Source};

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

    /// The same up to the first row, at times that double from the first sample on.
    pub fn beginning(&self) -> Scene<'a> {
        let first = self.rows.get(1).copied().unwrap_or(1);
        let doubled = (0..u64::BITS).map(|k| 1 << k).take_while(|&k| k < first);
        Scene { rows: [0].into_iter().chain(doubled).collect(), ..Scene::new(self.study, None) }
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

    /// What the sensors go through while the body stands as at the start, over `dt` (s).
    pub fn at_rest(&self, dt: f64) -> Seen {
        let position = self.study.start.position;
        let attitude = self.truth.moment(0.0).pva.c_tb.as_euler();
        let still = Truth::new(Still::new(position, attitude), self.study.mechanization.gravity);
        let seen = still.imu_truth(0.0, dt);
        match &self.study.imu.temperature {
            None => seen,
            Some(temperature) => seen.at_temperature(&temperature.profile(), 0.0, dt),
        }
    }

    /// Error of the sensor along body axes by a unit of the coefficient of a source, and the sensor, under what it has
    /// `seen` over `dt` (s); `None` for what is no sensor error.
    pub fn regressor(&self, source: &Source, seen: &Seen, dt: f64) -> Option<(Instrument, [f64; 3])> {
        let Kind::Sensor(component) = &source.kind else { return None };
        let calibration = self.study.imu.spec.calibration_temperature;
        let input = Input::new(component.instrument(), seen, dt, calibration);
        let column = component.term().regressor(&input).columns()[component.coefficient()];
        Some((component.instrument(), column))
    }

    /// State and specific force at the time `t` (s).
    pub fn moment(&self, t: f64) -> (Pva, Vec3<B>) {
        let moment = self.truth.moment(t);
        (moment.pva, moment.f_b)
    }

    /// Everything that is true at the time `t` (s).
    pub fn whole_moment(&self, t: f64) -> Moment {
        self.truth.moment(t)
    }

    /// Error dynamics of the navigator.
    pub fn dynamics(&self) -> ErrorDynamics {
        ErrorDynamics { gravity: self.study.mechanization.gravity, vertical: self.vertical }
    }
}

/// What was seen over one sample, as increments.
pub fn increments(seen: &Seen, dt: f64) -> Increments {
    let (dtheta, dv) = match seen.motion {
        Sensed::Increments { dtheta, dv } => (dtheta, dv),
        Sensed::Rates { omega, f } => (omega.map(|x| x * dt), f.map(|x| x * dt)),
    };
    Increments { dtheta: Vec3::claim(dtheta), dv: Vec3::claim(dv) }
}
