use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};

use super::axes::{Axes, load, store};
use super::need;
use crate::error::Error;

/// When a sample is taken, against the time that it claims.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// A sample of time t covers the interval that ended `delay` seconds before. Different delays make
    /// gyroscopes and accelerometers asynchronous.
    pub delay: f64,
    /// Standard deviation of the delay from sample to sample, s. The delay never falls below zero and
    /// the windows never overlap.
    pub jitter: f64,
}

impl Timing {
    pub(super) fn validate(&self) -> Result<(), Error> {
        for (name, value) in [("timing.delay", self.delay), ("timing.jitter", self.jitter)] {
            need(value >= 0.0 && value.is_finite(), name, value, "zero or more seconds")?;
        }
        Ok(())
    }

    pub(super) fn is_ideal(&self) -> bool {
        *self == Timing::default()
    }
}

/// Intervals that are remembered; a delay beyond them sees the oldest.
const LENGTH: usize = 32;

/// The last intervals of one instrument, and how far the samples lag behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    intervals: [(f64, Axes); LENGTH],
    newest: usize,
    /// Age of the end of the last window, s.
    age: f64,
}

impl Window {
    /// Before the first interval: everything older is the same as that.
    pub const START: Window = Window { intervals: [(0.0, [0.0; 4]); LENGTH], newest: 0, age: 0.0 };

    /// Takes in an interval; returns the integral over the window that is sampled and its length.
    #[inline(always)]
    pub fn sample<S: Simd>(
        &mut self,
        timing: &Timing,
        dt: f64,
        mean: f64x4<S>,
        normal: f64,
        first: bool,
    ) -> (f64x4<S>, f64) {
        if first {
            (self.intervals, self.age) = ([(dt, *mean); LENGTH], timing.delay);
        }
        self.newest = (self.newest + 1) % LENGTH;
        self.intervals[self.newest].0 = dt;
        store(mean, &mut self.intervals[self.newest].1);
        let from = self.age + dt;
        let to = (timing.delay + timing.jitter * normal).clamp(0.0, from);
        self.age = to;
        (self.integral(mean.simd, to, from), from - to)
    }

    #[cfg(feature = "serde")]
    pub const NUMBERS: usize = 2 + 4 * LENGTH;

    /// Hands every number to `each`, to be read or replaced.
    #[cfg(feature = "serde")]
    pub fn visit(&mut self, mut each: impl FnMut(&mut f64)) {
        each(&mut self.age);
        let mut newest = self.newest as f64;
        each(&mut newest);
        self.newest = newest as usize % LENGTH;
        for (dt, mean) in &mut self.intervals {
            each(dt);
            mean[..3].iter_mut().for_each(&mut each);
        }
    }

    /// Integral over the ages from `young` to `old`.
    #[inline(always)]
    fn integral<S: Simd>(&self, simd: S, young: f64, old: f64) -> f64x4<S> {
        let (mut sum, mut age) = (f64x4::splat(simd, 0.0), 0.0);
        for k in 0..LENGTH {
            let (dt, mean) = &self.intervals[(self.newest + LENGTH - k) % LENGTH];
            let end = if k + 1 == LENGTH { f64::INFINITY } else { age + dt };
            if end > young {
                let overlap = old.min(end) - young.max(age);
                sum += load(simd, mean) * overlap;
            }
            age = end;
            if age >= old {
                break;
            }
        }
        sum
    }
}
