//! How the nine errors pass an interval of the motion: the same for all sources.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use rayon::prelude::*;
use schuler_frames::{B, Rot, T, Vec3};
use schuler_imu::{Component, Input, Instrument, Motion as Sensed, Spec, Truth as Seen};
use schuler_strapdown::{ErrorDynamics, Increments, Pva};

use super::scene::{Scene, increments};
use super::source::Nine;

/// Longest step along a motion, s; at rest an interval is one step. The transition over a step is of fourth order: in a turn of
/// 4 deg/s under 5 g it is right to 5e-8.
const STEP: f64 = 0.1;

/// Angle by which the attitude turns over a part of a sample at most, rad. The attitude in the middle of a part is that of the mean to
/// 1/24 of its square, 1.5e-8: a filter that waits for a small velocity to tell a heading makes ten thousand times as much of it.
const TURN: f64 = 0.0006;

/// Parts of a sample, at most: beyond two degrees in one it is for the user to sample more often.
const MOST_PARTS: f64 = 64.0;

/// One sample of a motion.
pub struct Sample {
    /// What was seen, and that as increments.
    pub seen: Seen,
    pub increments: Increments,
    /// The same in parts over which the attitude hardly turns.
    pub parts: Vec<Part>,
    /// C_b^t at the two [nodes](ErrorDynamics::NODES).
    turned: [Matrix3<f64>; 2],
}

/// A part of a sample, for ways that know the attitude at the ends of a step alone.
pub struct Part {
    /// The state at its end.
    pub pva: Pva,
    /// What was seen in the whole sample, as rates: what is delivered is wrong by its mean over that.
    pub seen: Seen,
    pub increments: Increments,
    /// Its length, s.
    pub dt: f64,
}

impl Part {
    fn all(scene: &Scene, sample: u64, seen: &Seen) -> Vec<Part> {
        let whole = increments(seen, scene.dt);
        let count = (whole.dtheta.norm() / TURN).ceil().clamp(1.0, MOST_PARTS) as u32;
        let (begin, dt) = (scene.time(sample), scene.dt / f64::from(count));
        let part = |j: u32| {
            let t = begin + f64::from(j) * dt;
            let increments = if count == 1 { whole } else { increments(&scene.truth.imu_truth(t, dt), dt) };
            let omega = whole.dtheta * (1.0 / scene.dt);
            let f = whole.dv * (1.0 / scene.dt);
            let motion = Sensed::Rates { omega: omega.as_array(), f: f.as_array() };
            Part { pva: scene.moment(t + dt).0, seen: Seen { motion, ..*seen }, increments, dt }
        };
        (0..count).map(part).collect()
    }
}

impl Sample {
    /// The mean of C_b^t over it.
    pub fn mean(&self) -> Matrix3<f64> {
        (self.turned[0] + self.turned[1]) * 0.5
    }
}

/// The samples from number `begin` to `end`.
pub fn samples(scene: &Scene, begin: u64, end: u64) -> Vec<Sample> {
    (begin..end)
        .into_par_iter()
        .map(|k| {
            let (seen, t) = (scene.seen(k, 1), scene.time(k));
            Sample {
                seen,
                increments: increments(&seen, scene.dt),
                parts: Part::all(scene, k, &seen),
                turned: ErrorDynamics::NODES.map(|node| attitude(&scene.moment(t + node * scene.dt).0)),
            }
        })
        .collect()
}

/// C_b^t.
pub fn attitude(pva: &Pva) -> Matrix3<f64> {
    pva.c_tb.as_dcm().as_nalgebra().into_owned()
}

/// A unit of a coefficient of a sensor error, for as long as an interval lasts.
#[derive(Clone)]
pub struct Drive {
    component: Component,
    size: f64,
    calibration: f64,
    /// Whether temperature and vibration are known beside the increments.
    informed: bool,
}

impl Drive {
    /// A coefficient of the truth, of the list `spec`.
    pub fn of_truth(component: Component, spec: &Spec) -> Drive {
        Drive { component, size: 1.0, calibration: spec.calibration_temperature, informed: true }
    }

    /// `size` of a coefficient as a filter with the list `spec` takes it out: it sees increments and nothing else.
    pub fn of_filter(component: Component, size: f64, spec: &Spec) -> Drive {
        Drive { component, size, calibration: spec.calibration_temperature, informed: false }
    }

    /// The sensor and its error along body axes (rad/s, m/s²) under what was `seen` over `dt` (s).
    pub fn error(&self, seen: &Seen, dt: f64) -> (Instrument, Vector3<f64>) {
        let instrument = self.component.instrument();
        let input = if self.informed {
            Input::new(instrument, seen, dt, self.calibration)
        } else {
            let Increments { dtheta, dv } = increments(seen, dt);
            let seen = Seen::increments(dtheta.as_array(), dv.as_array());
            Input::new(instrument, &seen, dt, self.calibration)
        };
        let column = self.component.term().regressor(&input).columns()[self.component.coefficient()];
        (instrument, Vector3::from(column) * self.size)
    }
}

/// Transition of the nine errors over an interval, and what each of some drives has done at its end.
#[derive(Clone)]
pub struct Passage {
    pub phi: Nine,
    pub responses: Vec<SVector<f64, 9>>,
}

