//! The navigate study with measurements beside the log: an error-state filter closed after each of them.
//!
//! A measurement within a sample splits the sample's increments in proportion to time: the navigator goes to the moment of
//! the measurement, is corrected, and goes on with the rest.

mod closed_loop;
mod consistency;
mod figures;
mod gathered;
mod measured;
mod reference;
mod report;
mod sensors;
mod standstill;
#[cfg(test)]
mod tests;

pub use closed_loop::ClosedLoop;

use schuler_frames::{Rot, Vec3};
use schuler_strapdown::filter::{FilterError, Measurement, Model, NavStates, Outcome};
use schuler_strapdown::{Increments, NavError, Pva, Vertical};

use super::no_attitude;
use super::pass::{Mean, attitude};
use crate::log::{LogReader, LogSample, find};
use crate::record::Record;
use crate::scenario::Aided;
use crate::{Context, Diagnostic, Error, Scenario, channel};
use measured::{Event, Span};
use reference::Known;
use standstill::Standstill;

/// Share of a sample within which a measurement is taken as being at its end, and a reference row at a row.
const SLACK: f64 = 1e-3;

/// One row of the output.
struct Row {
    t: f64,
    pva: Pva,
    /// The filter's own standard deviations.
    sigma: [f64; 9],
    /// Estimated errors of gyros and accelerometers.
    sensors: [[f64; 3]; 2],
    /// Name, estimate and standard deviation of each state of the error sources.
    states: Vec<(String, f64, f64)>,
    /// Against the reference, and NEES with its degrees of freedom, where there is one.
    error: Option<(NavError, Option<(f64, usize)>)>,
}

/// What one update found.
struct Update {
    t: f64,
    /// Number of the source: logs first, then conditions.
    source: usize,
    outcome: Outcome,
}

/// Everything that was found.
#[derive(Default)]
struct Found {
    rows: Vec<Row>,
    updates: Vec<Update>,
    /// Samples of the log, those before the start too.
    samples: u64,
    /// How often each condition looked for a standstill, and found one.
    looked: Vec<(u64, u64)>,
}

/// Runs a navigate study with a filter, in one pass over the log of the IMU; logs of measurements are kept whole.
///
/// The record has `trajectory`, `sigmas`, `sensors` (errors of the sensors as estimated), `states` (of the error sources),
/// `updates` (counts and mean NIS of each kind of measurement), `innovations`, and with a reference `errors` and `nees`.
///
/// # Errors
/// A log is not there, is wrong somewhere, does not overlap that of the IMU or ends before the start; the window gives no
/// attitude; the filter meets numbers that make no sense.
pub fn run(scenario: &Scenario, aided: &Aided, context: &Context) -> Result<Record, Error> {
    let vertical = channel::vertical(&aided.mechanization, aided.start.position);
    let held = vertical == Vertical::Held;
    let (events, spans) = measured::read(scenario, &aided.measured, held, context)?;
    let known = aided.reference.as_ref().map(|r| reference::read(scenario, r, context)).transpose()?;
    let job = Job { scenario, aided, vertical, events: &events, known: known.as_ref(), context };
    // The smallest room that holds the states: what is not in use still has to be moved.
    let nav = if held { NavStates::HELD } else { NavStates::ALL };
    let found = if Model::<16>::new(aided.form, nav, &aided.spec).is_ok() {
        job.navigate::<16>()?
    } else if Model::<24>::new(aided.form, nav, &aided.spec).is_ok() {
        job.navigate::<24>()?
    } else {
        job.navigate::<64>()?
    };
    overlap(aided, &spans, known.as_ref(), &found)?;
    Ok(report::record(scenario, aided, &events, known.as_ref(), &found))
}

/// A log of measurements that is all before the start or after the end is a mistake in its times.
fn overlap(aided: &Aided, spans: &[Span], known: Option<&Known>, found: &Found) -> Result<(), Error> {
    let ends = [found.rows.first(), found.rows.last()].map(|row| row.map_or(f64::NAN, |row| row.t));
    for (span, measured) in spans.iter().zip(&aided.measured) {
        let [first, last] = span.times;
        if last <= ends[0] || first > ends[1] {
            return Err(Diagnostic::new(&span.file, "the log does not overlap with what is navigated")
                .expected(format!(
                    "times between {} s and {} s, those of the log of the IMU",
                    ends[0], ends[1]
                ))
                .found(format!("{first} s to {last} s"))
                .help(format!("`filter.measurements.{}.offset` is added to its times", measured.kind.name()))
                .into());
        }
    }
    match known {
        Some(known) if found.rows.iter().all(|row| row.error.is_none()) => {
            Err(Diagnostic::new(&known.file, "the reference has no row at the time of any row of the output")
                .expected(format!(
                    "times between {} s and {} s, as `output.every` makes them",
                    ends[0], ends[1]
                ))
                .help("`filter.reference.offset` is added to its times")
                .into())
        }
        _ => Ok(()),
    }
}

