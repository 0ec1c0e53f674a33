//! Transition and noise of navigation errors and the states of one source over intervals.

use nalgebra::SVector;
use schuler_imu::{Instrument, Truth as Seen};
use schuler_strapdown::Pva;
use schuler_strapdown::filter::{Accumulator, Form, Propagation};

use super::passage::{Part, Sample};
use super::rounding::Rounding;
use super::scene::Scene;
use super::source::{Joined, Joint, ROOM, Source};

/// What an interval does.
#[derive(Clone)]
pub enum Step {
    /// To states of a linear process.
    Linear(Box<Propagation<ROOM>>),
    /// To those of rounding: Phi and Q.
    Rounded(Box<[Joint; 2]>),
}

impl Step {
    /// P := Phi P Phi' + Q.
    pub fn apply(&self, p: &mut Joint) {
        match self {
            Step::Linear(step) => {
                step.transport(p);
                step.diffuse(p);
            }
            Step::Rounded(both) => *p = both[0] * *p * both[0].transpose() + both[1],
        }
    }

    /// Phi.
    pub fn phi(&self) -> Joint {
        match self {
            Step::Linear(step) => step.phi(),
            Step::Rounded(both) => both[0],
        }
    }

    /// Q.
    pub fn q(&self) -> Joint {
        match self {
            Step::Linear(step) => step.q(),
            Step::Rounded(both) => both[1],
        }
    }
}

/// Steps of one source: exact at rest, gathered from samples along a motion.
pub struct Stepper<'a> {
    scene: &'a Scene<'a>,
    model: Joined,
    accumulator: Accumulator<ROOM>,
    rounding: Option<Rounding>,
    /// At rest: number of samples and what they do.
    known: Vec<(u64, Step)>,
}

impl<'a> Stepper<'a> {
    /// Of a source along a scene.
    pub fn new(scene: &'a Scene<'a>, source: &Source) -> Stepper<'a> {
        let spec = &scene.study.imu.spec;
        let model = source.model(spec);
        let accumulator = Accumulator::new(&model, scene.dynamics(), &scene.moment(0.0).0);
        let rounding = source.rounding().map(|(component, q)| Rounding::new(component, q, spec));
        Stepper { scene, model, accumulator, rounding, known: Vec::new() }
    }

    /// Number of states, the nine and those of the source.
    pub fn len(&self) -> usize {
        self.model.len() + if self.rounding.is_some() { Rounding::STATES } else { 0 }
    }

    /// Second moment of all states at t = 0.
    pub fn start(&self, source: &Source) -> Joint {
        match &self.rounding {
            Some(rounding) => rounding.start(self.scene),
            None => source.start(self.scene, &self.model),
        }
    }

    /// Begins with the navigator at `pva`.
    pub fn begin(&mut self, pva: &Pva) {
        self.accumulator.begin(&self.model, pva);
    }

    /// From sample `begin` to `end`, which `samples` are; at rest they are not looked at.
    pub fn over(&mut self, begin: u64, end: u64, samples: &[Sample]) -> Step {
        let scene = self.scene;
        if !scene.steady {
            if let Some(rounding) = &self.rounding {
                return rounding.along(scene, begin, samples);
            }
            for Part { pva, seen, increments, dt } in samples.iter().flat_map(|sample| &sample.parts) {
                self.accumulator.step_seen(&self.model, pva, seen, increments, *dt);
            }
            return Step::Linear(Box::new(self.accumulator.close(&self.model)));
        }
        let count = end - begin;
        if let Some((_, step)) = self.known.iter().find(|(c, _)| *c == count) {
            return step.clone();
        }
        let step = match &self.rounding {
            Some(rounding) => rounding.at_rest(scene, count),
            None => {
                let (pva, f_b) = scene.moment(0.0);
                let system = Form::Phi.system(&scene.dynamics(), &pva, f_b);
                let seen = scene.seen(0, count);
                Step::Linear(Box::new(Propagation::exact(&self.model, &system, &seen, scene.time(count))))
            }
        };
        self.known.push((count, step.clone()));
        step
    }

    /// Error of the gyro along body axes in the last sample, which has `seen` that, by a unit of a state of the source.
    pub fn gyro(&self, state: usize, seen: &Seen) -> [f64; 3] {
        if let Some(rounding) = &self.rounding {
            return rounding.gyro(state, seen, self.scene.dt);
        }
        let mut unit = SVector::<f64, ROOM>::zeros();
        unit[state] = 1.0;
        self.model.sensor_error(Instrument::Gyro, &unit, seen, self.scene.dt)
    }
}
