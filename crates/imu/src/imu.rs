//! The injector: true motion in, measured motion out.

use core::ops::Range;

use crate::bank::{Bank, MAX_FIRST, MAX_SECOND, MAX_WHITE};
use crate::error::Error;
use crate::process::Shape;
use crate::readout::{Chain, Status};
use crate::sample::Sample;
use crate::state::State;
use crate::term::{Coefficients, MAX_COEFFICIENTS, Term};
use crate::{Component, Input, Instrument, Motion, Source, Spec, Stream, TERMS, Truth};

/// A term may stand on each instrument.
const MAX_GROUPS: usize = 2 * TERMS.len();

/// An IMU with its errors.
///
/// A sample is the mean (or the increment) over its interval, so a process enters with its exact
/// interval mean, and the step may be of any length. The true input is taken as constant over the
/// interval where a term multiplies it.
#[derive(Clone, Debug)]
pub struct Imu {
    spec: Spec,
    bank: Bank,
    state: State,
    /// Those of the gyroscopes, then those of the accelerometers.
    groups: [Option<Group>; MAX_GROUPS],
    ranges: [Range<usize>; 2],
    /// Those of each instrument that are not all constant: they come last, when their sums are ready.
    moving: [Range<usize>; 2],
    /// Interval means of the coefficients of each group.
    sums: [Coefficients; MAX_GROUPS],
    /// Place of the coefficient that each moving part adds to: group times [`MAX_COEFFICIENTS`] plus
    /// number of the coefficient.
    targets: Targets,
    input: Input,
    chains: Option<[Chain; 2]>,
    /// Readout's part of the error of the last sample.
    readout_errors: [[f64; 3]; 2],
    dt: f64,
    /// Whether there has been a step that the ledger can tell of.
    stepped: bool,
}

/// The coefficients of one term on one instrument, summed over its sources.
#[derive(Clone, Copy, Debug)]
struct Group {
    instrument: Instrument,
    term: &'static dyn Term,
    /// Sum of the constant ones.
    base: Coefficients,
}