/// What is done.
struct Job<'a> {
    scenario: &'a Scenario,
    aided: &'a Aided,
    vertical: Vertical,
    events: &'a [Event],
    known: Option<&'a Known>,
    context: &'a Context<'a>,
}

/// A pass under way.
struct Pass<'a, const N: usize> {
    job: &'a Job<'a>,
    /// The navigator, its conditions, and the samples before it started.
    running: Option<(ClosedLoop<N>, u64)>,
    conditions: Vec<Box<dyn Measurement>>,
    /// What tells a standstill, of the conditions that ask for one.
    standstills: Vec<Option<Standstill>>,
    window: Mean,
    /// Next measurement.
    next: usize,
    /// End of the sample before, s.
    before: f64,
    found: Found,
}

impl Job<'_> {
    fn navigate<const N: usize>(&self) -> Result<Found, Error> {
        let aided = self.aided;
        let file = find(&aided.log, self.context.data.as_deref(), &self.scenario.file)?;
        let mut pass = self.pass::<N>();
        for sample in LogReader::open(&aided.log, &file)?.watched(self.context.progress) {
            pass.sample(&sample?, &file)?;
        }
        pass.end()?;
        let rate = aided.log.rate;
        if pass.running.is_none() {
            let [begin, end] = aided.align.map_or([0.0; 2], |align| align.window);
            let rows = pass.found.samples;
            return Err(Diagnostic::new(&file, "the log ends within the alignment window")
                .expected(format!(
                    "more than {end} s of data, because `align.window` is [{begin} s, {end} s]"
                ))
                .found(format!("{rows} rows, which are {} s at {rate} Hz", rows as f64 / rate))
                .into());
        }
        Ok(pass.found)
    }

    fn pass<const N: usize>(&self) -> Pass<'_, N> {
        let held = self.vertical == Vertical::Held;
        Pass {
            job: self,
            running: None,
            conditions: self.aided.conditions.iter().map(|c| measured::known(c, held)).collect(),
            standstills: self.aided.conditions.iter().map(|c| c.detect.map(Standstill::new)).collect(),
            window: Mean::default(),
            next: 0,
            before: f64::NAN,
            found: Found { looked: vec![(0, 0); self.aided.conditions.len()], ..Found::default() },
        }
    }

    fn samples(&self, seconds: f64) -> u64 {
        (seconds * self.aided.log.rate).round() as u64
    }

    fn failed(&self, t: f64, what: &str, fault: FilterError) -> Error {
        Diagnostic::new(&self.scenario.file, format!("the filter fails at {t} s, {what}: {fault}"))
            .path("filter")
            .expected("standard deviations and measurements that fit each other")
            .into()
    }
}

