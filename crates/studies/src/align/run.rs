//! One run: draws its errors, hands the same samples to every method, and navigates on with what each has found.

use schuler_frames::{B, Rot, T, Vec3, with_phi};
use schuler_imu::{Imu, Stream, random::Draws};
use schuler_strapdown::filter::Tally;
use schuler_strapdown::{Increments, LocalLevel, Mechanization, NavError, Pva, Samples};

use super::method::{Worker, begin, measure};
use super::place::Place;
use super::scene::Scene;
use crate::Error;
use crate::scenario::{AlignStudy, Coarse, Imu as Instrument, Velocity};

/// What a method is at one row.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Errors, computed minus true; position and velocity once it navigates, attitude NaN while there is none.
    pub error: NavError,
    /// Standard deviations of phi by the method itself, rad; NaN without.
    pub sigma: [f64; 3],
    /// Covariance of phi north and down by the method itself, rad²; zero without.
    pub cross: f64,
    /// Normalized estimation error squared of phi; NaN without.
    pub nees: f64,
    /// Of a filter, what its updates have found so far.
    pub tally: Tally,
    /// Of a filter's last update, north and east: innovations and their standard deviations (m/s or m); NaN without.
    pub innovation: [[f64; 2]; 2],
}

/// What a method did in a run.
pub struct Trace {
    /// One for each row of the scene.
    pub rows: Vec<Row>,
    /// Why there is no attitude at the end of the alignment.
    pub failure: Option<String>,
    /// Standard deviations of a filter's states at the end of the alignment.
    pub states: Vec<f64>,
}

impl Row {
    /// Without anything but errors.
    fn of(error: NavError) -> Row {
        Row {
            error,
            sigma: [f64::NAN; 3],
            cross: 0.0,
            nees: f64::NAN,
            tally: Tally::default(),
            innovation: [[f64::NAN; 2]; 2],
        }
    }
}

const NOTHING: Vec3<T> = Vec3::new(f64::NAN, f64::NAN, f64::NAN);

/// All methods of a study in one run: a pure function of the scene and `stream`.
pub fn run(scene: &Scene, study: &AlignStudy, imu: &Instrument, stream: Stream) -> Result<Vec<Trace>, Error> {
    let coning = study.mechanization.coning;
    let place = Place { position: scene.position, gravity: scene.gravity, vertical: scene.vertical, coning };
    let dt = scene.dt;
    let mut sensors = Imu::new(&imu.spec, stream)?;
    let mut reference = Reference::new(&study.velocity, stream, dt);
    let mut coarse = CoarseWork::new(study, scene, stream);
    let mut workers: Vec<Result<Worker, String>> =
        study.methods.iter().map(|method| Worker::new(method, &place, scene.time(scene.samples))).collect();
    let trace = || Trace { rows: Vec::with_capacity(scene.rows.len()), failure: None, states: Vec::new() };
    let mut traces: Vec<Trace> = workers.iter().map(|_| trace()).collect();
    let mut samples = Samples::new(coning);
    let mut navigators: Vec<Option<Navigator>> = Vec::new();
    let mut rows = scene.rows.iter().peekable();

    for k in 0..scene.samples + scene.navigate {
        if k == coarse.ready {
            begin(&mut workers, &coarse.attitude(&place), &place);
        }
        let sample = sensors.step(dt, &scene.input(k));
        let increments = Increments { dtheta: Vec3::claim(sample.dtheta), dv: Vec3::claim(sample.dv) };
        let done = k + 1;
        if k < scene.samples {
            let motion = samples.add(&increments).expect("invariant: one sample an update");
            coarse.advance(k, &increments, &motion, dt);
            for worker in workers.iter_mut().flatten() {
                worker.advance(&increments, &motion, dt);
            }
            if let Some(velocity) = reference.measured(done) {
                measure(&mut workers, velocity, &place);
            }
        } else {
            for navigator in navigators.iter_mut().flatten() {
                navigator.advance(&increments, dt);
            }
        }
        if done == scene.samples && scene.navigate > 0 {
            navigators = workers.iter().map(|w| Navigator::from(w, &place, &scene.pva(done))).collect();
        }
        if rows.next_if(|row| **row == done).is_some() {
            for (i, trace) in traces.iter_mut().enumerate() {
                let row = match navigators.get(i) {
                    Some(navigator) if done > scene.samples => {
                        navigated(navigator.as_ref(), &scene.pva(done))
                    }
                    _ => aligned(&workers[i], &place, scene, done, trace),
                };
                trace.rows.push(row);
            }
        }
    }
    Ok(traces)
}

fn aligned(worker: &Result<Worker, String>, place: &Place, scene: &Scene, k: u64, trace: &mut Trace) -> Row {
    let found = worker.as_ref().map_err(String::clone).and_then(|w| Ok((w, w.found(place)?)));
    let last = k == scene.samples;
    match found {
        Ok((worker, found)) => {
            let phi = scene.error(found.c_tb, k);
            let error = NavError { phi, ..NavError::default() };
            let sigma = found.sigma.unwrap_or([f64::NAN; 3]);
            if last {
                trace.states = worker.state_sigmas();
            }
            let mut row = Row { sigma, nees: worker.nees(phi).unwrap_or(f64::NAN), ..Row::of(error) };
            if let Some(fine) = worker.fine() {
                row.cross = fine.cross();
                row.tally = fine.filter().tally();
                if let Some(last) = fine.last() {
                    let deviation = |k: usize| last.s[k][k].sqrt();
                    row.innovation = [[last.innovation[0], last.innovation[1]], [deviation(0), deviation(1)]];
                }
            }
            row
        }
        Err(why) => {
            if last {
                trace.failure = Some(why);
            }
            Row::of(NavError { phi: NOTHING, ..NavError::default() })
        }
    }
}

