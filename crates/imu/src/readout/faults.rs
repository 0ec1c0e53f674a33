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

    /// What the standard normal `w` decides: its probability below is uniform from 0 to 1.
    pub(super) fn decide(&self, w: f64) -> Fault {
        let all = self.drop + self.repeat + self.stick;
        if all == 0.0 {
            return Fault::None;
        }
        let uniform = 0.5 * erfc(-w * FRAC_1_SQRT_2);
        if uniform < self.drop {
            Fault::Drop
        } else if uniform < self.drop + self.repeat {
            Fault::Repeat
        } else if uniform < all {
            Fault::Stick
        } else {
            Fault::None
        }
    }
}
