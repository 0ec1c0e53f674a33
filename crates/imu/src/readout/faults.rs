use core::f64::consts::FRAC_1_SQRT_2;

use libm::erfc;

use super::need;
use crate::error::Error;

/// Samples that get lost between sensor and user; all probabilities are per sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Faults {
    /// Probability that a sample is lost. Its increments are zero, and a remainder that is carried
    /// does not make up for them.
    pub drop: f64,
    /// Probability that the sample before comes once more instead.
    pub repeat: f64,
    /// Probability that the output gets stuck at the sample before.
    pub stick: f64,
    /// For how many samples it then is stuck.
    pub stuck_samples: u32,
}

/// What happens to a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    None,
    Drop,
    Repeat,
    Stick,
}

impl Faults {
    pub(super) fn validate(&self) -> Result<(), Error> {
        let parts =
            [("faults.drop", self.drop), ("faults.repeat", self.repeat), ("faults.stick", self.stick)];
        for (name, value) in parts {
            need((0.0..=1.0).contains(&value), name, value, "a probability from 0 to 1")?;
        }
        let sum = self.drop + self.repeat + self.stick;
        need(sum <= 1.0, "faults", sum, "of probabilities whose sum is 1 at most")?;
        let length = f64::from(self.stuck_samples);
        need(self.stick == 0.0 || length > 0.0, "faults.stuck_samples", length, "1 or more")
    }
}

/// Faults by standard normals, which decide as the uniform numbers do that they are of their distribution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Thresholds {
    drop: f64,
    repeat: f64,
    stick: f64,
}

impl Thresholds {
    pub fn new(f: &Faults) -> Thresholds {
        let repeat = f.drop + f.repeat;
        let [drop, repeat, stick] = [f.drop, repeat, repeat + f.stick].map(quantile);
        Thresholds { drop, repeat, stick }
    }

    /// What the standard normal `w` decides.
    #[inline]
    pub fn decide(&self, w: f64) -> Fault {
        if w >= self.stick {
            Fault::None
        } else if w < self.drop {
            Fault::Drop
        } else if w < self.repeat {
            Fault::Repeat
        } else {
            Fault::Stick
        }
    }
}

/// The number below which a standard normal is with probability `p`, by halving; no draw of ours is beyond 8.
fn quantile(p: f64) -> f64 {
    let (mut low, mut high) = (-8.0, 8.0);
    if p == 0.0 {
        return low;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if 0.5 * erfc(-middle * FRAC_1_SQRT_2) < p {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