fn navigated(navigator: Option<&Navigator>, truth: &Pva) -> Row {
    Row::of(match navigator {
        Some(navigator) => NavError::between(&navigator.level.pva(), truth),
        None => NavError { dr: NOTHING, dv: NOTHING, phi: NOTHING },
    })
}

/// Free inertial navigation from an alignment on, less the sensor errors that the method knows.
pub struct Navigator {
    level: LocalLevel,
    samples: Samples,
    known: [Vec3<B>; 2],
}

impl Navigator {
    /// From the attitude that a method has found, at the true place and velocity; `None` where it has none.
    pub fn from(worker: &Result<Worker, String>, place: &Place, truth: &Pva) -> Option<Navigator> {
        let worker = worker.as_ref().ok()?;
        let c_tb = worker.found(place).ok()?.c_tb;
        let start = Pva { c_tb, ..*truth };
        Some(Navigator {
            level: LocalLevel::new(&start, place.gravity, place.vertical),
            samples: Samples::new(place.coning),
            known: worker.sensor_errors().map(Vec3::claim),
        })
    }

    /// One sample.
    pub fn advance(&mut self, increments: &Increments, dt: f64) {
        let [gyro, accel] = self.known;
        let freed = Increments { dtheta: increments.dtheta - gyro * dt, dv: increments.dv - accel * dt };
        if let Some(motion) = self.samples.add(&freed) {
            self.level.advance(&motion, dt);
        }
    }

    /// Where it is by its own account.
    pub fn pva(&self) -> Pva {
        self.level.pva()
    }
}

/// The coarse attitude on its way.
struct CoarseWork {
    /// Samples after which it is there; never where nobody needs it.
    ready: u64,
    kind: Working,
}

enum Working {
    None,
    Known(Rot<T, B>),
    Collecting(Box<Worker>),
}

impl CoarseWork {
    fn new(study: &AlignStudy, scene: &Scene, stream: Stream) -> Self {
        let with_error = |phi: [f64; 3]| CoarseWork {
            ready: 0,
            kind: Working::Known(with_phi(scene.c_tb(0), Vec3::claim(phi))),
        };
        let collecting = |ready, worker| CoarseWork { ready, kind: Working::Collecting(Box::new(worker)) };
        match study.coarse {
            None => CoarseWork { ready: u64::MAX, kind: Working::None },
            Some(Coarse::Value(phi)) => with_error(phi),
            Some(Coarse::Sigma([tilt, heading])) => {
                let [n, e, d, _] = Draws::new(stream, &"coarse").normals(0);
                with_error([n * tilt, e * tilt, d * heading])
            }
            Some(Coarse::Triad(ready)) => collecting(ready, Worker::mean()),
            Some(Coarse::Inertial(ready)) => collecting(ready, Worker::inertial(scene.time(ready))),
        }
    }

    fn advance(&mut self, k: u64, increments: &Increments, motion: &schuler_strapdown::BodyMotion, dt: f64) {
        if let Working::Collecting(worker) = &mut self.kind
            && k < self.ready
        {
            worker.advance(increments, motion, dt);
        }
    }

    fn attitude(&self, place: &Place) -> Result<Rot<T, B>, String> {
        match &self.kind {
            Working::None => Err("there is no coarse attitude".into()),
            Working::Known(c_tb) => Ok(*c_tb),
            Working::Collecting(worker) => Ok(worker.found(place)?.c_tb),
        }
    }
}

/// The velocity of the base as it is known: zero, with noise.
struct Reference<'a> {
    velocity: &'a Velocity,
    draws: Draws,
    dt: f64,
    /// Correlated noise now.
    coloured: [f64; 2],
    count: u64,
}

impl<'a> Reference<'a> {
    fn new(velocity: &'a Velocity, stream: Stream, dt: f64) -> Self {
        let draws = Draws::new(stream, &"velocity");
        let sigma = velocity.coloured.map_or(0.0, |(sigma, _)| sigma);
        // It is stationary from the start.
        let [a, b, _, _] = Draws::new(stream, &"velocity.start").normals(0);
        Reference { velocity, draws, dt, coloured: [a * sigma, b * sigma], count: 0 }
    }

    /// The measurement after `k` samples, if there is one.
    fn measured(&mut self, k: u64) -> Option<[f64; 2]> {
        if !k.is_multiple_of(self.velocity.every) {
            return None;
        }
        let [a, b, c, d] = self.draws.normals(self.count);
        self.count += 1;
        if let Some((sigma, tau)) = self.velocity.coloured {
            let keep = (-(self.velocity.every as f64) * self.dt / tau).exp();
            let fresh = sigma * (1.0 - keep * keep).sqrt();
            self.coloured = [self.coloured[0] * keep + c * fresh, self.coloured[1] * keep + d * fresh];
        }
        let t = k as f64 * self.dt;
        let factor = match self.velocity.burst {
            Some(([begin, end], factor)) if begin < t && t <= end => factor,
            _ => 1.0,
        };
        let white = self.velocity.noise;
        Some([(a * white + self.coloured[0]) * factor, (b * white + self.coloured[1]) * factor])
    }
}
