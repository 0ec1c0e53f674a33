//! A budget with a filter running: what each source leaves when the filter takes out what it believes, its gains fixed by its
//! own model, its own start and its own noises, whatever is true.

mod linear;
pub mod nominal;
mod runs;
mod walker;

pub use linear::linear;
pub use runs::{Track, run};

use schuler_frames::Vec3;
use schuler_strapdown::filter::measurement::{ALL, HORIZONTAL};
use schuler_strapdown::filter::{
    Filter, FilterError, Heading, Height, Measurement, Model, NavStates, Position, Velocity,
};
use schuler_strapdown::{Vertical, filter::Form};

use super::scene::Scene;
use super::source::measurements;
use crate::scenario::{Aid, Aiding, BudgetFilter, MeasuredKind};
use crate::simulate::aiding;
use crate::trajectory::Moment;

/// Most states that a filter may have.
pub const MOST_STATES: usize = 64;

/// An interval between measurements and rows.
pub struct Interval {
    pub begin: u64,
    pub end: u64,
    /// What is measured at its end, in this order.
    pub due: Vec<MeasuredKind>,
}

/// The intervals of a scene: each ends at a measurement, at a row, or when it is [long](super::covariance::longest).
pub fn schedule(scene: &Scene, filter: &BudgetFilter) -> Vec<Interval> {
    let longest = super::covariance::longest(scene);
    let due = |k: u64| -> Vec<MeasuredKind> {
        let t = scene.time(k);
        measurements(&filter.aiding)
            .filter(|(_, aid)| {
                let out = aid.outages.iter().any(|[begin, end]| (*begin..*end).contains(&t));
                k.is_multiple_of(aid.stride) && !out
            })
            .map(|(kind, _)| kind)
            .collect()
    };
    let mut all = Vec::new();
    let mut begin = 0;
    let mut rows = scene.rows.iter().skip(1).peekable();
    for end in 1..=scene.rows.last().copied().unwrap_or(0) {
        let row = rows.next_if(|row| **row == end).is_some();
        let due = due(end);
        if row || !due.is_empty() || end - begin == longest {
            all.push(Interval { begin, end, due });
            begin = end;
        }
    }
    all
}

/// The settings of one kind of measurement.
fn aid(aiding: &Aiding, kind: MeasuredKind) -> Option<&Aid> {
    measurements(aiding).find(|(k, _)| *k == kind).map(|(_, aid)| aid)
}

/// The navigation errors that the filter estimates.
fn states(scene: &Scene) -> NavStates {
    if scene.vertical == Vertical::Held { NavStates::HELD } else { NavStates::ALL }
}

/// The filter at its start.
///
/// # Errors
/// It needs more than `N` states.
fn begun<const N: usize>(scene: &Scene, filter: &BudgetFilter) -> Result<Filter<N>, FilterError> {
    Filter::new(Model::new(Form::Phi, states(scene), &filter.spec)?, &filter.sigma)
}

/// Room for the states of the filter: 16, 24 or [`MOST_STATES`].
fn room(scene: &Scene, filter: &BudgetFilter) -> usize {
    let fits16 = begun::<16>(scene, filter).is_ok();
    let fits24 = begun::<24>(scene, filter).is_ok();
    if fits16 {
        16
    } else if fits24 {
        24
    } else {
        MOST_STATES
    }
}

/// Whether the filter has more states than there is room for.
pub fn too_large(scene: &Scene, filter: &BudgetFilter) -> Option<FilterError> {
    begun::<MOST_STATES>(scene, filter).err()
}

/// A measurement at `moment` with the errors `noise` (north, east, down; a heading has the first), as the filter takes it: with
/// the standard deviations of `aid`.
fn measured(
    kind: MeasuredKind,
    aid: &Aid,
    moment: &Moment,
    noise: [f64; 3],
    vertical: Vertical,
) -> Box<dyn Measurement> {
    let lever = Vec3::claim(aid.lever_arm);
    let axes = if vertical == Vertical::Held { HORIZONTAL } else { ALL };
    match kind {
        MeasuredKind::Position => Box::new(Position {
            position: aiding::position(&moment.pva, aid.lever_arm, Vec3::claim(noise)),
            sigma: aid.sigma,
            lever,
            axes,
        }),
        MeasuredKind::Velocity => Box::new(Velocity {
            v_t: aiding::velocity(moment, aid.lever_arm) + Vec3::claim(noise),
            sigma: aid.sigma,
            lever,
            axes,
        }),
        MeasuredKind::Height => Box::new(Height {
            // Down is positive in the noise.
            h: aiding::position(&moment.pva, aid.lever_arm, Vec3::new(0.0, 0.0, noise[0])).h,
            sigma: aid.sigma[0],
            lever,
        }),
        MeasuredKind::Heading => {
            Box::new(Heading { yaw: moment.pva.c_tb.as_euler().yaw + noise[0], sigma: aid.sigma[0] })
        }
    }
}
