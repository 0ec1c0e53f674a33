//! Linear ways with a filter: the covariance of truth and filter together for each source, and responses of constants
//! through the gains.
//!
//! r are the navigation errors that are left after what the filter has taken out, s the states of the true source, b the
//! filter's estimates of its own source states. The gains K are those of the filter's model, whatever is true:
//!
//! ```text
//! r := Phi_nn r + Phi_ns s - Phi_nb b,   s := Phi_ss s + w,   b := Phi_bb b          (time)
//! nu = h_n r + h_s s - h_b b + v,        r := r - K_n nu,     b := b + K_b nu        (measurement)
//! ```
//!
//! Source: the sensitivity equations of sub-optimal filters, Gelb (ed.), Applied Optimal Estimation, chapter 7, written for what
//! is left in place of the whole error, which no filter keeps small.

use nalgebra::{DMatrix, DVector, SVector};
use rayon::prelude::*;
use schuler_imu::{Instrument, Truth as Seen};
use schuler_strapdown::Pva;
use schuler_strapdown::filter::{
    Accumulator, Filter, FilterError, Form, Model, NavState, Now, Propagation, Row,
};

use super::super::columns::Moving;
use super::super::covariance::{Sample, TOGETHER, samples};
use super::super::scene::Scene;
use super::super::source::{Kind, Nine, Noise, ROOM, Source};
use super::{Interval, MOST_STATES, begun, measured, room, schedule};
use crate::Error;
use crate::scenario::{Aid, Aiding, BudgetFilter, MeasuredKind};

/// What the linear ways say.
pub struct Linear {
    /// Covariance of the true errors that each source leaves: source, row.
    pub covariance: Vec<Vec<Nine>>,
    /// Errors of one standard deviation of each constant source: source, row; empty for others.
    pub columns: Vec<Vec<[f64; 9]>>,
    /// The filter's own covariance, row by row.
    pub own: Vec<Nine>,
}

/// All linear ways of a scene with a filter.
///
/// # Errors
/// The filter meets numbers that make no sense.
pub fn linear(scene: &Scene, filter: &BudgetFilter, sources: &[Source]) -> Result<Linear, Error> {
    let found = match room(scene, filter) {
        16 => walk::<16>(scene, filter, sources),
        24 => walk::<24>(scene, filter, sources),
        _ => walk::<MOST_STATES>(scene, filter, sources),
    };
    found.map_err(|fault| Error::Filter { fault })
}

fn walk<const N: usize>(
    scene: &Scene,
    settings: &BudgetFilter,
    sources: &[Source],
) -> Result<Linear, FilterError> {
    let mut believing = Believing::<N>::new(scene, settings)?;
    let estimated = believing.filter.model().len() - believing.filter.model().nav_len();
    let mut walkers: Vec<Walker> =
        sources.iter().map(|source| Walker::new(scene, source, estimated)).collect();
    let mut moving = Moving::new(scene, sources);
    let mut estimates = vec![DVector::zeros(estimated); moving.columns.len()];
    let mut columns: Vec<Vec<[f64; 9]>> = vec![Vec::new(); sources.len()];
    keep(&moving, &mut columns);
    let mut own = vec![believing.own()];
    for some in schedule(scene, settings).chunks(TOGETHER) {
        let (first, end) = (some[0].begin, some[some.len() - 1].end);
        let samples = samples(scene, first, end);
        let of = |begin: u64, end: u64| &samples[(begin - first) as usize..(end - first) as usize];
        let mut passed = Vec::with_capacity(some.len());
        for interval in some {
            passed.push(believing.pass(scene, settings, interval, of(interval.begin, interval.end))?);
            if scene.rows.binary_search(&interval.end).is_ok() {
                own.push(believing.own());
            }
        }
        walkers.par_iter_mut().for_each(|walker| {
            for p in &passed {
                walker.over(scene, settings, p, of(p.begin, p.end));
            }
        });
        for p in &passed {
            moving.over(p.begin, p.end);
            respond(scene, sources, &mut moving, p, &mut estimates);
            if scene.rows.binary_search(&p.end).is_ok() {
                keep(&moving, &mut columns);
            }
        }
    }
    Ok(Linear { covariance: walkers.into_iter().map(|w| w.rows).collect(), columns, own })
}

