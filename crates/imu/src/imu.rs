//! The injector: true motion in, measured motion out.

use crate::error::Error;
use crate::process::Step;
use crate::random::{Address, Key};
use crate::sample::Sample;
use crate::term::{MAX_COEFFICIENTS, Term};
use crate::{Component, Input, Instrument, Motion, Spec, Stream, Truth};

/// Most coefficients that can evolve in one IMU.
pub const MAX_LANES: usize = 192;

/// An IMU with its errors.
///
/// A sample is the mean (or the increment) over its interval, so a process enters with its exact
/// interval mean, and the step may be of any length. The true input is taken as constant over the
/// interval where a term multiplies it.
#[derive(Clone, Debug)]
pub struct Imu {
    spec: Spec,
    key: Key,
    lanes: [Option<Lane>; MAX_LANES],
    n: usize,
    /// Step length for which the lanes hold their discretisation.
    dt: f64,
    state: State,
    /// Interval mean of each lane and what the instruments saw, kept for the ledger.
    means: [f64; MAX_LANES],
    inputs: [Option<Input>; 2],
}

/// Everything in an IMU that changes from step to step: save it, restore it, and the samples
/// repeat bit for bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    step: u64,
    x: [[f64; 2]; MAX_LANES],
}

/// One coefficient of one source.
#[derive(Clone, Copy, Debug)]
struct Lane {
    component: Component,
    step: Step,
    addresses: [Address; 3],
}

impl Imu {
    /// An IMU with the errors of `spec`, in the run that `stream` names.
    ///
    /// # Errors
    /// The specification has more than [`MAX_LANES`] coefficients.
    pub fn new(spec: &Spec, stream: Stream) -> Result<Imu, Error> {
        let n = spec.components().count();
        if n > MAX_LANES {
            return Err(Error::Capacity { what: "coefficients", need: n, capacity: MAX_LANES });
        }
        let mut imu = Imu {
            spec: spec.clone(),
            key: stream.key(),
            lanes: [None; MAX_LANES],
            n,
            dt: 0.0,
            state: State { step: 0, x: [[0.0; 2]; MAX_LANES] },
            means: [0.0; MAX_LANES],
            inputs: [None; 2],
        };
        for (i, component) in spec.components().enumerate() {
            let address = |draw| Address::new(&component, 0, draw);
            let start = address(3);
            let normals = [imu.key.normal(start, 0), imu.key.normal(start, 1)];
            let evolution = component.evolution();
            imu.state.x[i] = evolution.kind.initial(&evolution.arguments, normals);
            imu.lanes[i] = Some(Lane {
                component,
                step: Step::default(),
                addresses: [address(0), address(1), address(2)],
            });
        }
        Ok(imu)
    }

    /// The next sample, over an interval of `dt` seconds in which `truth` happened.
    ///
    /// Any `dt` above zero will do, and it may change from step to step; with another `dt` nothing
    /// happens and the sample is empty.
    pub fn step(&mut self, dt: f64, truth: &Truth) -> Sample {
        if !(dt > 0.0 && dt.is_finite()) {
            return Sample { dt, ..Sample::default() };
        }
        if dt != self.dt {
            self.discretise(dt);
        }
        self.advance();
        let calibration = self.spec.calibration_temperature;
        self.inputs = Instrument::ALL.map(|i| Some(Input::new(i, truth, dt, calibration)));
        let [omega_error, f_error] = self.errors();
        let add = |increment: [f64; 3], error: [f64; 3]| [0, 1, 2].map(|i| increment[i] + error[i] * dt);
        let scale = |mean: [f64; 3], error: [f64; 3]| [0, 1, 2].map(|i| (mean[i] + error[i]) * dt);
        let (dtheta, dv) = match truth.motion {
            Motion::Rates { omega, f } => (scale(omega, omega_error), scale(f, f_error)),
            Motion::Increments { dtheta, dv } => (add(dtheta, omega_error), add(dv, f_error)),
        };
        Sample { dt, dtheta, dv, omega_error, f_error }
    }

