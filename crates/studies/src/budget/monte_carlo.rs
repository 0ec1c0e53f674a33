//! Runs of the full navigator under sensor errors drawn at random.

use rayon::prelude::*;
use schuler_frames::{Vec3, with_phi, with_position_error};
use schuler_imu::{Imu, Spec, Stream, random::Draws};
use schuler_strapdown::{Increments, NavError, Pva};

use super::scene::Scene;
use super::source::{Nine, Source};
use crate::{Error, navigator::Navigator};

/// What every run navigates along: input of the sensors and the true state at each row.
pub struct Track {
    inputs: Vec<schuler_imu::Truth>,
    states: Vec<Pva>,
}

impl Track {
    pub fn new(scene: &Scene) -> Track {
        let inputs = if scene.steady { 1 } else { scene.study.samples };
        Track {
            inputs: (0..inputs).map(|k| scene.seen(k, 1)).collect(),
            states: scene.rows.iter().map(|&k| scene.moment(scene.time(k)).0).collect(),
        }
    }
}

/// Mean squares over the runs of a study under `sources` together, one for each row; run i is a pure function of the
/// scenario, `seed` and i.
pub fn covariance(scene: &Scene, track: &Track, sources: &[Source], seed: u64) -> Result<Vec<Nine>, Error> {
    let all = &scene.study.imu.spec;
    let spec = match sources {
        [source] => source.spec(all),
        _ => all.clone(),
    };
    let runs = scene.study.runs;
    // In batches, so that memory does not grow with the number of runs; summed in the order of their numbers.
    const BATCH: u64 = 64;
    let mut sums = vec![Nine::zeros(); scene.rows.len()];
    for first in (0..runs).step_by(BATCH as usize) {
        let last = runs.min(first + BATCH);
        let batch: Result<Vec<Vec<[f64; 9]>>, Error> = (first..last)
            .into_par_iter()
            .map(|i| {
                let stream = Stream { seed, run: i };
                run(scene, track, &spec, &initial(sources, stream), stream)
            })
            .collect();
        for rows in batch? {
            for (sum, row) in sums.iter_mut().zip(&rows) {
                *sum += super::columns::covariance(row);
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

/// Navigation errors of one run at each row.
///
/// # Errors
/// The IMU refuses its list; the run gives no numbers.
pub fn run(
    scene: &Scene,
    track: &Track,
    spec: &Spec,
    initial: &[f64; 9],
    stream: Stream,
) -> Result<Vec<[f64; 9]>, Error> {
    let part = |k: usize| [initial[k], initial[k + 1], initial[k + 2]];
    let Pva { position, v_t, c_tb } = track.states[0];
    let start = Pva {
        position: with_position_error(position, Vec3::claim(part(0))),
        v_t: v_t + Vec3::claim(part(3)),
        c_tb: with_phi(c_tb, Vec3::claim(part(6))),
    };
    let mut nav = Navigator::new(&start, &scene.study.mechanization, scene.vertical, scene.dt);
    let mut imu = Imu::new(spec, stream)?;
    // At rest, errors that keep their value give the same sample every time: it need not be made again.
    let same = scene.steady && spec.components().all(|c| c.evolution().is_constant());
    let mut increments = Increments { dtheta: Vec3::ZERO, dv: Vec3::ZERO };
    let mut rows = Vec::with_capacity(scene.rows.len());
    let mut sample = 0;
    for (&row, truth) in scene.rows.iter().zip(&track.states) {
        while sample < row {
            if !same || sample == 0 {
                let seen = &track.inputs[if scene.steady { 0 } else { sample as usize }];
                let measured = imu.step(scene.dt, seen);
                increments =
                    Increments { dtheta: Vec3::claim(measured.dtheta), dv: Vec3::claim(measured.dv) };
            }
            nav.step(&increments);
            sample += 1;
        }
        let errors = NavError::between(&nav.pva(), truth).as_array();
        if errors.iter().any(|x| !x.is_finite()) {
            return Err(Error::Diverged {
                source_name: format!("number {}", stream.run),
                way: "monte_carlo",
                time: scene.time(row),
            });
        }
        rows.push(errors);
    }
    Ok(rows)
}