#[derive(Clone, Debug)]
struct Targets {
    white: ([u16; MAX_WHITE], usize),
    first: ([u16; MAX_FIRST], usize),
    second: ([u16; MAX_SECOND], usize),
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
        let mut imu = Imu {
            spec: spec.clone(),
            bank,
            state,
            groups: [None; MAX_GROUPS],
            ranges: [0..0, 0..0],
            moving: [0..0, 0..0],
            sums: [Coefficients::default(); MAX_GROUPS],
            targets: Targets {
                white: ([0; MAX_WHITE], 0),
                first: ([0; MAX_FIRST], 0),
                second: ([0; MAX_SECOND], 0),
            },
            input: Input::NONE,
            chains: spec.readout.map(|r| [Chain::new(r.gyro), Chain::new(r.accel)]),
            readout_errors: [[0.0; 3]; 2],
            dt: 0.0,
            stepped: false,
        };
        imu.group();
        Ok(imu)
    }

    /// Starts again at t = 0 as another run of the same specification.
    pub fn restart(&mut self, stream: Stream) {
        self.state = State::start(&self.spec, self.bank.start(&self.spec, stream.key()));
        self.stepped = false;
        self.group();
    }

    /// The next sample, over an interval of `dt` seconds in which `truth` happened.
    ///
    /// Any `dt` above zero will do, and it may change from step to step; with another `dt` nothing
    /// happens and the sample is empty.
    pub fn step(&mut self, dt: f64, truth: &Truth) -> Sample {
        let mut sample = Sample::default();
        self.step_into(dt, truth, &mut sample);
        sample
    }

    /// One sample of `samples` for each of `truths`, all over intervals of `dt` seconds; the shorter
    /// slice decides how many.
    pub fn steps(&mut self, dt: f64, truths: &[Truth], samples: &mut [Sample]) {
        for (truth, sample) in truths.iter().zip(samples) {
            self.step_into(dt, truth, sample);
        }
    }

    /// The next sample, written in place: copies of it would cost as much as its random numbers.
    #[inline]
    fn step_into(&mut self, dt: f64, truth: &Truth, sample: &mut Sample) {
        if !(dt > 0.0 && dt.is_finite()) {
            *sample = Sample { dt, ..Sample::default() };
            return;
        }
        if dt != self.dt {
            self.bank.discretise(&self.spec, dt);
            self.chains.iter_mut().flatten().for_each(|c| c.discretise(dt));
            self.dt = dt;
        }
        self.bank.advance(&mut self.state.bank);
        self.input.see(truth, dt, self.spec.calibration_temperature);
        self.stepped = true;
        self.sum();
        let omega_error = self.error(Instrument::Gyro);
        let f_error = self.error(Instrument::Accel);
        if self.chains.is_some() {
            *sample = self.read_out(dt, [omega_error, f_error]);
            return;
        }
        let add = |increment: [f64; 3], error: [f64; 3]| [0, 1, 2].map(|i| increment[i] + error[i] * dt);
        let scale = |mean: [f64; 3], error: [f64; 3]| [0, 1, 2].map(|i| (mean[i] + error[i]) * dt);
        (sample.dt, sample.omega_error, sample.f_error) = (dt, omega_error, f_error);
        (sample.dtheta, sample.dv) = match truth.motion {
            Motion::Rates { omega, f } => (scale(omega, omega_error), scale(f, f_error)),
            Motion::Increments { dtheta, dv } => (add(dtheta, omega_error), add(dv, f_error)),
        };
        (sample.gyro, sample.accel) = (Status::default(), Status::default());
    }

    /// The sample that the readout makes of the input and the sources' errors.
    fn read_out(&mut self, dt: f64, errors: [[f64; 3]; 2]) -> Sample {
        let mut out = [([0.0; 3], Status::default()); 2];
        let mut total = errors;
        for (which, chain) in self.chains.iter().flatten().enumerate() {
            let instrument = Instrument::ALL[which];
            let (u, e) = (self.input.of(instrument).u, errors[which]);
            let normals = self.bank.readout_normals(&self.state.bank, instrument);
            let state = &mut self.state.readout[which];
            out[which] = chain.step(state, dt, [0, 1, 2].map(|i| u[i] + e[i]), normals);
            total[which] = [0, 1, 2].map(|i| out[which].0[i] / dt - u[i]);
            self.readout_errors[which] = [0, 1, 2].map(|i| total[which][i] - e[i]);
        }
        let [(dtheta, gyro), (dv, accel)] = out;
        Sample { dt, dtheta, dv, omega_error: total[0], f_error: total[1], gyro, accel }
    }

    /// Everything that changes from step to step.
    pub fn save(&self) -> State {
        self.state
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
            let mean: f64 = self.bank.means.at(place).iter().sum();
            let regressor = c.term().regressor(&self.input.of(c.instrument()));
            self.stepped.then(|| (c, regressor.columns()[c.coefficient()].map(|g| g * mean)))
        })
    }

    /// The readout's part of the last sample's error: measured minus true minus the sum of the ledger,
    /// of gyroscopes (rad/s) and accelerometers (m/s²).
    pub fn readout_errors(&self) -> [[f64; 3]; 2] {
        self.readout_errors
    }

    /// Sorts the coefficients by the term that they belong to.
    fn group(&mut self) {
        self.groups = [None; MAX_GROUPS];
        for targets in [&mut self.targets.white.1, &mut self.targets.first.1, &mut self.targets.second.1] {
            *targets = 0;
        }
        let constant = |s: &Source| s.components().all(|c| c.evolution().is_constant());
        for instrument in Instrument::ALL {
            let of = || self.spec.sources().filter(|s| s.instrument() == instrument);
            let moves = |s: &Source| of().any(|o| o.term() == s.term() && !constant(o));
            let mut bounds = [self.groups.iter().flatten().count(); 3];
            for (bound, moving) in bounds[1..].iter_mut().zip([false, true]) {
                for source in of().filter(|s| moves(s) == moving) {
                    group_of(&mut self.groups, instrument, source.term());
                }
                *bound = self.groups.iter().flatten().count();
            }
            self.ranges[instrument as usize] = bounds[0]..bounds[2];
            self.moving[instrument as usize] = bounds[1]..bounds[2];
        }
        for (c, place) in self.bank.places(&self.spec) {
            let group = group_of(&mut self.groups, c.instrument(), c.term());
            let target = (group * MAX_COEFFICIENTS + c.coefficient()) as u16;
            let (list, len) = match place.shape {
                Shape::Constant => {
                    if let Some(group) = &mut self.groups[group] {
                        group.base[c.coefficient()] += self.bank.means.constant[place.first];
                    }
                    continue;
                }
                Shape::White => (&mut self.targets.white.0[..], &mut self.targets.white.1),
                Shape::First => (&mut self.targets.first.0[..], &mut self.targets.first.1),
                Shape::Second | Shape::Free => (&mut self.targets.second.0[..], &mut self.targets.second.1),
            };
            list[place.first..place.first + place.count].fill(target);
            *len = (*len).max(place.first + place.count);
        }
        for (sum, group) in self.sums.iter_mut().zip(self.groups.iter().flatten()) {
            *sum = group.base;
        }
    }

    /// Sums the interval means of the coefficients over their sources.
    fn sum(&mut self) {
        for range in &self.moving {
            for (sum, group) in
                self.sums[range.clone()].iter_mut().zip(self.groups[range.clone()].iter().flatten())
            {
                *sum = group.base;
            }
        }
        let flat = self.sums.as_flattened_mut();
        let (t, means) = (&self.targets, &self.bank.means);
        add_to(flat, &t.white.0[..t.white.1], &means.white);
        add_to(flat, &t.first.0[..t.first.1], &means.first);
        add_to(flat, &t.second.0[..t.second.1], &means.second);
    }

    /// Output error of an instrument.
    #[inline]
    fn error(&mut self, instrument: Instrument) -> [f64; 3] {
        self.input.turn_to(instrument);
        let range = self.ranges[instrument as usize].clone();
        let mut error = [0.0; 3];
        for (sum, group) in self.sums[range.clone()].iter().zip(self.groups[range].iter().flatten()) {
            group.term.add_output(&self.input, sum, &mut error);
        }
        error
    }
}

fn add_to(sums: &mut [f64], targets: &[u16], means: &[f64]) {
    for (target, mean) in targets.iter().zip(means) {
        sums[usize::from(*target)] += mean;
    }
}

/// Number of the group of `term` on `instrument`, which is made where it does not exist.
fn group_of(
    groups: &mut [Option<Group>; MAX_GROUPS],
    instrument: Instrument,
    term: &'static dyn Term,
) -> usize {
    let found = groups.iter().position(|g| match g {
        Some(g) => g.instrument == instrument && g.term == term,
        None => true,
    });
    let i = found.expect("invariant: there is a group for every term on every instrument");
    groups[i].get_or_insert(Group { instrument, term, base: Coefficients::default() });
    i
}