/// An interval as every source passes it.
struct Passed {
    begin: u64,
    end: u64,
    /// How the filter's source states move, and what they do to its navigation errors: b × b and 9 × b.
    phi_bb: DMatrix<f64>,
    phi_nb: DMatrix<f64>,
    /// Scalar measurements at its end, in their order, and what the sensors see then.
    gains: Vec<Gain>,
    seen: Seen,
}

/// A scalar measurement and what the filter makes of it.
struct Gain {
    kind: MeasuredKind,
    axis: usize,
    /// Sensitivity to navigation errors, to the gyro error along body axes, and through that to the filter's states.
    h_n: SVector<f64, 9>,
    h_gyro: [f64; 3],
    h_b: DVector<f64>,
    k_n: SVector<f64, 9>,
    k_b: DVector<f64>,
}

/// The filter on its way.
struct Believing<const N: usize> {
    filter: Filter<N>,
    stepper: Stepper<N>,
    /// Number of each of the nine errors among its states.
    places: [Option<usize>; 9],
}

impl<const N: usize> Believing<N> {
    fn new(scene: &Scene, settings: &BudgetFilter) -> Result<Believing<N>, FilterError> {
        let filter = begun::<N>(scene, settings)?;
        let stepper = Stepper::new(scene, filter.model().clone());
        let places = NavState::ALL.map(|state| filter.model().nav_index(state));
        Ok(Believing { filter, stepper, places })
    }

    /// What it believes of the nine errors.
    fn own(&self) -> Nine {
        Nine::from_fn(|i, j| self.places[i].zip(self.places[j]).map_or(0.0, |(a, b)| self.filter.p[(a, b)]))
    }

    fn pass(
        &mut self,
        scene: &Scene,
        settings: &BudgetFilter,
        interval: &Interval,
        samples: &[Sample],
    ) -> Result<Passed, FilterError> {
        let step = self.stepper.over(scene, samples);
        self.filter.propagate(&step);
        let (phi, first) = (step.phi(), self.filter.model().nav_len());
        let count = self.filter.model().len() - first;
        let moment = scene.whole_moment(scene.time(interval.end));
        let seen = samples.last().map_or_else(|| scene.seen(interval.begin, 1), |(_, seen, _)| *seen);
        let now = Now { pva: moment.pva, seen, dt: scene.dt };
        let mut gains = Vec::new();
        for &kind in &interval.due {
            let Some(aid) = aid(&settings.believed, kind) else { continue };
            let observation = measured(kind, aid, &moment, [0.0; 3], scene.vertical).observe(&now);
            for row in 0..observation.len {
                let (h_nav, h_gyro) = (observation.h_nav[row], observation.h_gyro[row]);
                gains.push(self.gain(kind, row, h_nav, h_gyro, observation.r[row][row], &now)?);
            }
        }
        Ok(Passed {
            begin: interval.begin,
            end: interval.end,
            phi_bb: DMatrix::from_fn(count, count, |i, j| phi[(first + i, first + j)]),
            phi_nb: DMatrix::from_fn(9, count, |i, j| {
                self.places[i].map_or(0.0, |place| phi[(place, first + j)])
            }),
            gains,
            seen,
        })
    }

