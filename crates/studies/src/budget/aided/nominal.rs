//! The run without errors: what the filter makes of small errors is what it does along it.

use nalgebra::{DMatrix, DVector, SVector};
use schuler_imu::{Instrument, Truth as Seen};
use schuler_strapdown::System;
use schuler_strapdown::filter::{Filter, FilterError, Propagation, Row};

use super::super::passage::{Drive, Passage, Passages, Sample};
use super::super::scene::Scene;
use super::super::source::Nine;
use super::{Interval, aid, begun, measured};
use crate::navigate::aided::ClosedLoop;
use crate::scenario::{BudgetFilter, MeasuredKind};
use schuler_strapdown::filter::NavState;

/// An interval as every source passes it; its end is a measurement, a row or a time update of the filter.
pub struct Passed {
    pub begin: u64,
    pub end: u64,
    /// Transition of the nine errors, and what the drives of the truth do to them.
    pub phi_nn: Nine,
    pub responses: Vec<SVector<f64, 9>>,
    /// What the estimates that are taken out of the samples do: 9 × b. They keep their value over the interval.
    pub phi_nb: DMatrix<f64>,
    /// How the estimates then go on, where the filter has made its time update and they do not stay, b × b.
    pub phi_bb: Option<DMatrix<f64>>,
    /// Scalar measurements at its end, in their order, and what the sensors see then.
    pub gains: Vec<Gain>,
    pub seen: Seen,
    /// What the filter believes of the nine errors at its end, if that is a row.
    pub own: Option<Nine>,
}

/// A scalar measurement and what the filter makes of it.
pub struct Gain {
    pub kind: MeasuredKind,
    pub axis: usize,
    /// Sensitivity to navigation errors, to the gyro error along body axes, and through that to the filter's states.
    pub h_n: SVector<f64, 9>,
    pub h_gyro: [f64; 3],
    pub h_b: DVector<f64>,
    pub k_n: SVector<f64, 9>,
    pub k_b: DVector<f64>,
}

/// Navigator and filter on their way without errors.
///
/// The same loop as that of the runs: its gains are those of the runs to first order, however samples are gathered and
/// wherever the filter ends its intervals, because its innovations are zero (but for what the navigator's own steps leave).
#[derive(Clone)]
pub struct Nominal<'a, const N: usize> {
    scene: &'a Scene<'a>,
    settings: &'a BudgetFilter,
    closed: ClosedLoop<N>,
    /// Drives of the truth, then the estimates.
    passages: Passages<'a>,
    truths: usize,
    /// Samples since the last time update, and how estimates go on over some such number.
    since: u64,
    known: Vec<(u64, Option<DMatrix<f64>>)>,
}

impl<'a, const N: usize> Nominal<'a, N> {
    /// At the start of a scene; `drives` are those of the truth.
    ///
    /// # Errors
    /// The filter needs more than `N` states.
    pub fn new(
        scene: &'a Scene<'a>,
        settings: &'a BudgetFilter,
        drives: &[Drive],
    ) -> Result<Self, FilterError> {
        let mut filter = begun::<N>(scene, settings)?;
        // Known values are no errors.
        filter.x.fill(0.0);
        let pva = scene.moment(0.0).0;
        let closed = ClosedLoop::with(filter, &pva, scene.study.mechanization.gravity, scene.vertical);
        let truths = drives.len();
        let mut drives = drives.to_vec();
        for component in settings.spec.components() {
            let process = component.evolution().linear_model();
            for c in &process.c[..process.n] {
                drives.push(Drive::of_filter(component, *c, &settings.spec));
            }
        }
        let passages = Passages::new(scene, drives);
        Ok(Nominal { scene, settings, closed, passages, truths, since: 0, known: Vec::new() })
    }

    /// Number of the filter's states beside the navigation errors.
    pub fn estimated(&self) -> usize {
        let model = self.closed.filter().model();
        model.len() - model.nav_len()
    }

    /// What the filter believes of the nine errors now.
    pub fn own(&self) -> Nine {
        let mut closed = self.closed.clone();
        closed.close();
        let (places, p) = (places(closed.filter()), closed.filter().p);
        Nine::from_fn(|i, j| places[i].zip(places[j]).map_or(0.0, |(a, b)| p[(a, b)]))
    }

    /// Goes on over an interval and adds it to `out`, in pieces where the filter makes a time update within.
    ///
    /// # Errors
    /// The filter meets numbers that make no sense.
    pub fn pass(
        &mut self,
        interval: &Interval,
        samples: &[Sample],
        out: &mut Vec<Passed>,
    ) -> Result<(), FilterError> {
        let mut first = 0;
        for (k, sample) in samples.iter().enumerate() {
            self.closed.advance(&sample.increments, self.scene.dt);
            self.since += 1;
            let last = k + 1 == samples.len();
            if last || self.closed.since_close() == 0.0 {
                let mut passed = self.piece(interval.begin, first, &samples[first..=k]);
                if last {
                    self.measure(&interval.due, &mut passed)?;
                } else {
                    passed.phi_bb = self.updated();
                }
                out.push(passed);
                first = k + 1;
            }
        }
        Ok(())
    }

