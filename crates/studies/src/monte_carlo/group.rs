//! Runs of the full navigator, in lanes of eight.

use std::ops::Range;

use rayon::prelude::*;
use schuler_frames::Vec3;
use schuler_imu::{Imu, Octet, Spec, Stream, random::STEPS};
use schuler_strapdown::{Coning, Eight, Increments, LANES, LocalLevelLanes, NavError, Pva};

use crate::{Error, course::Course, navigator::Navigator, scenario::Frame};

/// Eights of samples that one run is ahead of its neighbours: what eight instruments say of them stays in the nearest cache.
const AHEAD: usize = 4;
/// The same in samples.
const BLOCK: usize = AHEAD * STEPS;

/// Samples as long as this (s) are navigated run by run: each takes trigonometry, for which lanes are no help.
const LONGEST: f64 = 0.3;

/// Up to eight runs side by side.
pub struct Group {
    streams: Vec<Stream>,
    imus: Vec<Imu>,
    navigators: Navigators,
    /// At rest, errors that keep their value give the same sample every time: it is made once.
    same: bool,
    /// Of each run what its instruments said last.
    said: Vec<Said>,
    /// The same across runs, sample by sample.
    block: Vec<Increments<Eight>>,
    /// Of each run its rows so far, in the order of [`NavError::as_array`].
    pub errors: Vec<Vec<[f64; 9]>>,
}

/// Increments of angle and velocity of a block, eight by eight.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Said([[[[f64; STEPS]; 3]; 2]; AHEAD]);

impl Said {
    const NOTHING: Said = Said([[[[0.0; STEPS]; 3]; 2]; AHEAD]);

    /// Those of a sample.
    fn sample(&self, k: usize) -> Increments {
        let [dtheta, dv] = &self.0[k / STEPS];
        let at = |axes: &[[f64; STEPS]; 3]| axes.map(|axis| axis[k % STEPS]);
        Increments { dtheta: Vec3::claim(at(dtheta)), dv: Vec3::claim(at(dv)) }
    }
}

enum Navigators {
    Lanes(Box<LocalLevelLanes>),
    /// For what lanes do not know: other frames, updates of several samples, long ones.
    Alone(Vec<Navigator>),
}

impl Group {
    /// Runs under the errors of `spec`, of one to eight streams, before their first sample: each begins where `start` says of its
    /// number among them and its instrument.
    ///
    /// # Errors
    /// The IMU refuses its list; a start that is none.
    pub fn new(
        course: &Course,
        spec: &Spec,
        streams: Vec<Stream>,
        start: impl Fn(usize, &mut Imu) -> Result<Pva, Error>,
    ) -> Result<Group, Error> {
        let mut imus = streams.iter().map(|stream| Imu::new(spec, *stream)).collect::<Result<Vec<_>, _>>()?;
        let starts = imus
            .iter_mut()
            .enumerate()
            .map(|(lane, imu)| start(lane, imu))
            .collect::<Result<Vec<Pva>, Error>>()?;
        let how = course.mechanization;
        let navigators = if how.frame == Frame::T && how.coning == Coning::One && course.dt < LONGEST {
            // The last runs may leave lanes empty.
            let all: [Pva; LANES] = std::array::from_fn(|lane| starts[lane.min(starts.len() - 1)]);
            Navigators::Lanes(Box::new(LocalLevelLanes::new(&all, how.gravity, course.vertical)))
        } else {
            let alone = |start| Navigator::new(start, how, course.vertical, course.dt);
            Navigators::Alone(starts.iter().map(alone).collect())
        };
        let still = Increments { dtheta: Vec3::claim([[0.0; LANES]; 3]), dv: Vec3::claim([[0.0; LANES]; 3]) };
        let mut group = Group {
            same: course.steady
                && spec.readout.is_none()
                && spec.components().all(|c| c.evolution().is_constant()),
            said: vec![Said::NOTHING; imus.len()],
            errors: vec![Vec::with_capacity(course.rows.len()); imus.len()],
            block: vec![still; BLOCK],
            streams,
            imus,
            navigators,
        };
        group.note(course, 0)?;
        Ok(group)
    }