    /// The gain of one scalar measurement of variance `r`, which the filter then takes.
    fn gain(
        &mut self,
        kind: MeasuredKind,
        axis: usize,
        h_nav: [f64; 9],
        h_gyro: [f64; 3],
        r: f64,
        now: &Now,
    ) -> Result<Gain, FilterError> {
        let (first, len) = (self.filter.model().nav_len(), self.filter.model().len());
        let h_b = DVector::from_fn(len - first, |k, _| {
            if h_gyro == [0.0; 3] {
                return 0.0;
            }
            let mut unit = SVector::<f64, N>::zeros();
            unit[first + k] = 1.0;
            let error = self.filter.model().sensor_error(Instrument::Gyro, &unit, &now.seen, now.dt);
            h_gyro.iter().zip(error).map(|(h, e)| h * e).sum()
        });
        let navigation = self.places.iter().zip(h_nav).filter_map(|(place, h)| Some(((*place)?, h)));
        let sources = h_b.iter().enumerate().map(|(k, h)| (first + k, *h));
        let row = Row::<N>::from_pairs(navigation.chain(sources));
        let mut k = SVector::<f64, N>::zeros();
        for (state, h) in row.pairs() {
            k += self.filter.p.column(state) * h;
        }
        k /= row.dot(k.as_slice()) + r;
        let mut noise = [[0.0; 3]; 3];
        noise[0][0] = r;
        self.filter.update_rows(&[row], [0.0; 3], &noise)?;
        Ok(Gain {
            kind,
            axis,
            h_n: h_nav.into(),
            h_gyro,
            h_b,
            k_n: SVector::from_fn(|i, _| self.places[i].map_or(0.0, |place| k[place])),
            k_b: DVector::from_fn(len - first, |i, _| k[first + i]),
        })
    }
}

/// Transition and noise of a model over intervals: exact at rest, gathered from samples along a motion.
struct Stepper<const N: usize> {
    model: Model<N>,
    accumulator: Accumulator<N>,
    /// At rest: number of samples and what they do.
    known: Vec<(u64, Propagation<N>)>,
}

impl<const N: usize> Stepper<N> {
    fn new(scene: &Scene, model: Model<N>) -> Stepper<N> {
        let start: Pva = scene.moment(0.0).0;
        let accumulator = Accumulator::new(&model, scene.dynamics(), &start);
        Stepper { model, accumulator, known: Vec::new() }
    }

    fn over(&mut self, scene: &Scene, samples: &[Sample]) -> Propagation<N> {
        if !scene.steady {
            for (pva, seen, increments) in samples {
                self.accumulator.step_seen(&self.model, pva, seen, increments, scene.dt);
            }
            return self.accumulator.close(&self.model);
        }
        let count = samples.len() as u64;
        if let Some((_, step)) = self.known.iter().find(|(c, _)| *c == count) {
            return step.clone();
        }
        let (pva, f_b) = scene.moment(0.0);
        let system = Form::Phi.system(&scene.dynamics(), &pva, f_b);
        let step = Propagation::exact(&self.model, &system, &scene.seen(0, count), scene.time(count));
        self.known.push((count, step.clone()));
        step
    }
}

/// One source on its way: truth and filter.
struct Walker {
    stepper: Stepper<ROOM>,
    /// Number of true states: nine and those of the source.
    truth: usize,
    /// Of r, s and b.
    p: DMatrix<f64>,
    noise: Option<Noise>,
    rows: Vec<Nine>,
}

impl Walker {
    fn new(scene: &Scene, source: &Source, estimated: usize) -> Walker {
        let model = source.model(&scene.study.imu.spec);
        let (truth, start) = (model.len(), source.start(scene, &model));
        let all = truth + estimated;
        let mut p = DMatrix::zeros(all, all);
        p.view_mut((0, 0), (truth, truth)).copy_from(&start.view((0, 0), (truth, truth)));
        let noise = match source.kind {
            Kind::Noise(noise) => Some(noise),
            _ => None,
        };
        let rows = vec![nine(&p)];
        Walker { stepper: Stepper::new(scene, model), truth, p, noise, rows }
    }

    fn over(&mut self, scene: &Scene, settings: &BudgetFilter, passed: &Passed, samples: &[Sample]) {
        let step = self.stepper.over(scene, samples);
        let (phi, q) = (step.phi(), step.q());
        let (truth, all) = (self.truth, self.p.nrows());
        let mut a = DMatrix::zeros(all, all);
        a.view_mut((0, 0), (truth, truth)).copy_from(&phi.view((0, 0), (truth, truth)));
        a.view_mut((0, truth), (9, all - truth)).copy_from(&-&passed.phi_nb);
        a.view_mut((truth, truth), (all - truth, all - truth)).copy_from(&passed.phi_bb);
        self.p = &a * &self.p * a.transpose();
        for i in 0..truth {
            for j in 0..truth {
                self.p[(i, j)] += q[(i, j)];
            }
        }
        for gain in &passed.gains {
            self.update(scene, settings, gain, passed);
        }
        if scene.rows.binary_search(&passed.end).is_ok() {
            self.rows.push(nine(&self.p));
        }
    }

