//! The motion of a budget and its rows of time.

use std::ops::Deref;

use schuler_frames::{B, Vec3};
use schuler_imu::{Input, Instrument, Motion as Sensed, Truth as Seen};
use schuler_strapdown::{Increments, Pva};

use crate::{
    course::Course,
    scenario::Budget,
    trajectory::{Moment, Still, Truth},
};

use super::source::{Kind, Source};

/// What all ways of a budget share; of it, what is so along any motion, is that of its [`Course`].
pub struct Scene<'a> {
    pub study: &'a Budget,
    course: Course<'a>,
}

impl<'a> Deref for Scene<'a> {
    type Target = Course<'a>;

    fn deref(&self) -> &Course<'a> {
        &self.course
    }
}

impl<'a> Scene<'a> {
    /// The scene of a valid study with rows every `every` seconds.
    pub fn new(study: &'a Budget, every: Option<f64>) -> Scene<'a> {
        let Budget { motion, start, imu, mechanization, samples, .. } = study;
        let stride = Course::stride(every, imu.rate);
        Scene { study, course: Course::new(motion, start, imu, mechanization, *samples, stride) }
    }

    /// The same up to the first row, at times that double from the first sample on.
    pub fn beginning(&self) -> Scene<'a> {
        let first = self.rows.get(1).copied().unwrap_or(1);
        let doubled = (0..u64::BITS).map(|k| 1 << k).take_while(|&k| k < first);
        let rows = [0].into_iter().chain(doubled).collect();
        Scene::new(self.study, Some(self.time(self.study.samples))).with_rows(rows)
    }

    /// The same with other rows: numbers of samples, the first 0.
    pub fn with_rows(self, rows: Vec<u64>) -> Scene<'a> {
        Scene { study: self.study, course: self.course.with_rows(rows) }
    }

    /// Number of the sample at the last row.
    pub fn end(&self) -> u64 {
        self.rows.last().copied().unwrap_or(0)
    }

    /// What the sensors go through while the body stands as at the start, over `dt` (s).
    pub fn at_rest(&self, dt: f64) -> Seen {
        let position = self.study.start.position;
        let attitude = self.truth.moment(0.0).pva.c_tb.as_euler();
        let still = Truth::new(Still::new(position, attitude), self.study.mechanization.gravity);
        self.at_temperature(still.imu_truth(0.0, dt), 0.0, dt)
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
}

/// What was seen over one sample, as increments.
pub fn increments(seen: &Seen, dt: f64) -> Increments {
    let (dtheta, dv) = match seen.motion {
        Sensed::Increments { dtheta, dv } => (dtheta, dv),
        Sensed::Rates { omega, f } => (omega.map(|x| x * dt), f.map(|x| x * dt)),
    };
    Increments { dtheta: Vec3::claim(dtheta), dv: Vec3::claim(dv) }
}