    /// What the instruments go through in the samples from `first` on, up to `end`, eight by eight; `first` is a multiple of eight.
    /// A steady course is like any eight of it.
    pub fn seen(course: &Course, first: u64, end: u64) -> Vec<Octet> {
        let calibration = course.imu.spec.calibration_temperature;
        let octet = |k: u64| {
            let truths = std::array::from_fn(|i| course.seen((k + i as u64).min(end - 1), 1));
            Octet::new(truths, course.dt, calibration)
        };
        if course.steady {
            return vec![octet(0)];
        }
        let eights = (end - first).div_ceil(STEPS as u64);
        (0..eights).into_par_iter().map(|k| octet(first + k * STEPS as u64)).collect()
    }

    /// The samples `from..end`, through what is `seen` from `from` on: a multiple of the length of a block.
    ///
    /// # Errors
    /// A run gives no numbers.
    pub fn advance(&mut self, course: &Course, from: u64, end: u64, seen: &[Octet]) -> Result<(), Error> {
        let mut at = from;
        while at < end {
            let within = (at % BLOCK as u64) as usize;
            if within == 0 && (!self.same || at == 0) {
                // A steady course is the same eight samples over and over.
                let (first, times) =
                    if course.steady { (0, AHEAD) } else { ((at - from) as usize / STEPS, 1) };
                self.measure(&seen[first..seen.len().min(first + AHEAD)], times);
            }
            let row = course.rows[self.errors[0].len()];
            let until = (at + (BLOCK - within) as u64).min(row).min(end);
            self.navigate(course.dt, within..within + (until - at) as usize);
            at = until;
            if at == row {
                self.note(course, row)?;
            }
        }
        Ok(())
    }

    /// What the instruments say, `times` of each of what is `seen`.
    fn measure(&mut self, seen: &[Octet], times: usize) {
        for (imu, said) in self.imus.iter_mut().zip(&mut self.said) {
            for (octet, said) in seen.iter().zip(said.0.chunks_mut(times)) {
                imu.octets(octet, said);
            }
        }
        if let Navigators::Lanes(_) = self.navigators {
            let last = self.said.len() - 1;
            let each: [&Said; LANES] = std::array::from_fn(|lane| &self.said[lane.min(last)]);
            for (k, increments) in self.block[..seen.len() * times * STEPS].iter_mut().enumerate() {
                *increments = across(&each, k);
            }
        }
    }

    /// Steps with the samples `range` of what was measured last.
    fn navigate(&mut self, dt: f64, range: Range<usize>) {
        match &mut self.navigators {
            Navigators::Lanes(lanes) => lanes.steps(&self.block[range], dt),
            Navigators::Alone(navigators) => {
                for (navigator, said) in navigators.iter_mut().zip(&self.said) {
                    range.clone().for_each(|k| navigator.step(&said.sample(k)));
                }
            }
        }
    }

    /// Takes down the errors at a row.
    fn note(&mut self, course: &Course, row: u64) -> Result<(), Error> {
        for (lane, errors) in self.errors.iter_mut().enumerate() {
            let pva = match &self.navigators {
                Navigators::Lanes(lanes) => lanes.pva(lane),
                Navigators::Alone(navigators) => navigators[lane].pva(),
            };
            let error = NavError::between(&pva, &course.states[errors.len()]).as_array();
            errors.push(finite(error, self.streams[lane], course.time(row))?);
        }
        Ok(())
    }
}

/// The errors of a run at the time `t` (s), if they are numbers.
///
/// # Errors
/// They are none.
pub fn finite(errors: [f64; 9], run: Stream, t: f64) -> Result<[f64; 9], Error> {
    if errors.iter().all(|x| x.is_finite()) {
        return Ok(errors);
    }
    Err(Error::Diverged { source_name: format!("number {}", run.run), way: "monte_carlo", time: t })
}

/// Sample `k` of all lanes. Plain loops: iterators over arrays were four times slower.
#[inline(always)]
fn across(said: &[&Said; LANES], k: usize) -> Increments<Eight> {
    let (mut dtheta, mut dv) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
    for lane in 0..LANES {
        let [angles, velocities] = &said[lane].0[k / STEPS];
        for axis in 0..3 {
            dtheta[axis][lane] = angles[axis][k % STEPS];
            dv[axis][lane] = velocities[axis][k % STEPS];
        }
    }
    Increments { dtheta: Vec3::claim(dtheta), dv: Vec3::claim(dv) }
}
