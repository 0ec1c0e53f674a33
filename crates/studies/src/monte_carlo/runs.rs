//! Runs of a study, all under the same stretch of the motion at a time.

use rayon::prelude::*;
use schuler_frames::{Vec3, with_phi, with_position_error};
use schuler_imu::{Stream, random::Draws};
use schuler_strapdown::{LANES, Pva};

use super::{group::Group, scene::Scene};
use crate::{Error, Progress};

/// Samples of a stretch of time, for which the motion is calculated once for all runs: at its end they wait for each other, which
/// costs less the longer it is, and each takes 300 bytes.
const STRETCH: usize = 16_384;

/// Navigation errors of consecutive runs at each row.
#[derive(Clone, Debug, PartialEq)]
pub struct Chunk {
    /// Number of the first run.
    pub first: u64,
    /// Errors in the order of [`NavError::as_array`], row by row, run by run.
    pub errors: Vec<[f64; 9]>,
}

impl Chunk {
    /// Run by run its rows.
    pub fn runs(&self, rows: usize) -> impl Iterator<Item = &[[f64; 9]]> {
        self.errors.chunks_exact(rows)
    }
}

/// The runs `first..last`: run i is a pure function of the scenario, the seed and i.
///
/// # Errors
/// The IMU refuses its list; a run gives no numbers.
pub fn runs(scene: &Scene, first: u64, last: u64, progress: &dyn Progress) -> Result<Chunk, Error> {
    let starts = (first..last).step_by(LANES);
    let group = |k: u64| {
        let streams = (k..last.min(k + LANES as u64)).map(|run| Stream { seed: scene.seed, run });
        let streams: Vec<Stream> = streams.collect();
        let starts: Vec<Pva> = streams.iter().map(|stream| start(scene, *stream)).collect();
        Group::new(scene, &scene.study.imu.spec, streams, |lane, _| Ok(starts[lane]))
    };
    let mut groups = starts.map(group).collect::<Result<Vec<_>, _>>()?;
    let mut from = 0;
    while from < scene.study.samples {
        let end = scene.study.samples.min(from + STRETCH as u64);
        let seen = Group::seen(scene, from, end);
        groups.par_iter_mut().try_for_each(|group| {
            group.advance(scene, from, end, &seen)?;
            progress.advance(group.errors.len() as u64);
            Ok::<(), Error>(())
        })?;
        from = end;
    }
    let errors = groups.into_iter().flat_map(|group| group.errors.into_iter().flatten()).collect();
    Ok(Chunk { first, errors })
}

/// Units of progress that a run is worth.
pub fn units(scene: &Scene) -> u64 {
    scene.study.samples.div_ceil(STRETCH as u64)
}

/// Where a run begins: the truth and its initial errors.
fn start(scene: &Scene, stream: Stream) -> Pva {
    let mut sum = [0.0; 9];
    for initial in &scene.study.initial_sigmas {
        let sigmas = [initial.position, initial.velocity, initial.phi];
        let [draw, ..] = Draws::new(stream, &initial.name).normals(0);
        (0..9).for_each(|k| sum[k] += sigmas[k / 3][k % 3] * draw);
    }
    let part = |k: usize| [sum[k], sum[k + 1], sum[k + 2]];
    let Pva { position, v_t, c_tb } = scene.states[0];
    Pva {
        position: with_position_error(position, Vec3::claim(part(0))),
        v_t: v_t + Vec3::claim(part(3)),
        c_tb: with_phi(c_tb, Vec3::claim(part(6))),
    }
}
