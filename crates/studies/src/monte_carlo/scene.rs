//! The motion of the runs and what is drawn at their start.

use std::ops::Deref;

use crate::{Scenario, course::Course, scenario::MonteCarlo};

/// What all runs share; of it, what is so along any motion, is that of its [`Course`].
pub struct Scene<'a> {
    /// The study.
    pub study: &'a MonteCarlo,
    /// Master seed.
    pub seed: u64,
    course: Course<'a>,
}

impl<'a> Deref for Scene<'a> {
    type Target = Course<'a>;

    fn deref(&self) -> &Course<'a> {
        &self.course
    }
}

impl<'a> Scene<'a> {
    /// The scene of a valid study, with the rows that its scenario asks for.
    pub fn new(scenario: &Scenario, study: &'a MonteCarlo) -> Scene<'a> {
        Scene::with_stride(study, scenario.seed, Course::stride(scenario.output.every, study.imu.rate))
    }

    /// The same with a row every `stride` samples and at the end.
    pub fn with_stride(study: &'a MonteCarlo, seed: u64, stride: u64) -> Scene<'a> {
        let MonteCarlo { motion, start, imu, mechanization, samples, .. } = study;
        Scene { study, seed, course: Course::new(motion, start, imu, mechanization, *samples, stride) }
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
