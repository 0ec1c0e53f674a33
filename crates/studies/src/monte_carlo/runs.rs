//! Runs of a study, all under the same stretch of the motion at a time.

use std::{
    collections::VecDeque,
    ops::Range,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use rayon::prelude::*;
use schuler_frames::{Vec3, with_phi, with_position_error};
use schuler_imu::{
    Octet, Stream,
    random::{Draws, STEPS},
};
use schuler_strapdown::{LANES, Pva};

use super::{group::Group, scene::Scene};
use crate::{Error, Progress};

/// Samples of a stretch of time, for which the motion is calculated once for all runs: at its end they wait for each other, and
/// each takes 300 bytes.
const STRETCH: u64 = 32_768;
/// Samples that eight runs are taken on at a time, while a thread has them: the shorter, the less the threads wait.
const PIECE: u64 = 4096;

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
    // At rest there is no motion to calculate, and nothing to wait for.
    let stretch = if scene.steady { u64::MAX } else { STRETCH };
    let mut from = 0;
    while from < scene.study.samples {
        let end = scene.study.samples.min(from.saturating_add(stretch));
        let seen = Group::seen(scene, from, end);
        advance(scene, &mut groups, from..end, &seen, progress)?;
        from = end;
    }
    let errors = groups.into_iter().flat_map(|group| group.errors.into_iter().flatten()).collect();
    Ok(Chunk { first, errors })
}

/// Takes all groups through the samples `stretch`, in which they go through what is `seen`. Each thread takes the one that is the
/// furthest behind, so that they end together.
fn advance(
    scene: &Scene,
    groups: &mut [Group],
    stretch: Range<u64>,
    seen: &[Octet],
    progress: &dyn Progress,
) -> Result<(), Error> {
    let waiting: VecDeque<_> = groups.iter_mut().map(|group| (stretch.start, group)).collect();
    let waiting = Mutex::new(waiting);
    let queue = || waiting.lock().unwrap_or_else(PoisonError::into_inner);
    let failed = AtomicBool::new(false);
    (0..rayon::current_num_threads()).into_par_iter().with_max_len(1).try_for_each(|_| {
        while !failed.load(Ordering::Relaxed) {
            let Some((from, group)) = queue().pop_front() else { break };
            let end = stretch.end.min(from + PIECE);
            let seen =
                if scene.steady { seen } else { &seen[((from - stretch.start) / STEPS as u64) as usize..] };
            group.advance(scene, from, end, seen).inspect_err(|_| failed.store(true, Ordering::Relaxed))?;
            progress.advance(group.errors.len() as u64);
            if end < stretch.end {
                queue().push_back((end, group));
            }
        }
        Ok(())
    })
}

/// Units of progress that a run is worth.
pub fn units(scene: &Scene) -> u64 {
    scene.study.samples.div_ceil(PIECE)
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
