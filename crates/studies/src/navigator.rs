//! The navigator that a scenario asks for.

use schuler_strapdown::{
    Coning, EarthFixed, FirstOrder, Increments, Inertial, LocalLevel, Pva, Samples, Vertical, WanderAzimuth,
};

use crate::scenario::{Frame, Mechanization};

/// A mechanization in the frame of a scenario, with the algorithm that makes updates of samples.
pub struct Navigator {
    mechanization: Box<dyn schuler_strapdown::Mechanization + Send>,
    /// None where one sample is one update.
    samples: Option<Samples>,
    /// Interval of an update, s.
    update: f64,
}

impl Navigator {
    /// Starts at `pva`, for samples of `dt` (s).
    pub fn new(pva: &Pva, how: &Mechanization, vertical: Vertical, dt: f64) -> Self {
        let gravity = how.gravity;
        let mechanization: Box<dyn schuler_strapdown::Mechanization + Send> = match how.frame {
            Frame::T => Box::new(LocalLevel::new(pva, gravity, vertical)),
            Frame::Wander => Box::new(WanderAzimuth::new(pva, gravity, vertical)),
            Frame::E => Box::new(<EarthFixed>::new(pva, gravity, vertical)),
            Frame::I => Box::new(<Inertial>::new(pva, gravity, vertical)),
            Frame::Euler => Box::new(FirstOrder::new(pva, gravity, vertical)),
        };
        let samples = (how.coning != Coning::One).then(|| Samples::new(how.coning));
        Navigator { mechanization, samples, update: how.coning.samples() as f64 * dt }
    }

    /// One sample more. The state follows when the update is complete.
    #[inline]
    pub fn step(&mut self, increments: &Increments) {
        match &mut self.samples {
            None => self.mechanization.step(increments, self.update),
            Some(samples) => {
                if let Some(motion) = samples.add(increments) {
                    self.mechanization.advance(&motion, self.update);
                }
            }
        }
    }

    /// The state after the last complete update.
    pub fn pva(&self) -> Pva {
        self.mechanization.pva()
    }
}