    /// P := (I - k h') P (I - k h')' + k k' r, with r the true variance where the noise is this source.
    fn update(&mut self, scene: &Scene, settings: &BudgetFilter, gain: &Gain, passed: &Passed) {
        let (truth, all) = (self.truth, self.p.nrows());
        let (mut h, mut k) = (DVector::zeros(all), DVector::zeros(all));
        h.rows_mut(0, 9).copy_from(&gain.h_n);
        k.rows_mut(0, 9).copy_from(&gain.k_n);
        if gain.h_gyro != [0.0; 3] {
            for state in 9..truth {
                let mut unit = SVector::<f64, ROOM>::zeros();
                unit[state] = 1.0;
                let error = self.stepper.model.sensor_error(Instrument::Gyro, &unit, &passed.seen, scene.dt);
                h[state] = gain.h_gyro.iter().zip(error).map(|(h, e)| h * e).sum();
            }
        }
        for b in 0..all - truth {
            (h[truth + b], k[truth + b]) = (-gain.h_b[b], -gain.k_b[b]);
        }
        let same = |noise: &Noise| noise.kind == gain.kind && noise.axis == gain.axis;
        let r = self.noise.filter(same).and_then(|noise| aid(&settings.aiding, noise.kind));
        let r = r.map_or(0.0, |aid| aid.sigma[gain.axis].powi(2));
        let c = &self.p * &h;
        let nu = h.dot(&c) + r;
        for j in 0..all {
            for i in 0..all {
                self.p[(i, j)] += k[i] * k[j] * nu - k[i] * c[j] - c[i] * k[j];
            }
        }
    }
}

fn nine(p: &DMatrix<f64>) -> Nine {
    Nine::from_fn(|i, j| 0.5 * (p[(i, j)] + p[(j, i)]))
}

/// The settings of one kind of measurement.
fn aid(aiding: &Aiding, kind: MeasuredKind) -> Option<&Aid> {
    super::measurements(aiding).find(|(k, _)| *k == kind).map(|(_, aid)| aid)
}

/// What the filter does to the columns of constants over an interval that they have passed by themselves.
fn respond(
    scene: &Scene,
    sources: &[Source],
    moving: &mut Moving,
    passed: &Passed,
    estimates: &mut [DVector<f64>],
) {
    let constant = sources.iter().zip(&moving.places).filter_map(|(source, place)| Some((source, (*place)?)));
    for (source, place) in constant {
        let b = &mut estimates[place];
        let mut r = SVector::<f64, 9>::from(moving.columns.column(place));
        r -= SVector::<f64, 9>::from_column_slice((&passed.phi_nb * &*b).as_slice());
        *b = &passed.phi_bb * &*b;
        let gyro = match scene.regressor(source, &passed.seen, scene.dt) {
            Some((Instrument::Gyro, column)) => {
                column.map(|c| c * source.size().map_or(0.0, |size| size.value))
            }
            _ => [0.0; 3],
        };
        for gain in &passed.gains {
            let by_gyro: f64 = gain.h_gyro.iter().zip(gyro).map(|(h, e)| h * e).sum();
            let nu = gain.h_n.dot(&r) + by_gyro - gain.h_b.dot(b);
            r -= gain.k_n * nu;
            *b += &gain.k_b * nu;
        }
        moving.columns.set(place, r.into());
    }
}

/// A row of the columns.
fn keep(moving: &Moving, columns: &mut [Vec<[f64; 9]>]) {
    for (rows, place) in columns.iter_mut().zip(&moving.places) {
        rows.extend(place.map(|k| moving.columns.column(k)));
    }
}
