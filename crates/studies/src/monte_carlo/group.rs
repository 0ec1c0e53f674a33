//! Runs of the full navigator, in lanes of eight.

use schuler_frames::Vec3;
use schuler_imu::{Imu, Sample, Spec, Stream, Truth as Seen};
use schuler_strapdown::{Coning, Eight, Increments, LANES, LocalLevelLanes, NavError, Pva};

use crate::{Error, course::Course, navigator::Navigator, scenario::Frame};

/// Samples that one run is ahead of its neighbours: what eight instruments say of them stays in the nearest cache.
const BLOCK: usize = 32;

/// Samples as long as this (s) are navigated run by run: each takes trigonometry, for which lanes are no help.
const LONGEST: f64 = 0.3;

/// Up to eight runs side by side.
pub struct Group {
    streams: Vec<Stream>,
    imus: Vec<Imu>,
    navigators: Navigators,
    /// At rest, errors that keep their value give the same sample every time: it is made once.
    same: bool,
    samples: Vec<[Sample; BLOCK]>,
    block: Vec<Increments<Eight>>,
    /// Of each run its rows so far, in the order of [`NavError::as_array`].
    pub errors: Vec<Vec<[f64; 9]>>,
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
            samples: vec![[Sample::default(); BLOCK]; imus.len()],
            errors: vec![Vec::with_capacity(course.rows.len()); imus.len()],
            block: vec![still; BLOCK],
            streams,
            imus,
            navigators,
        };
        group.note(course, 0)?;
        Ok(group)
    }

    /// What a steady course is seen as, for [`Group::advance`]: at rest a stretch is like any other.
    pub fn still(course: &Course) -> Vec<Seen> {
        vec![course.seen(0, 1); BLOCK]
    }

    /// The samples `from..end`, whose truth stands in `stretch`; at rest in its first entries, again and again.
    ///
    /// # Errors
    /// A run gives no numbers.
    pub fn advance(&mut self, course: &Course, from: u64, end: u64, stretch: &[Seen]) -> Result<(), Error> {
        let mut at = from;
        while at < end {
            // Where a block begins in the middle of eight samples, it ends with them: instruments then go on by eights.
            let row = course.rows[self.errors[0].len()];
            let next = (at / BLOCK as u64 + 1) * BLOCK as u64;
            let until = next.min(row).min(end);
            let seen = if course.steady { 0 } else { (at - from) as usize };
            let count = (until - at) as usize;
            if !self.same || at == 0 {
                let count = if self.same { BLOCK } else { count };
                self.measure(course.dt, &stretch[seen..seen + count]);
            }
            self.navigate(course.dt, count);
            at = until;
            if at == row {
                self.note(course, row)?;
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
