//! Runs of the full navigator under errors drawn at random.

use rayon::prelude::*;
use schuler_frames::{Vec3, with_phi, with_position_error};
use schuler_imu::{
    Imu, Octet, Spec, Stream, Truth as Seen,
    random::{Draws, STEPS},
};
use schuler_strapdown::{LANES, Pva};

use super::scene::Scene;
use super::source::{Nine, Source};
use super::{aided, alignment};
use crate::{Error, monte_carlo::group::Group};

/// What every run navigates along: input of the sensors, and what is measured.
pub struct Track {
    seen: Vec<Octet>,
    /// Errors at each row of a run in which nothing is wrong: what the algorithm makes of finite samples. It is no source's, and is
    /// taken out of all runs.
    own: Vec<[f64; 9]>,
    measured: Option<aided::Track>,
}

impl Track {
    /// The track of a scene.
    ///
    /// # Errors
    /// A run in which nothing is wrong gives no numbers.
    pub fn new(scene: &Scene) -> Result<Track, Error> {
        let measured = scene.study.filter.as_ref().map(|filter| aided::Track::new(scene, filter));
        let mut track = Track { seen: Group::seen(scene, 0, scene.end()), own: Vec::new(), measured };
        let stream = Stream { seed: 0, run: 0 };
        let right = Run { track: &track, sources: &[], spec: &Spec::new(), initial: [0.0; 9], stream };
        track.own = together(scene, &[right])?.concat();
        Ok(track)
    }

    /// Length of the horizontal error that the algorithm leaves by itself at the last row, m.
    pub fn own_horizontal(&self) -> f64 {
        self.own.last().map_or(0.0, |x| x[0].hypot(x[1]))
    }
}

/// Mean squares over the runs of a study under `sources` together, less what the algorithm leaves by itself, one for each row;
/// run i is a pure function of the scenario, `seed` and i.
///
/// # Errors
/// The IMU refuses its list; a run gives no numbers.
pub fn covariance(scene: &Scene, track: &Track, sources: &[Source], seed: u64) -> Result<Vec<Nine>, Error> {
    let all = &scene.study.imu.spec;
    let spec = match sources {
        [source] => source.spec(all),
        _ => all.clone(),
    };
    let runs = scene.study.runs;
    // In batches, so that memory does not grow with the number of runs; summed in the order of their numbers.
    let batch = 64.max(32 * rayon::current_num_threads() as u64);
    let mut sums = vec![Nine::zeros(); scene.rows.len()];
    for first in (0..runs).step_by(batch as usize) {
        let last = runs.min(first + batch);
        let eights: Vec<u64> = (first..last).step_by(LANES).collect();
        let made: Result<Vec<Vec<Vec<[f64; 9]>>>, Error> = eights
            .into_par_iter()
            .map(|k| {
                let runs = (k..last.min(k + LANES as u64)).map(|run| {
                    let stream = Stream { seed, run };
                    Run { track, sources, spec: &spec, initial: initial(sources, stream), stream }
                });
                together(scene, &runs.collect::<Vec<_>>())
            })
            .collect();
        for rows in made?.iter().flatten() {
            for ((sum, row), own) in sums.iter_mut().zip(rows).zip(&track.own) {
                *sum += super::columns::covariance(&std::array::from_fn(|k| row[k] - own[k]));
            }
        }
    }
    Ok(sums.into_iter().map(|sum| sum / runs as f64).collect())
}

/// The nine initial errors of one run.
fn initial(sources: &[Source], stream: Stream) -> [f64; 9] {
    let mut sum = [0.0; 9];
    for source in sources {
        let sigmas = source.initial();
        if sigmas.iter().any(|s| *s != 0.0) {
            let [draw, ..] = Draws::new(stream, &source.name).normals(0);
            (0..9).for_each(|k| sum[k] += sigmas[k] * draw);
        }
    }
    sum
}

/// Navigation errors of up to eight runs at each row, by the filter where there is one. All are under the errors of the first.
///
/// # Errors
/// The IMU refuses its list; the alignment finds no attitude; a run gives no numbers.
pub fn together(scene: &Scene, runs: &[Run]) -> Result<Vec<Vec<[f64; 9]>>, Error> {
    let Some(Run { track, spec, .. }) = runs.first() else { return Ok(Vec::new()) };
    if let (Some(filter), Some(measured)) = (&scene.study.filter, &track.measured) {
        return runs.iter().map(|one| aided::run(scene, filter, measured, one)).collect();
    }
    // Errors of the sensors that all keep their value need not be averaged over an alignment.
    let keeps = spec.components().all(|c| c.evolution().is_constant());
    let streams = runs.iter().map(|one| one.stream).collect();
    let mut group = Group::new(scene, spec, streams, |lane, imu| runs[lane].begin(scene, imu, keeps))?;
    group.advance(scene, 0, scene.end(), &track.seen)?;
    Ok(group.errors)
}

/// One run.
pub struct Run<'a> {
    pub track: &'a Track,
    /// What is true in it.
    pub sources: &'a [Source],
    /// Its sensor errors.
    pub spec: &'a Spec,
    /// Its initial errors.
    pub initial: [f64; 9],
    /// Its random numbers.
    pub stream: Stream,
}

impl Run<'_> {
    /// The computed state at t = 0, after the alignment where there is one; `keeps` says that all errors of the sensors keep
    /// their value.
    pub fn begin(&self, scene: &Scene, imu: &mut Imu, keeps: bool) -> Result<Pva, Error> {
        let Pva { position, v_t, c_tb } = scene.states[0];
        let c_tb = match scene.study.alignment {
            0 => c_tb,
            _ => alignment::attitude(scene, imu, keeps)?,
        };
        let part = |k: usize| Vec3::claim([self.initial[k], self.initial[k + 1], self.initial[k + 2]]);
        Ok(Pva {
            position: with_position_error(position, part(0)),
            v_t: v_t + part(3),
            c_tb: with_phi(c_tb, part(6)),
        })
    }

    /// What the sensors go through in a sample.
    pub fn seen(&self, scene: &Scene, sample: u64) -> &Seen {
        let sample = if scene.steady { 0 } else { sample as usize };
        &self.track.seen[sample / STEPS].truths()[sample % STEPS]
    }
}