/// Passages under the same drives.
#[derive(Clone)]
pub struct Passages<'a> {
    scene: &'a Scene<'a>,
    drives: Vec<Drive>,
    /// At rest: number of samples and their passage.
    known: Vec<(u64, Passage)>,
}

impl<'a> Passages<'a> {
    pub fn new(scene: &'a Scene<'a>, drives: Vec<Drive>) -> Self {
        Passages { scene, drives, known: Vec::new() }
    }

    /// From sample `begin` to `end`, which `samples` are; at rest they are not looked at.
    pub fn pass(&mut self, begin: u64, end: u64, samples: &[Sample]) -> Passage {
        if !self.scene.steady {
            return self.along(begin, samples);
        }
        let count = end - begin;
        if let Some((_, passage)) = self.known.iter().find(|(c, _)| *c == count) {
            return passage.clone();
        }
        let passage = self.at_rest(count);
        self.known.push((count, passage.clone()));
        passage
    }

    fn at_rest(&self, count: u64) -> Passage {
        let step = Step::new(self.scene, 0, count);
        let (seen, dt) = (self.scene.seen(0, count), self.scene.time(count));
        let c = attitude(&self.scene.moment(0.0).0);
        let done = |drive: &Drive| {
            let (instrument, u) = drive.error(&seen, dt);
            step.response(instrument, &(c * u * dt), &Vector3::zeros())
        };
        Passage { phi: step.phi, responses: self.drives.iter().map(done).collect() }
    }

    /// Along a motion, from sample `begin` over `samples`.
    ///
    /// What a drive does within a step is w = C u along t, sample by sample, by its integral and its first moment about the
    /// middle: the mean of a product is not the product of means where rates and attitude change together.
    pub fn along(&self, begin: u64, samples: &[Sample]) -> Passage {
        let (scene, dt) = (self.scene, self.scene.dt);
        let longest = ((STEP / dt + 1e-9) as usize).max(1);
        let mut passage =
            Passage { phi: Nine::identity(), responses: vec![SVector::zeros(); self.drives.len()] };
        for (number, some) in samples.chunks(longest).enumerate() {
            let step = Step::new(scene, begin + (number * longest) as u64, some.len() as u64);
            passage.phi = step.phi * passage.phi;
            let half = 0.5 * dt * some.len() as f64;
            for (drive, response) in self.drives.iter().zip(&mut passage.responses) {
                let (mut sum, mut moment) = (Vector3::zeros(), Vector3::zeros());
                let mut instrument = Instrument::Gyro;
                for (k, sample) in some.iter().enumerate() {
                    let (of, u) = drive.error(&sample.seen, dt);
                    instrument = of;
                    for (node, c) in ErrorDynamics::NODES.iter().zip(&sample.turned) {
                        let w = c * u * (0.5 * dt);
                        sum += w;
                        moment += w * ((k as f64 + node) * dt - half);
                    }
                }
                *response = step.phi * *response + step.response(instrument, &sum, &moment);
            }
        }
        passage
    }
}

/// A step.
struct Step {
    dt: f64,
    phi: Nine,
    /// Answer to constant errors along t.
    gamma: SMatrix<f64, 9, 6>,
    /// Its slope against the time within the step: -F (1 + F dt/2) B.
    slope: SMatrix<f64, 9, 6>,
}

impl Step {
    fn new(scene: &Scene, sample: u64, count: u64) -> Step {
        let (t, dt) = (scene.time(sample), scene.time(count));
        // The same dynamics with the axes of the sensors along t.
        let moments = ErrorDynamics::NODES.map(|node| {
            let (pva, f_b) = scene.moment(t + node * dt);
            let f_t: Vec3<T> = pva.c_tb * f_b;
            (Pva { c_tb: Rot::IDENTITY, ..pva }, Vec3::<B>::claim(f_t.as_array()))
        });
        let dynamics = scene.dynamics();
        let step = dynamics.transition(moments.each_ref().map(|(pva, f)| (pva, *f)), dt);
        let [a, b] = moments.each_ref().map(|(pva, f)| dynamics.system(pva, *f));
        let f = (a.f + b.f) * 0.5;
        let mut inputs = SMatrix::<f64, 9, 6>::zeros();
        inputs.fixed_view_mut::<9, 3>(0, 0).copy_from(&a.b_gyro);
        inputs.fixed_view_mut::<9, 3>(0, 3).copy_from(&a.b_accel);
        let fb = f * inputs;
        Step {
            dt,
            phi: step.phi.fixed_view::<9, 9>(0, 0).into_owned(),
            gamma: step.gamma.fixed_view::<9, 6>(0, 0).into_owned(),
            slope: -(fb + f * fb * (0.5 * dt)),
        }
    }

    /// What an error along t does that has this integral over the step, and this first moment about its middle.
    fn response(&self, of: Instrument, sum: &Vector3<f64>, moment: &Vector3<f64>) -> SVector<f64, 9> {
        let first = match of {
            Instrument::Gyro => 0,
            Instrument::Accel => 3,
        };
        self.gamma.fixed_view::<9, 3>(0, first) * (sum / self.dt)
            + self.slope.fixed_view::<9, 3>(0, first) * moment
    }
}
