//! Linear ways with a filter: the covariance of truth and filter together for each source, responses of constants through
//! the gains, and both backward from the last row.
//!
//! r are the navigation errors that are left after what the filter has taken out, s the states of the true source, b the
//! filter's estimates of its own source states, which are taken out of the samples. The gains K are those of the filter's
//! model, whatever is true:
//!
//! ```text
//! r := Phi_nn r + Phi_ns s - Phi_nb b,   s := Phi_ss s + w                           (samples)
//! b := Phi_bb b                                                                      (time update of the filter)
//! nu = h_n r + h_s s - h_b b + v,        r := r - K_n nu,     b := b + K_b nu        (measurement)
//! ```
//!
//! Source: the sensitivity equations of sub-optimal filters, Gelb (ed.), Applied Optimal Estimation, chapter 7, written for what
//! is left in place of the whole error, which no filter keeps small.

use nalgebra::{DVector, SVector};
use rayon::prelude::*;
use schuler_imu::Instrument;
use schuler_strapdown::filter::FilterError;

use super::super::columns::Constants;
use super::super::covariance::TOGETHER;
use super::super::passage::{Sample, samples};
use super::super::scene::Scene;
use super::super::source::{Nine, Source};
use super::nominal::{Nominal, Passed};
use super::walker::Walker;
use super::{Interval, MOST_STATES, room, schedule};
use crate::Error;
use crate::scenario::BudgetFilter;

/// Places on the way at which the filter is kept, for the way back: what lies between is made again.
const MOST_KEPT: usize = 256;

/// What the linear ways say.
pub struct Linear {
    /// Covariance of the true errors that each source leaves: source, row.
    pub covariance: Vec<Vec<Nine>>,
    /// Errors of one standard deviation of each constant source: source, row; empty for others.
    pub columns: Vec<Vec<[f64; 9]>>,
    /// Covariance at the last row by the way back: source.
    pub adjoint: Vec<Nine>,
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

/// Some intervals, their samples, and how they are passed.
struct Together {
    first: u64,
    samples: Vec<Sample>,
    passed: Vec<Passed>,
}

impl Together {
    fn new<const N: usize>(
        scene: &Scene,
        nominal: &mut Nominal<N>,
        some: &[Interval],
    ) -> Result<Self, FilterError> {
        let (first, end) = (some[0].begin, some[some.len() - 1].end);
        let samples = samples(scene, first, end);
        let mut passed = Vec::with_capacity(some.len());
        for interval in some {
            let of = (interval.begin - first) as usize..(interval.end - first) as usize;
            nominal.pass(interval, &samples[of], &mut passed)?;
        }
        Ok(Together { first, samples, passed })
    }

    fn of(&self, passed: &Passed) -> &[Sample] {
        &self.samples[(passed.begin - self.first) as usize..(passed.end - self.first) as usize]
    }
}

fn walk<const N: usize>(
    scene: &Scene,
    settings: &BudgetFilter,
    sources: &[Source],
) -> Result<Linear, FilterError> {
    let mut constants = Constants::new(scene, sources);
    let mut nominal = Nominal::<N>::new(scene, settings, &constants.drives)?;
    let estimated = nominal.estimated();
    let mut walkers: Vec<Walker> =
        sources.iter().map(|source| Walker::new(scene, settings, source, estimated)).collect();
    let mut estimates = vec![DVector::zeros(estimated); constants.columns.len()];
    let mut columns: Vec<Vec<[f64; 9]>> = vec![Vec::new(); sources.len()];
    constants.keep(&mut columns);
    let mut own = vec![nominal.own()];
    let intervals = schedule(scene, settings);
    let chunks: Vec<&[Interval]> =
        intervals.chunks(TOGETHER.max(intervals.len().div_ceil(MOST_KEPT))).collect();
    let mut kept = Vec::with_capacity(chunks.len());
    for some in &chunks {
        kept.push(nominal.clone());
        let together = Together::new(scene, &mut nominal, some)?;
        let at = scene.moment(scene.time(together.first)).0;
        walkers.par_iter_mut().for_each(|w| w.on(&at, &together.passed, |p| together.of(p)));
        for passed in &together.passed {
            constants.advance(&passed.phi_nn, &passed.responses);
            respond(scene, sources, &mut constants, passed, &mut estimates);
            if let Some(believed) = passed.own {
                own.push(believed);
                constants.keep(&mut columns);
            }
        }
    }
    for (some, mut nominal) in chunks.into_iter().zip(kept).rev() {
        let together = Together::new(scene, &mut nominal, some)?;
        let at = scene.moment(scene.time(together.first)).0;
        walkers.par_iter_mut().for_each(|w| w.back(&at, &together.passed, |p| together.of(p)));
    }
    let adjoint = walkers.iter().map(Walker::adjoint).collect();
    Ok(Linear { covariance: walkers.into_iter().map(|w| w.rows).collect(), columns, adjoint, own })
}

/// What the filter does to the columns of constants over an interval that they have passed by themselves.
fn respond(
    scene: &Scene,
    sources: &[Source],
    constants: &mut Constants,
    passed: &Passed,
    estimates: &mut [DVector<f64>],
) {
    let constant =
        sources.iter().zip(&constants.places).filter_map(|(source, place)| Some((source, (*place)?)));
    for (source, place) in constant {
        let b = &mut estimates[place];
        let mut r = SVector::<f64, 9>::from(constants.columns.column(place));
        r -= SVector::<f64, 9>::from_column_slice((&passed.phi_nb * &*b).as_slice());
        if let Some(phi_bb) = &passed.phi_bb {
            *b = phi_bb * &*b;
        }
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
        constants.columns.set(place, r.into());
    }
}
