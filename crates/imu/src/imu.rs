//! The injector: true motion in, measured motion out.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, dispatch, f64x4};

use crate::bank::{Bank, row_of};
use crate::error::Error;
use crate::random::{Level, STEPS};
use crate::readout::{Chain, Status};
use crate::sample::Sample;
use crate::state::State;
use crate::sums::Sums;
use crate::truth::{Inputs, Octet};
use crate::{Component, Instrument, Motion, Spec, Stream, Truth};

/// An IMU with its errors.
///
/// A sample is the mean (or the increment) over its interval, so a process enters with its exact
/// interval mean, and the step may be of any length. The true input is taken as constant over the
/// interval where a term multiplies it.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Imu {
    /// The sources' errors per instrument and axis.
    errors: Both,
    spec: Spec,
    bank: Bank,
    /// Its processes may be ahead of its step: see [`Bank::settle`].
    state: State,
    sums: Sums,
    /// What happened in the last steps, each in its row.
    inputs: Inputs,
    chains: Option<[Chain; 2]>,
    /// Readout's part of the error of the last sample.
    readout_errors: [[f64; 3]; 2],
    dt: f64,
    /// 1/dt.
    rate: f64,
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
            inputs: Inputs::NONE,
            errors: NOTHING,
            chains: spec.readout.map(|r| [Chain::new(r.gyro), Chain::new(r.accel)]),
            readout_errors: [[0.0; 3]; 2],
            dt: 0.0,
            rate: 0.0,
            last: None,
        })
    }

    /// Starts again at t = 0 as another run of the same specification.
    pub fn restart(&mut self, stream: Stream) {
        self.state = State::start(&self.spec, self.bank.start(&self.spec, stream.key()));
        self.sums = Sums::new(&self.spec, &self.bank);
        self.last = None;
    }

    /// Calculates in the lanes of `level` in place of the widest that the machine has; no bit of a sample
    /// depends on it.
    pub fn set_level(&mut self, level: Level) {
        self.bank.level = level;
        self.sums.level = level;
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
        let mut at = 0;
        while at < n {
            if n - at >= STEPS
                && self.row() == 0
                && self.state.bank.is_settled()
                && let (Some(truths), Some(samples)) =
                    (truths[at..].first_chunk(), samples[at..].first_chunk_mut())
            {
                self.steps_into(truths, samples);
                at += STEPS;
            } else {
                self.step_into(&truths[at], &mut samples[at]);
                at += 1;
            }
        }
    }

    /// The next samples, for each entry of `increments` eight over the intervals of `octet`, of which only the increments are of
    /// interest: those of angle (rad), then those of velocity (m/s), of each axis eight. The same numbers as by [`Imu::steps`];
    /// what the motion is to the terms has been worked out once for all instruments that go through it.
    pub fn octets(&mut self, octet: &Octet, increments: &mut [Both]) {
        let again = increments.len() > 1;
        let mut constant = None;
        for increments in increments {
            let ready = self.set_step(octet.dt) && self.row() == 0 && self.state.bank.is_settled();
            let alike = self.chains.is_none() && octet.calibration == self.spec.calibration_temperature;
            let Some(truth) = octet.increments.as_ref().filter(|_| ready && alike) else {
                let mut samples = [Sample::default(); STEPS];
                self.steps(octet.dt, octet.truths(), &mut samples);
                for (row, sample) in samples.iter().enumerate() {
                    for i in 0..3 {
                        (increments[0][i][row], increments[1][i][row]) = (sample.dtheta[i], sample.dv[i]);
                    }
                }
                continue;
            };
            match constant {
                Some(constant) => self.errors = constant,
                None => {
                    // The ledger tells of the last step alone.
                    self.inputs.copy_row(STEPS - 1, &octet.inputs);
                    self.sums.set_constant(&octet.inputs, &mut self.errors);
                    constant = again.then_some(self.errors);
                }
            }
            self.begin(STEPS);
            self.sums.add_moving(&octet.inputs, &mut self.errors);
            dispatch!(self.bank.level, simd => measure(simd, truth, &self.errors, octet.dt, increments));
        }
    }

    /// Prepares for steps of `dt` seconds, if that makes sense.
    #[inline]
    fn set_step(&mut self, dt: f64) -> bool {
        let valid = dt > 0.0 && dt.is_finite();
        if valid && (dt != self.dt || dt != self.state.bank.dt) {
            self.settle();
            self.state.bank.set_step(dt);
            if dt != self.dt {
                self.bank.discretise(&self.spec, dt);
                self.chains.iter_mut().flatten().for_each(|c| c.discretise(dt));
                (self.dt, self.rate) = (dt, 1.0 / dt);
            }
        }
        valid
    }

    /// The next sample, written in place: copies of it would cost as much as its random numbers.
    #[inline]
    fn step_into(&mut self, truth: &Truth, sample: &mut Sample) {
        let row = self.row();
        self.inputs.set(row, truth, self.dt, self.spec.calibration_temperature);
        let step = self.begin(1);
        for (instrument, errors) in Instrument::ALL.into_iter().zip(&mut self.errors) {
            let [x, y, z] = self.sums.error(instrument, row, &self.inputs);
            (errors[0][row], errors[1][row], errors[2][row]) = (x, y, z);
        }
        self.finish(step, row, truth, sample);
    }

    /// The next [`STEPS`] samples, from row 0 on.
    #[inline]
    fn steps_into(&mut self, truths: &[Truth; STEPS], samples: &mut [Sample; STEPS]) {
        // Before all else: what is written in single numbers is then ready to be read in lanes.
        for (row, truth) in truths.iter().enumerate() {
            self.inputs.set(row, truth, self.dt, self.spec.calibration_temperature);
        }
        let step = self.begin(STEPS);
        self.sums.set_constant(&self.inputs, &mut self.errors);
        self.sums.add_moving(&self.inputs, &mut self.errors);
        if self.chains.is_some() {
            return dispatch!(self.bank.level, simd => self.read_out_all(simd, step, samples));
        }
        for (row, (truth, sample)) in truths.iter().zip(samples).enumerate() {
            self.finish(step + row as u64, row, truth, sample);
        }
    }

    /// As [`Imu::read_out`], of all rows.
    #[inline(always)]
    fn read_out_all<S: Simd>(&mut self, simd: S, step: u64, samples: &mut [Sample; STEPS]) {
        for (row, sample) in samples.iter_mut().enumerate() {
            sample.dt = self.dt;
            self.read_out(simd, step + row as u64, row, sample);
        }
    }

    /// Row of the next step.
    fn row(&self) -> usize {
        row_of(self.state.step())
    }

    /// Takes the next `n` steps: number of the first.
    #[inline]
    fn begin(&mut self, n: usize) -> u64 {
        let step = self.state.step();
        if !self.bank.has(step) {
            self.bank.prepare(&mut self.state.bank, &mut self.sums);
        }
        self.state.bank.step += n as u64;
        self.last = Some(self.state.step() - 1);
        step
    }

    /// The sample of step `step` in `row`, number by number: pairs read where single numbers were just written
    /// would have to wait for them.
    #[inline(always)]
    fn finish(&mut self, step: u64, row: usize, truth: &Truth, sample: &mut Sample) {
        let dt = self.dt;
        sample.dt = dt;
        if self.chains.is_some() {
            return dispatch!(self.bank.level, simd => self.read_out(simd, step, row, sample));
        }
        let [omega_errors, f_errors] = &self.errors;
        for i in 0..3 {
            (sample.omega_error[i], sample.f_error[i]) = (omega_errors[i][row], f_errors[i][row]);
        }
        match &truth.motion {
            Motion::Rates { omega, f } => {
                for i in 0..3 {
                    sample.dtheta[i] = (omega[i] + omega_errors[i][row]) * dt;
                    sample.dv[i] = (f[i] + f_errors[i][row]) * dt;
                }
            }
            Motion::Increments { dtheta, dv } => {
                for i in 0..3 {
                    sample.dtheta[i] = dtheta[i] + omega_errors[i][row] * dt;
                    sample.dv[i] = dv[i] + f_errors[i][row] * dt;
                }
            }
        }
        (sample.gyro, sample.accel) = (Status::default(), Status::default());
    }

    /// What the readout makes of the input and the sources' errors of step `step`.
    #[inline(always)]
    fn read_out<S: Simd>(&mut self, simd: S, step: u64, row: usize, sample: &mut Sample) {
        for (which, chain) in self.chains.iter().flatten().enumerate() {
            let instrument = Instrument::ALL[which];
            let (u, e) = (self.inputs.seen_by(instrument).u(row), &self.errors[which]);
            let lanes = |[x, y, z]: [f64; 3]| f64x4::simd_from(simd, [x, y, z, 0.0]);
            let (u, e) = (lanes(u), lanes([e[0][row], e[1][row], e[2][row]]));
            let normals = self.bank.readout_normals(step, instrument);
            let (increment, status) = chain.step(&mut self.state.readout[which], self.dt, u + e, normals);
            let total = increment * self.rate - u;
            let of = |v: f64x4<S>| [v[0], v[1], v[2]];
            self.readout_errors[which] = of(total - e);
            match instrument {
                Instrument::Gyro => {
                    (sample.dtheta, sample.omega_error, sample.gyro) = (of(increment), of(total), status);
                }
                Instrument::Accel => {
                    (sample.dv, sample.f_error, sample.accel) = (of(increment), of(total), status);
                }
            }
        }
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
            let mean = self.bank.mean(place, step);
            let input = self.inputs.seen_by(c.instrument()).at(row_of(step));
            let regressor = c.term().regressor(&input);
            Some((c, regressor.columns()[c.coefficient()].map(|g| g * mean)))
        })
    }

    /// The readout's part of the last sample's error: measured minus true minus the sum of the ledger,
    /// of gyroscopes (rad/s) and accelerometers (m/s²).
    pub fn readout_errors(&self) -> [[f64; 3]; 2] {
        self.readout_errors
    }
}

/// Numbers of both instruments along each axis, for each of eight steps.
pub(crate) type Both = [[[f64; STEPS]; 3]; 2];

const NOTHING: Both = [[[0.0; STEPS]; 3]; 2];

/// Increments over steps of `dt` seconds in which there was `truth` and, on the mean, `errors`.
#[inline(always)]
fn measure<S: Simd>(simd: S, truth: &Both, errors: &Both, dt: f64, increments: &mut Both) {
    let n = S::f64s::LEN;
    let of = truth.as_flattened().iter().zip(errors.as_flattened());
    for ((truth, errors), increments) in of.zip(increments.as_flattened_mut()) {
        for at in (0..STEPS).step_by(n) {
            let [truth, error] = [truth, errors].map(|row| S::f64s::from_slice(simd, &row[at..at + n]));
            (truth + error * dt).store_slice(&mut increments[at..at + n]);
        }
    }
}