impl<const N: usize> Pass<'_, N> {
    fn sample(&mut self, sample: &LogSample, file: &std::path::Path) -> Result<(), Error> {
        let job = self.job;
        let (aided, dt) = (job.aided, 1.0 / job.aided.log.rate);
        let k = self.found.samples + 1;
        if k == 1 {
            self.before = sample.t - dt;
            if aided.align.is_none() {
                let start = &aided.start;
                let c_tb = Rot::from_euler(start.attitude);
                self.begin(
                    self.before,
                    &Pva { position: start.position, v_t: Vec3::claim(start.velocity), c_tb },
                )?;
            }
        }
        self.found.samples = k;
        match (&self.running, aided.align) {
            (Some((_, first)), _) => {
                let last = aided.duration.map(|duration| first + job.samples(duration));
                if last.is_none_or(|last| k <= last) {
                    self.navigate(sample, dt, last == Some(k))?;
                }
            }
            (None, Some(align)) => {
                let [begin, end] = align.window.map(|seconds| job.samples(seconds));
                if k > begin {
                    self.window.add(sample);
                }
                if k == end {
                    let (position, gravity) = (aided.start.position, aided.mechanization.gravity);
                    let c_tb = attitude(&self.window, dt, position, gravity)
                        .map_err(|fault| no_attitude(align.window, file, fault))?;
                    self.begin(sample.t, &Pva { position, v_t: Vec3::ZERO, c_tb })?;
                }
            }
            (None, None) => {}
        }
        self.before = sample.t;
        Ok(())
    }

    /// Starts at the time `t` (s).
    fn begin(&mut self, t: f64, pva: &Pva) -> Result<(), Error> {
        let job = self.job;
        let closed = ClosedLoop::new(job.aided, pva, job.vertical)
            .map_err(|fault| job.failed(t, "at its start", fault))?;
        self.running = Some((closed, self.found.samples));
        self.next = job.events.partition_point(|event| event.t <= t);
        self.row(t);
        Ok(())
    }

    /// The sample that ends at `sample.t`, with the measurements within it.
    fn navigate(&mut self, sample: &LogSample, dt: f64, last: bool) -> Result<(), Error> {
        let (job, before, t) = (self.job, self.before, sample.t);
        let Some((closed, first)) = &mut self.running else { return Ok(()) };
        let mut done = 0.0;
        while let Some(event) = job.events.get(self.next).filter(|event| event.t <= t + SLACK * dt) {
            self.next += 1;
            let share = ((event.t - before) / (t - before)).clamp(0.0, 1.0);
            let share = if share > 1.0 - SLACK { 1.0 } else { share };
            if share > done + SLACK {
                part(closed, &sample.increments, dt, share - done);
                done = share;
            }
            let outcome = closed
                .measure(event.taken.measurement())
                .map_err(|fault| job.failed(event.t, job.aided.measured[event.source].kind.name(), fault))?;
            self.found.updates.push(Update { t: event.t, source: event.source, outcome });
        }
        if done < 1.0 {
            part(closed, &sample.increments, dt, 1.0 - done);
        }
        if self.standstills.iter().any(Option::is_some) {
            let (omega, f) = closed.motion();
            for standstill in self.standstills.iter_mut().flatten() {
                standstill.push(omega, f);
            }
        }
        let k = self.found.samples - *first;
        for (i, (condition, known)) in job.aided.conditions.iter().zip(&self.conditions).enumerate() {
            let holds = condition
                .windows
                .as_ref()
                .is_none_or(|windows| windows.iter().any(|[begin, end]| (*begin..=*end).contains(&t)));
            if holds && k.is_multiple_of(condition.stride) {
                if let Some(standstill) = &self.standstills[i] {
                    let pva = closed.pva();
                    let g = job.aided.mechanization.gravity.gravity_t(pva.position).norm();
                    let speed = pva.v_t.norm();
                    self.found.looked[i].0 += 1;
                    if !standstill.holds(g, speed) {
                        continue;
                    }
                    self.found.looked[i].1 += 1;
                }
                let outcome = closed
                    .measure(known.as_ref())
                    .map_err(|fault| job.failed(t, condition.kind.name(), fault))?;
                let source = job.aided.measured.len() + i;
                self.found.updates.push(Update { t, source, outcome });
            }
        }
        let stride = job.scenario.output.every.map_or(1, |every| job.samples(every)).max(1);
        if k.is_multiple_of(stride) || last {
            self.row(t);
        }
        Ok(())
    }

    /// The last state is always a row, and has numbers.
    fn end(&mut self) -> Result<(), Error> {
        if self.job.aided.duration.is_none() && self.found.rows.last().is_some_and(|row| row.t < self.before)
        {
            self.row(self.before);
        }
        let lost = self.found.rows.iter().find(|row| !row.pva.v_t.norm().is_finite());
        lost.map_or(Ok(()), |row| {
            Err(Error::Diverged { source_name: "all".into(), way: "navigated", time: row.t })
        })
    }

    fn row(&mut self, t: f64) {
        let Some((closed, _)) = &mut self.running else { return };
        closed.close();
        let pva = closed.pva();
        let slack = SLACK / self.job.aided.log.rate;
        let error = self.job.known.and_then(|known| known.at(t, slack)).map(|truth| {
            let error = NavError::between(&pva, truth);
            (error, closed.nees(&error))
        });
        let states = closed.states().collect();
        let (sigma, sensors) = (closed.sigma(), closed.sensor_errors());
        self.found.rows.push(Row { t, pva, sigma, sensors, states, error });
    }
}

/// Advances by a share of a sample.
fn part<const N: usize>(closed: &mut ClosedLoop<N>, whole: &Increments, dt: f64, share: f64) {
    if share == 1.0 {
        return closed.advance(whole, dt);
    }
    closed.advance(&Increments { dtheta: whole.dtheta * share, dv: whole.dv * share }, dt * share);
}
