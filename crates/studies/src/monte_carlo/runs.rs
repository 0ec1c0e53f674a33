//! Runs of the full navigator, in lanes of eight, all under the same stretch of the motion at a time.

use rayon::prelude::*;
use schuler_frames::{Vec3, with_phi, with_position_error};
use schuler_imu::{Imu, Sample, Stream, Truth as Seen, random::Draws};
use schuler_strapdown::{Coning, Eight, Increments, LANES, LocalLevelLanes, NavError, Pva};

use super::scene::Scene;
use crate::{Error, Progress, navigator::Navigator, scenario::Frame};

/// Samples of a stretch of time, for which the motion is calculated once for all runs.
const STRETCH: usize = 4096;
/// Samples that one run is ahead of its neighbours: what eight instruments say of them stays in the nearest cache.
const BLOCK: usize = 32;

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
    let mut groups: Vec<Group> =
        starts.map(|k| Group::new(scene, k, last.min(k + LANES as u64))).collect::<Result<_, _>>()?;
    // At rest a stretch is like any other.
    let mut stretch: Vec<Seen> = if scene.steady { vec![scene.seen(0, 1); BLOCK] } else { Vec::new() };
    groups.iter_mut().try_for_each(|group| group.note(scene, 0))?;
    let mut from = 0;
    while from < scene.study.samples {
        let end = scene.study.samples.min(from + STRETCH as u64);
        if !scene.steady {
            let count = (end - from) as usize;
            (0..count).into_par_iter().map(|k| scene.seen(from + k as u64, 1)).collect_into_vec(&mut stretch);
        }
        groups.par_iter_mut().try_for_each(|group| {
            group.advance(scene, from, end, &stretch)?;
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

/// Up to eight runs side by side.
struct Group {
    first: u64,
    imus: Vec<Imu>,
    navigators: Navigators,
    /// At rest, errors that keep their value give the same sample every time: it is made once.
    same: bool,
    samples: Vec<[Sample; BLOCK]>,
    block: Vec<Increments<Eight>>,
    /// Of each run its rows so far.
    errors: Vec<Vec<[f64; 9]>>,
}

enum Navigators {
    Lanes(Box<LocalLevelLanes>),
    /// For what lanes do not know: other frames, updates of several samples.
    Alone(Vec<Navigator>),
}

impl Group {
    fn new(scene: &Scene, first: u64, last: u64) -> Result<Group, Error> {
        let how = &scene.study.mechanization;
        let streams: Vec<Stream> = (first..last).map(|run| Stream { seed: scene.seed, run }).collect();
        let starts: Vec<Pva> = streams.iter().map(|stream| start(scene, *stream)).collect();
        let imus = streams
            .iter()
            .map(|stream| Imu::new(&scene.study.imu.spec, *stream))
            .collect::<Result<Vec<_>, _>>()?;
        let navigators = if how.frame == Frame::T && how.coning == Coning::One {
            // The last runs may leave lanes empty.
            let all: [Pva; LANES] = std::array::from_fn(|lane| starts[lane.min(starts.len() - 1)]);
            Navigators::Lanes(Box::new(LocalLevelLanes::new(&all, how.gravity, scene.vertical)))
        } else {
            let alone = |start| Navigator::new(start, how, scene.vertical, scene.dt);
            Navigators::Alone(starts.iter().map(alone).collect())
        };
        let spec = &scene.study.imu.spec;
        let still = Increments { dtheta: Vec3::claim([[0.0; LANES]; 3]), dv: Vec3::claim([[0.0; LANES]; 3]) };
        Ok(Group {
            first,
            same: scene.steady
                && spec.readout.is_none()
                && spec.components().all(|c| c.evolution().is_constant()),
            samples: vec![[Sample::default(); BLOCK]; imus.len()],
            errors: vec![Vec::with_capacity(scene.rows.len()); imus.len()],
            block: vec![still; BLOCK],
            imus,
            navigators,
        })
    }

    /// The samples `from..end`, whose truth stands in `stretch`; at rest in its first entries, again and again.
    fn advance(&mut self, scene: &Scene, from: u64, end: u64, stretch: &[Seen]) -> Result<(), Error> {
        let mut at = from;
        while at < end {
            // Where a block begins in the middle of eight samples, it ends with them: instruments then go on by eights.
            let row = scene.rows[self.errors[0].len()];
            let next = (at / BLOCK as u64 + 1) * BLOCK as u64;
            let until = next.min(row).min(end);
            let seen = if scene.steady { 0 } else { (at - from) as usize };
            let count = (until - at) as usize;
            if !self.same || at == 0 {
                let count = if self.same { BLOCK } else { count };
                self.measure(scene.dt, &stretch[seen..seen + count]);
            }
            self.navigate(scene.dt, count);
            at = until;
            if at == row {
                self.note(scene, row)?;
            }
        }
        Ok(())
    }

    /// What the instruments say.
    fn measure(&mut self, dt: f64, seen: &[Seen]) {
        for (imu, samples) in self.imus.iter_mut().zip(&mut self.samples) {
            imu.steps(dt, seen, samples);
        }
        if let Navigators::Lanes(_) = self.navigators {
            let last = self.samples.len() - 1;
            let each: [&[Sample; BLOCK]; LANES] = std::array::from_fn(|lane| &self.samples[lane.min(last)]);
            for (k, increments) in self.block[..seen.len()].iter_mut().enumerate() {
                *increments = across(&each, k);
            }
        }
    }

    /// Steps with the first `count` samples that were measured last.
    fn navigate(&mut self, dt: f64, count: usize) {
        match &mut self.navigators {
            Navigators::Lanes(lanes) => lanes.steps(&self.block[..count], dt),
            Navigators::Alone(navigators) => {
                for (navigator, samples) in navigators.iter_mut().zip(&self.samples) {
                    for sample in &samples[..count] {
                        navigator.step(&Increments {
                            dtheta: Vec3::claim(sample.dtheta),
                            dv: Vec3::claim(sample.dv),
                        });
                    }
                }
            }
        }
    }

    /// Takes down the errors at a row.
    fn note(&mut self, scene: &Scene, row: u64) -> Result<(), Error> {
        for (lane, errors) in self.errors.iter_mut().enumerate() {
            let pva = match &self.navigators {
                Navigators::Lanes(lanes) => lanes.pva(lane),
                Navigators::Alone(navigators) => navigators[lane].pva(),
            };
            let error = NavError::between(&pva, &scene.states[errors.len()]).as_array();
            if error.iter().any(|x| !x.is_finite()) {
                return Err(Error::Diverged {
                    source_name: format!("number {}", self.first + lane as u64),
                    way: "monte_carlo",
                    time: scene.time(row),
                });
            }
            errors.push(error);
        }
        Ok(())
    }
}

/// Sample `k` of all lanes. Plain loops: iterators over arrays were four times slower.
#[inline(always)]
fn across(samples: &[&[Sample; BLOCK]; LANES], k: usize) -> Increments<Eight> {
    let (mut dtheta, mut dv) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
    for lane in 0..LANES {
        let sample = &samples[lane][k];
        for axis in 0..3 {
            dtheta[axis][lane] = sample.dtheta[axis];
            dv[axis][lane] = sample.dv[axis];
        }
    }
    Increments { dtheta: Vec3::claim(dtheta), dv: Vec3::claim(dv) }
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