    fn piece(&mut self, begin: u64, first: usize, samples: &[Sample]) -> Passed {
        let begin = begin + first as u64;
        let end = begin + samples.len() as u64;
        let Passage { phi, mut responses } = self.passages.pass(begin, end, samples);
        let estimates = responses.split_off(self.truths);
        Passed {
            begin,
            end,
            phi_nn: phi,
            responses,
            phi_nb: DMatrix::from_fn(9, estimates.len(), |i, j| estimates[j][i]),
            phi_bb: None,
            gains: Vec::new(),
            seen: samples.last().map_or_else(|| self.scene.seen(begin, 1), |sample| sample.seen),
            own: None,
        }
    }

    /// The end of an interval.
    fn measure(&mut self, due: &[MeasuredKind], passed: &mut Passed) -> Result<(), FilterError> {
        let scene = self.scene;
        if !due.is_empty() {
            self.closed.close();
        }
        if self.closed.since_close() == 0.0 {
            passed.phi_bb = self.updated();
        }
        let moment = scene.whole_moment(scene.time(passed.end));
        for &kind in due {
            let Some(aid) = aid(&self.settings.believed, kind) else { continue };
            let taken = measured(kind, aid, &moment, [0.0; 3], scene.vertical);
            let now = self.closed.now();
            let observation = taken.observe(&now);
            let mut filter = self.closed.filter().clone();
            for row in 0..observation.len {
                let h = (observation.h_nav[row], observation.h_gyro[row]);
                passed.gains.push(gain(&mut filter, kind, row, h, observation.r[row][row], |filter, k| {
                    error(filter, k, &now.seen, now.dt)
                })?);
            }
            self.closed.measure(taken.as_ref())?;
        }
        if scene.rows.binary_search(&passed.end).is_ok() {
            passed.own = Some(self.own());
        }
        Ok(())
    }

    /// How the estimates go on after a time update; `None` where they stay.
    fn updated(&mut self) -> Option<DMatrix<f64>> {
        let count = std::mem::take(&mut self.since);
        if let Some((_, known)) = self.known.iter().find(|(c, _)| *c == count) {
            return known.clone();
        }
        let nothing = System {
            f: nalgebra::SMatrix::zeros(),
            b_gyro: nalgebra::SMatrix::zeros(),
            b_accel: nalgebra::SMatrix::zeros(),
        };
        let model = self.closed.filter().model();
        let step = Propagation::exact(model, &nothing, &self.scene.seen(0, 1), self.scene.time(count));
        let (phi, first) = (step.phi(), model.nav_len());
        let n = model.len() - first;
        let phi_bb = DMatrix::from_fn(n, n, |i, j| phi[(first + i, first + j)]);
        let stays = phi_bb == DMatrix::identity(n, n);
        let known = (!stays).then_some(phi_bb);
        self.known.push((count, known.clone()));
        known
    }
}

/// Number of each of the nine errors among the states of a filter.
fn places<const N: usize>(filter: &Filter<N>) -> [Option<usize>; 9] {
    NavState::ALL.map(|state| filter.model().nav_index(state))
}

/// Error of the gyro along body axes by a unit of the source state `k` of a filter.
fn error<const N: usize>(filter: &Filter<N>, k: usize, seen: &Seen, dt: f64) -> [f64; 3] {
    let mut unit = SVector::<f64, N>::zeros();
    unit[k] = 1.0;
    filter.model().sensor_error(Instrument::Gyro, &unit, seen, dt)
}

/// The gain of one scalar measurement of variance `r`, which the filter then takes: the row of its sensitivity to navigation
/// errors and to the gyro error, which its states make by `gyro`.
fn gain<const N: usize>(
    filter: &mut Filter<N>,
    kind: MeasuredKind,
    axis: usize,
    (h_nav, h_gyro): ([f64; 9], [f64; 3]),
    r: f64,
    gyro: impl Fn(&Filter<N>, usize) -> [f64; 3],
) -> Result<Gain, FilterError> {
    let (first, len, places) = (filter.model().nav_len(), filter.model().len(), places(filter));
    let h_b = DVector::from_fn(len - first, |k, _| {
        if h_gyro == [0.0; 3] {
            return 0.0;
        }
        h_gyro.iter().zip(gyro(filter, first + k)).map(|(h, e)| h * e).sum()
    });
    let navigation = places.iter().zip(h_nav).filter_map(|(place, h)| Some(((*place)?, h)));
    let sources = h_b.iter().enumerate().map(|(k, h)| (first + k, *h));
    let row = Row::<N>::from_pairs(navigation.chain(sources));
    let mut k = SVector::<f64, N>::zeros();
    for (state, h) in row.pairs() {
        k += filter.p.column(state) * h;
    }
    k /= row.dot(k.as_slice()) + r;
    filter.update_scalar(&row, 0.0, r)?;
    Ok(Gain {
        kind,
        axis,
        h_n: h_nav.into(),
        h_gyro,
        h_b,
        k_n: SVector::from_fn(|i, _| places[i].map_or(0.0, |place| k[place])),
        k_b: DVector::from_fn(len - first, |i, _| k[first + i]),
    })
}
