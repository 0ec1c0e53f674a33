//! The injector: true motion in, measured motion out.

use crate::bank::{Bank, STEPS, row_of};
use crate::error::Error;
use crate::readout::{Chain, Status};
use crate::sample::Sample;
use crate::state::State;
use crate::sums::Sums;
use crate::term::TOGETHER;
use crate::{Component, Input, Instrument, Motion, Spec, Stream, Truth};

/// An IMU with its errors.
///
/// A sample is the mean (or the increment) over its interval, so a process enters with its exact
/// interval mean, and the step may be of any length. The true input is taken as constant over the
/// interval where a term multiplies it.
#[derive(Clone, Debug)]
pub struct Imu {
    spec: Spec,
    bank: Bank,
    /// Its processes may be ahead of its step: see [`Bank::settle`].
    state: State,
    sums: Sums,
    /// What happened in the steps of the block, each in its row.
    inputs: [Input; STEPS],
    chains: Option<[Chain; 2]>,
    /// Readout's part of the error of the last sample.
    readout_errors: [[f64; 3]; 2],
    dt: f64,
    /// Number of the step of the last sample, of which the ledger tells.
    last: Option<u64>,
}

impl Imu {
    /// An IMU with the errors of `spec`, in the run that `stream` names.
    ///
    /// # Errors
    /// The specification has more coefficients than the fixed capacity holds.
    pub fn new(spec: &Spec, stream: Stream) -> Result<Imu, Error> {
        if let Some(readout) = &spec.readout {
            readout.validate()?;
        }
        let mut bank = Bank::new(spec)?;
        let state = State::start(spec, bank.start(spec, stream.key()));
        Ok(Imu {
            spec: spec.clone(),
            sums: Sums::new(spec, &bank),
            bank,
            state,
            inputs: [Input::NONE; STEPS],
            chains: spec.readout.map(|r| [Chain::new(r.gyro), Chain::new(r.accel)]),
            readout_errors: [[0.0; 3]; 2],
            dt: 0.0,
            last: None,
        })
    }

    /// Starts again at t = 0 as another run of the same specification.
    pub fn restart(&mut self, stream: Stream) {
        self.state = State::start(&self.spec, self.bank.start(&self.spec, stream.key()));
        self.sums = Sums::new(&self.spec, &self.bank);
        self.last = None;
    }

    /// The next sample, over an interval of `dt` seconds in which `truth` happened.
    ///
    /// Any `dt` above zero will do, and it may change from step to step; with another `dt` nothing
    /// happens and the sample is empty.
    pub fn step(&mut self, dt: f64, truth: &Truth) -> Sample {
        let mut sample = Sample::default();
        if self.set_step(dt) {
            self.step_into(truth, &mut sample);
        } else {
            sample.dt = dt;
        }
        sample
    }

    /// One sample of `samples` for each of `truths`, all over intervals of `dt` seconds; the shorter
    /// slice decides how many.
    pub fn steps(&mut self, dt: f64, truths: &[Truth], samples: &mut [Sample]) {
        let n = truths.len().min(samples.len());
        let (truths, samples) = (&truths[..n], &mut samples[..n]);
        if !self.set_step(dt) {
            samples.fill(Sample { dt, ..Sample::default() });
            return;
        }
        let alone = (TOGETHER - row_of(self.state.step()) % TOGETHER) % TOGETHER;
        let (first, truths) = truths.split_at(alone.min(n));
        let (first_out, samples) = samples.split_at_mut(first.len());
        let (fours, last) = truths.as_chunks();
        let (fours_out, last_out) = samples.as_chunks_mut();
        first.iter().zip(first_out).for_each(|(truth, sample)| self.step_into(truth, sample));
        fours.iter().zip(fours_out).for_each(|(truths, samples)| self.steps_into(truths, samples));
        last.iter().zip(last_out).for_each(|(truth, sample)| self.step_into(truth, sample));
    }

    /// Prepares for steps of `dt` seconds, if that makes sense.
    #[inline]
    fn set_step(&mut self, dt: f64) -> bool {
        if dt != self.dt && dt > 0.0 && dt.is_finite() {
            self.settle();
            self.bank.discretise(&self.spec, dt);
            self.chains.iter_mut().flatten().for_each(|c| c.discretise(dt));
            self.dt = dt;
        }
        dt == self.dt && dt > 0.0
    }

    /// The next sample, written in place: copies of it would cost as much as its random numbers.
    #[inline]
    fn step_into(&mut self, truth: &Truth, sample: &mut Sample) {
        let (step, row) = self.begin(1);
        let input = &mut self.inputs[row];
        input.see(truth, self.dt, self.spec.calibration_temperature);
        input.turn_to(Instrument::Gyro);
        let omega_error = self.sums.error(Instrument::Gyro, row, input);
        input.turn_to(Instrument::Accel);
        let f_error = self.sums.error(Instrument::Accel, row, input);
        self.finish(step, truth, [&omega_error, &f_error], sample);
    }

