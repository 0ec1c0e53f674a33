//! Runs of the full navigator under errors drawn at random.

use rayon::prelude::*;
use schuler_frames::{Vec3, with_phi, with_position_error};
use schuler_imu::{Imu, Spec, Stream, random::Draws};
use schuler_strapdown::{Increments, NavError, Pva};

use super::scene::Scene;
use super::source::{Nine, Source};
use super::{aided, alignment};
use crate::{Error, navigator::Navigator};

/// What every run navigates along: input of the sensors, the true state at each row, and what is measured.
pub struct Track {
    inputs: Vec<schuler_imu::Truth>,
    states: Vec<Pva>,
    measured: Option<aided::Track>,
}

impl Track {
    pub fn new(scene: &Scene) -> Track {
        let inputs = if scene.steady { 1 } else { scene.study.samples };
        Track {
            inputs: (0..inputs).into_par_iter().map(|k| scene.seen(k, 1)).collect(),
            states: scene.rows.iter().map(|&k| scene.moment(scene.time(k)).0).collect(),
            measured: scene.study.filter.as_ref().map(|filter| aided::Track::new(scene, filter)),
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
                let initial = initial(sources, stream);
                Run { track, sources, spec: &spec, initial, stream }.navigate(scene)
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
    /// Navigation errors at each row, by the filter where there is one.
    ///
    /// # Errors
    /// The IMU refuses its list; the alignment finds no attitude; the run gives no numbers.
    pub fn navigate(&self, scene: &Scene) -> Result<Vec<[f64; 9]>, Error> {
        match (&scene.study.filter, &self.track.measured) {
            (Some(filter), Some(measured)) => aided::run(scene, filter, measured, self),
            _ => self.free(scene),
        }
    }

    fn free(&self, scene: &Scene) -> Result<Vec<[f64; 9]>, Error> {
        let mut imu = Imu::new(self.spec, self.stream)?;
        // At rest, errors that keep their value give the same sample every time: it need not be made again.
        let keeps = self.spec.components().all(|c| c.evolution().is_constant());
        let start = self.begin(scene, &mut imu, keeps)?;
        let mut nav = Navigator::new(&start, &scene.study.mechanization, scene.vertical, scene.dt);
        let same = scene.steady && keeps;
        let mut increments = Increments { dtheta: Vec3::ZERO, dv: Vec3::ZERO };
        let mut rows = Vec::with_capacity(scene.rows.len());
        let mut sample = 0;
        for (&row, truth) in scene.rows.iter().zip(&self.track.states) {
            while sample < row {
                if !same || sample == 0 {
                    let measured = imu.step(scene.dt, self.seen(sample));
                    increments =
                        Increments { dtheta: Vec3::claim(measured.dtheta), dv: Vec3::claim(measured.dv) };
                }
                nav.step(&increments);
                sample += 1;
            }
            rows.push(self.finite(NavError::between(&nav.pva(), truth).as_array(), scene.time(row))?);
        }
        Ok(rows)
    }

    /// The computed state at t = 0, after the alignment where there is one; `keeps` says that all errors of the sensors keep
    /// their value.
    pub fn begin(&self, scene: &Scene, imu: &mut Imu, keeps: bool) -> Result<Pva, Error> {
        let Pva { position, v_t, c_tb } = self.track.states[0];
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
    pub fn seen(&self, sample: u64) -> &schuler_imu::Truth {
        let inputs = &self.track.inputs;
        &inputs[if inputs.len() == 1 { 0 } else { sample as usize }]
    }

    /// True states at the rows.
    pub fn states(&self) -> &[Pva] {
        &self.track.states
    }

    /// The errors at the time `t` (s), if they are numbers.
    pub fn finite(&self, errors: [f64; 9], t: f64) -> Result<[f64; 9], Error> {
        if errors.iter().all(|x| x.is_finite()) {
            return Ok(errors);
        }
        let source_name = format!("number {}", self.stream.run);
        Err(Error::Diverged { source_name, way: "monte_carlo", time: t })
    }
}