    /// One sample of `samples` for each of `truths`, all over intervals of `dt` seconds; the shorter
    /// slice decides how many.
    pub fn steps(&mut self, dt: f64, truths: &[Truth], samples: &mut [Sample]) {
        for (truth, sample) in truths.iter().zip(samples) {
            *sample = self.step(dt, truth);
        }
    }

    /// Everything that changes from step to step.
    pub fn save(&self) -> State {
        self.state
    }

    /// Goes back to a state saved from this IMU, or from one of the same specification and stream.
    pub fn restore(&mut self, state: &State) {
        self.state = *state;
    }

    /// The specification.
    pub fn spec(&self) -> &Spec {
        &self.spec
    }

    /// Contribution of every component to the last sample: measured minus true, mean over the
    /// interval, per axis, rad/s or m/s². Over an instrument they sum to its error within rounding.
    pub fn ledger(&self) -> impl Iterator<Item = (Component, [f64; 3])> {
        self.lanes().zip(self.means).filter_map(|(lane, mean)| {
            let c = lane.component;
            let input = self.inputs[c.instrument() as usize].as_ref()?;
            Some((c, c.term().regressor(input).columns()[c.coefficient()].map(|g| g * mean)))
        })
    }

    fn lanes(&self) -> impl Iterator<Item = &Lane> {
        self.lanes[..self.n].iter().flatten()
    }

    fn discretise(&mut self, dt: f64) {
        for lane in self.lanes[..self.n].iter_mut().flatten() {
            let e = lane.component.evolution();
            let mut step = e.kind.step(&e.arguments, dt);
            step.mean = step.mean.map(|m| m * e.gain);
            step.noise[2] = step.noise[2].map(|m| m * e.gain);
            lane.step = step;
        }
        self.dt = dt;
    }

    fn advance(&mut self) {
        let k = self.state.step;
        for (i, lane) in self.lanes[..self.n].iter().flatten().enumerate() {
            let (s, [x1, x2]) = (&lane.step, self.state.x[i]);
            let used = |j: usize| s.noise.iter().any(|row| row[j] != 0.0);
            let w = [0, 1, 2].map(|j| if used(j) { self.key.normal(lane.addresses[j], k) } else { 0.0 });
            let noise = s.noise.map(|n| n[0] * w[0] + n[1] * w[1] + n[2] * w[2]);
            self.means[i] = s.mean[0] * x1 + s.mean[1] * x2 + noise[2];
            self.state.x[i] = [0, 1].map(|r| s.phi[r][0] * x1 + s.phi[r][1] * x2 + noise[r]);
        }
        self.state.step += 1;
    }

    /// Output error of each instrument: components of the same term share one evaluation of it.
    fn errors(&self) -> [[f64; 3]; 2] {
        let mut errors = [[0.0; 3]; 2];
        let mut add = |instrument: Instrument, term: &'static dyn Term, c: &[f64; MAX_COEFFICIENTS]| {
            if let Some(input) = &self.inputs[instrument as usize] {
                let e = term.output(input, c);
                (0..3).for_each(|i| errors[instrument as usize][i] += e[i]);
            }
        };
        let mut open: Option<(Instrument, &'static dyn Term, [f64; MAX_COEFFICIENTS])> = None;
        for (lane, mean) in self.lanes().zip(self.means) {
            let (instrument, term) = (lane.component.instrument(), lane.component.term());
            match &mut open {
                Some((i, t, c)) if *i == instrument && *t == term => c[lane.component.coefficient()] += mean,
                _ => {
                    if let Some((i, t, c)) = open.take() {
                        add(i, t, &c);
                    }
                    let mut c = [0.0; MAX_COEFFICIENTS];
                    c[lane.component.coefficient()] = mean;
                    open = Some((instrument, term, c));
                }
            }
        }
        if let Some((i, t, c)) = open {
            add(i, t, &c);
        }
        errors
    }
}
