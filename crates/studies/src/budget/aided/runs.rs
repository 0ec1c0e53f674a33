//! Runs of the full navigator with its filter closed.

use schuler_frames::Vec3;
use schuler_imu::{Imu, random::Draws};
use schuler_strapdown::{Increments, NavError};

use super::super::monte_carlo::Run;
use super::super::scene::Scene;
use super::super::source::Kind;
use super::{MOST_STATES, begun, measured, measurements, room, schedule};
use crate::Error;
use crate::monte_carlo::group::finite;
use crate::navigate::aided::ClosedLoop;
use crate::scenario::{Aid, BudgetFilter, MeasuredKind};
use crate::trajectory::Moment;

/// What every run is measured along: sample, kind and true state of each measurement.
pub struct Track {
    events: Vec<(u64, MeasuredKind, Moment)>,
}

impl Track {
    /// The measurements of a scene.
    pub fn new(scene: &Scene, filter: &BudgetFilter) -> Track {
        let due = |i: super::Interval| {
            let moment = scene.whole_moment(scene.time(i.end));
            i.due.into_iter().map(move |kind| (i.end, kind, moment))
        };
        Track { events: schedule(scene, filter).into_iter().flat_map(due).collect() }
    }
}

/// Navigation errors of one run at each row of the scene.
///
/// # Errors
/// The IMU refuses its list; the filter or the navigator meets numbers that make no sense.
pub fn run(scene: &Scene, filter: &BudgetFilter, track: &Track, one: &Run) -> Result<Vec<[f64; 9]>, Error> {
    match room(scene, filter) {
        16 => closed::<16>(scene, filter, track, one),
        24 => closed::<24>(scene, filter, track, one),
        _ => closed::<MOST_STATES>(scene, filter, track, one),
    }
}

fn closed<const N: usize>(
    scene: &Scene,
    settings: &BudgetFilter,
    track: &Track,
    one: &Run,
) -> Result<Vec<[f64; 9]>, Error> {
    let failed = |fault| Error::Filter { fault };
    let mut imu = Imu::new(one.spec, one.stream)?;
    let start = one.begin(scene, &mut imu, false)?;
    let gravity = scene.study.mechanization.gravity;
    let filter = begun::<N>(scene, settings).map_err(failed)?;
    let mut closed = ClosedLoop::with(filter, &start, gravity, scene.vertical);
    let noises: Vec<Noise> =
        measurements(&settings.aiding).map(|(kind, aid)| Noise::new(one, kind, aid)).collect();
    let believed: Vec<(MeasuredKind, &Aid)> = measurements(&settings.believed).collect();
    let mut events = track.events.iter().peekable();
    let mut rows = Vec::with_capacity(scene.rows.len());
    let mut sample = 0;
    for (&row, truth) in scene.rows.iter().zip(&scene.states) {
        while sample < row {
            let felt = imu.step(scene.dt, one.seen(scene, sample));
            let increments = Increments { dtheta: Vec3::claim(felt.dtheta), dv: Vec3::claim(felt.dv) };
            closed.advance(&increments, scene.dt);
            sample += 1;
            while let Some((_, kind, moment)) = events.next_if(|event| event.0 == sample) {
                for ((_, aid), noise) in believed.iter().zip(&noises).filter(|((k, _), _)| k == kind) {
                    let taken = measured(*kind, aid, moment, noise.at(sample), scene.vertical);
                    closed.measure(taken.as_ref()).map_err(failed)?;
                }
            }
        }
        let errors = NavError::between(&closed.pva(), truth).as_array();
        rows.push(finite(errors, one.stream, scene.time(row))?);
    }
    Ok(rows)
}

/// The noise of one kind of measurement, those components that are true in the run.
struct Noise {
    draws: Draws,
    sigma: [f64; 3],
}

impl Noise {
    fn new(one: &Run, kind: MeasuredKind, aid: &Aid) -> Noise {
        let mut sigma = [0.0; 3];
        for source in one.sources {
            if let Kind::Noise(n) = source.kind
                && n.kind == kind
            {
                sigma[n.axis] = aid.sigma[n.axis];
            }
        }
        Noise { draws: Draws::new(one.stream, &format_args!("aiding.{}", kind.name())), sigma }
    }

    fn at(&self, sample: u64) -> [f64; 3] {
        let normals = self.draws.normals(sample);
        std::array::from_fn(|axis| self.sigma[axis] * normals[axis])
    }
}
