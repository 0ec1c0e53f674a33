//! A motion in samples, and the rows of time at which errors are asked for.

use schuler_imu::Truth as Seen;
use schuler_strapdown::{ErrorDynamics, Pva, Vertical};

use crate::{
    channel,
    scenario::{Imu, Mechanization, Motion, Start, Temperature},
    trajectory::Truth,
};

/// What a budget and a Monte Carlo navigate along.
pub struct Course<'a> {
    /// The instrument.
    pub imu: &'a Imu,
    /// How it navigates.
    pub mechanization: &'a Mechanization,
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

impl<'a> Course<'a> {
    /// The course of a valid study, with a row every `stride` samples and at the end.
    pub fn new(
        motion: &Motion,
        start: &Start,
        imu: &'a Imu,
        mechanization: &'a Mechanization,
        samples: u64,
        stride: u64,
    ) -> Course<'a> {
        let dt = 1.0 / imu.rate;
        let gravity = mechanization.gravity;
        let trajectory = motion.trajectory(start, gravity, samples, dt).ok().flatten().expect(
            "invariant: the motion of a valid scenario is possible, and neither zero truth nor a file",
        );
        let course = Course {
            imu,
            mechanization,
            truth: Truth::boxed(trajectory, gravity),
            vertical: channel::vertical(mechanization, start.position),
            dt,
            rows: Vec::new(),
            states: Vec::new(),
            steady: matches!(motion, Motion::Static)
                && matches!(imu.temperature, None | Some(Temperature::Constant(_))),
        };
        let mut rows: Vec<u64> = (0..=samples / stride).map(|k| k * stride).collect();
        if !samples.is_multiple_of(stride) {
            rows.push(samples);
        }
        course.with_rows(rows)
    }

    /// The same with other rows, the first 0.
    pub fn with_rows(self, rows: Vec<u64>) -> Course<'a> {
        let states = rows.iter().map(|&k| self.truth.moment(self.time(k)).pva).collect();
        Course { rows, states, ..self }
    }

    /// Samples between rows that are `every` seconds apart; without, each sample is one.
    pub fn stride(every: Option<f64>, rate: f64) -> u64 {
        every.map_or(1, |every| (every * rate).round().max(1.0) as u64)
    }

    /// Time of a sample, s.
    pub fn time(&self, sample: u64) -> f64 {
        sample as f64 * self.dt
    }

    /// What the sensors go through during `count` samples from the one of number `sample`, as one interval.
    pub fn seen(&self, sample: u64, count: u64) -> Seen {
        let (t, dt) = (self.time(sample), count as f64 * self.dt);
        self.at_temperature(self.truth.imu_truth(t, dt), t, dt)
    }

    /// The same at the temperature that the instrument has during `dt` seconds from `t` on.
    pub fn at_temperature(&self, seen: Seen, t: f64, dt: f64) -> Seen {
        match &self.imu.temperature {
            None => seen,
            Some(temperature) => seen.at_temperature(&temperature.profile(), t, dt),
        }
    }

    /// Error dynamics of the navigator.
    pub fn dynamics(&self) -> ErrorDynamics {
        ErrorDynamics { gravity: self.mechanization.gravity, vertical: self.vertical }
    }
}
