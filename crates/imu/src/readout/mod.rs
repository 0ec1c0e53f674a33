//! The readout: what happens to the sum of input and errors before it is a sample, exact and non-linear.
//!
//! In this order: bandwidth, time of sampling, range, least significant bit, faults of transmission.

use crate::error::Error;

mod axes;
mod bandwidth;
mod chain;
mod faults;
mod window;

pub use bandwidth::{Bandwidth, Sampling};
pub(crate) use chain::{Chain, ChainState, DRAWS};
pub use faults::Faults;
pub use window::Timing;

/// Readout of both instruments.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Readout {
    /// Gyroscopes.
    pub gyro: Channel,
    /// Accelerometers.
    pub accel: Channel,
}

/// Readout of one instrument; the default passes everything through.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Channel {
    /// Second-order low pass; `None` for unlimited bandwidth.
    pub bandwidth: Option<Bandwidth>,
    /// Whether a sample is a mean or a point value of the low pass.
    pub sampling: Sampling,
    /// Delay and jitter of the sampling.
    pub timing: Timing,
    /// Smallest and largest input that is measured, per axis, rad/s or m/s²; beyond, the sample is
    /// flagged and clamped.
    pub range: Option<[(f64, f64); 3]>,
    /// Rounding to a least significant bit.
    pub lsb: Option<Lsb>,
    /// What the device puts out, and so what is rounded.
    pub output: Output,
    /// Samples that get lost on the way.
    pub faults: Faults,
}

/// Rounding to a least significant bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lsb {
    /// Size per axis: rad or m/s of increments, rad/s or m/s² of rates.
    pub size: [f64; 3],
    /// Whether the remainder is carried to the next sample, so that the sum of samples is off by half a
    /// bit at most.
    pub carry: bool,
}

/// What a device puts out. A [`Sample`](crate::Sample) has both forms in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Output {
    /// Integrals over the sample interval.
    #[default]
    Increments,
    /// Means over the sample interval.
    Rates,
}

/// What the readout did to a sample of one instrument.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status {
    /// Axes that were out of range.
    pub saturated: [bool; 3],
    /// The sample was lost: its increments are zero.
    pub dropped: bool,
    /// The sample is the one before once more.
    pub repeated: bool,
    /// The output is stuck at an earlier sample.
    pub stuck: bool,
}

impl Readout {
    /// Checks all numbers.
    ///
    /// # Errors
    /// The first number that makes no sense, with what it must be.
    pub fn validate(&self) -> Result<(), Error> {
        for channel in [&self.gyro, &self.accel] {
            channel.validate()?;
        }
        Ok(())
    }
}

impl Channel {
    fn validate(&self) -> Result<(), Error> {
        let positive = |name, value: f64| need(value > 0.0 && value.is_finite(), name, value, "above zero");
        if let Some(b) = self.bandwidth {
            positive("bandwidth.natural_frequency", b.natural_frequency)?;
            positive("bandwidth.damping", b.damping)?;
        } else if self.sampling == Sampling::Point {
            return Err(Error::Readout {
                name: "sampling",
                value: 0.0,
                need: "the mean unless there is a bandwidth: white noise has no point value",
            });
        }
        for (low, high) in self.range.iter().flatten() {
            need(low < high, "range", *low, "below the upper end of its axis")?;
        }
        for size in self.lsb.iter().flat_map(|l| l.size) {
            positive("lsb", size)?;
        }
        self.timing.validate()?;
        self.faults.validate()
    }
}

/// `Ok` where `condition` holds.
fn need(condition: bool, name: &'static str, value: f64, need: &'static str) -> Result<(), Error> {
    if condition { Ok(()) } else { Err(Error::Readout { name, value, need }) }
}