    /// The next [`TOGETHER`] samples.
    #[inline]
    fn steps_into(&mut self, truths: &[Truth; TOGETHER], samples: &mut [Sample; TOGETHER]) {
        let (step, row) = self.begin(TOGETHER);
        let inputs = &mut self.inputs.as_chunks_mut().0[row / TOGETHER];
        for (input, truth) in inputs.iter_mut().zip(truths) {
            input.see(truth, self.dt, self.spec.calibration_temperature);
        }
        inputs.iter_mut().for_each(|input| input.turn_to(Instrument::Gyro));
        let omega_errors = self.sums.errors(Instrument::Gyro, row, inputs);
        inputs.iter_mut().for_each(|input| input.turn_to(Instrument::Accel));
        let f_errors = self.sums.errors(Instrument::Accel, row, inputs);
        for i in 0..TOGETHER {
            self.finish(step + i as u64, &truths[i], [&omega_errors[i], &f_errors[i]], &mut samples[i]);
        }
    }

    /// Takes the next `n` steps, which are in one block: number and row of the first.
    #[inline]
    fn begin(&mut self, n: usize) -> (u64, usize) {
        let step = self.state.step();
        if !self.bank.has(step) {
            let rows = self.bank.prepare(&mut self.state.bank);
            self.sums.add_up(&self.bank, rows);
        }
        self.state.bank.step += n as u64;
        self.last = Some(self.state.step() - 1);
        (step, row_of(step))
    }

    /// The sample of step `step` from the sources' errors.
    #[inline(always)]
    fn finish(&mut self, step: u64, truth: &Truth, errors: [&[f64; 3]; 2], sample: &mut Sample) {
        if self.chains.is_some() {
            return self.read_out(step, errors.map(|e| *e), sample);
        }
        let (dt, [&omega_error, &f_error]) = (self.dt, errors);
        (sample.dt, sample.omega_error, sample.f_error) = (dt, omega_error, f_error);
        (sample.dtheta, sample.dv) = match truth.motion {
            Motion::Rates { omega, f } => (measured(omega, omega_error, dt), measured(f, f_error, dt)),
            Motion::Increments { dtheta, dv } => (add(dtheta, omega_error, dt), add(dv, f_error, dt)),
        };
        (sample.gyro, sample.accel) = (Status::default(), Status::default());
    }

    /// The sample that the readout makes of the input and the sources' errors of step `step`.
    fn read_out(&mut self, step: u64, errors: [[f64; 3]; 2], sample: &mut Sample) {
        let dt = self.dt;
        let mut out = [([0.0; 3], Status::default()); 2];
        let mut total = errors;
        for (which, chain) in self.chains.iter().flatten().enumerate() {
            let instrument = Instrument::ALL[which];
            let (u, e) = (self.inputs[row_of(step)].of(instrument).u, errors[which]);
            let normals = self.bank.readout_normals(step, instrument);
            let state = &mut self.state.readout[which];
            out[which] = chain.step(state, dt, [0, 1, 2].map(|i| u[i] + e[i]), normals);
            total[which] = [0, 1, 2].map(|i| out[which].0[i] / dt - u[i]);
            self.readout_errors[which] = [0, 1, 2].map(|i| total[which][i] - e[i]);
        }
        let [(dtheta, gyro), (dv, accel)] = out;
        *sample = Sample { dt, dtheta, dv, omega_error: total[0], f_error: total[1], gyro, accel };
    }

    /// Goes back from what is prepared to where the last sample ended.
    fn settle(&mut self) {
        self.bank.settle(&mut self.state.bank);
        self.bank.forget();
    }

    /// Everything that changes from step to step.
    pub fn save(&self) -> State {
        let mut state = self.state;
        self.bank.settle(&mut state.bank);
        state
    }

    /// Goes back to a state saved from this IMU, or from one of the same specification and stream.
    ///
    /// # Errors
    /// The state is of a specification with other sources. Their numbers and the stream are not compared.
    pub fn restore(&mut self, state: &State) -> Result<(), Error> {
        if state.fingerprint != self.state.fingerprint {
            return Err(Error::ForeignState { reason: "its list of sources is another" });
        }
        self.state = *state;
        self.bank.forget();
        Ok(())
    }

    /// The specification.
    pub fn spec(&self) -> &Spec {
        &self.spec
    }

    /// Contribution of every component to the last sample: measured minus true, mean over the
    /// interval, per axis, rad/s or m/s². With [`Imu::readout_errors`] they
    /// sum to the instrument's error within rounding.
    /// Empty before the first step.
    pub fn ledger(&self) -> impl Iterator<Item = (Component, [f64; 3])> {
        self.bank.places(&self.spec).filter_map(|(c, place)| {
            let step = self.last?;
            let mean: f64 = self.bank.means(place, step).iter().sum();
            let regressor = c.term().regressor(&self.inputs[row_of(step)].of(c.instrument()));
            Some((c, regressor.columns()[c.coefficient()].map(|g| g * mean)))
        })
    }

    /// The readout's part of the last sample's error: measured minus true minus the sum of the ledger,
    /// of gyroscopes (rad/s) and accelerometers (m/s²).
    pub fn readout_errors(&self) -> [[f64; 3]; 2] {
        self.readout_errors
    }
}

/// Increment over `dt` of a mean with its error.
fn measured(mean: [f64; 3], error: [f64; 3], dt: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| (mean[i] + error[i]) * dt)
}

/// An increment over `dt` with its error.
fn add(increment: [f64; 3], error: [f64; 3], dt: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| increment[i] + error[i] * dt)
}
