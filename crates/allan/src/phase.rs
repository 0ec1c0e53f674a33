use crate::AllanError;

/// Integrated rate at equal steps: the angle of a gyro (rad), the velocity of an accelerometer (m/s).
///
/// All deviations of this crate are those of the *rate* of this quantity. The linear trend is immaterial to all of
/// them, and integration from a rate removes the mean first because a large mean costs digits.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    x: Vec<f64>,
    tau0: f64,
}

impl Phase {
    /// From rate samples, each the mean over its interval of `tau0` seconds (rad/s, m/s²).
    ///
    /// # Errors
    /// A sample that is not finite, a constant column, fewer than three samples, a bad interval.
    pub fn from_rate(rate: &[f64], tau0: f64) -> Result<Self, AllanError> {
        check(rate, tau0, 3)?;
        let mean = sum(rate) / rate.len() as f64;
        let mut x = Vec::with_capacity(rate.len() + 1);
        let mut sum = 0.0;
        x.push(0.0);
        x.extend(rate.iter().map(|r| {
            sum += r - mean;
            sum * tau0
        }));
        Ok(Self { x, tau0 })
    }

    /// From increments, each the integral of the rate over its interval of `tau0` seconds (rad, m/s).
    ///
    /// # Errors
    /// As [`Phase::from_rate`].
    pub fn from_increments(increments: &[f64], tau0: f64) -> Result<Self, AllanError> {
        let mut phase = Self::from_rate(increments, tau0)?;
        for x in &mut phase.x {
            *x /= tau0;
        }
        Ok(phase)
    }

    /// From samples of the integrated quantity itself (rad, m/s).
    ///
    /// # Errors
    /// A sample that is not finite, a constant column, fewer than four samples, a bad interval.
    pub fn from_phase(x: Vec<f64>, tau0: f64) -> Result<Self, AllanError> {
        check(&x, tau0, 4)?;
        Ok(Self { x, tau0 })
    }

    /// The samples; one more than there are rate samples.
    #[must_use]
    pub fn samples(&self) -> &[f64] {
        &self.x
    }

    /// Sample interval (s).
    #[must_use]
    pub fn tau0(&self) -> f64 {
        self.tau0
    }
}

/// In eight sums side by side.
fn sum(samples: &[f64]) -> f64 {
    let (chunks, rest) = samples.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for chunk in chunks {
        for (sum, s) in sums.iter_mut().zip(chunk) {
            *sum += s;
        }
    }
    sums.iter().chain(rest).sum()
}

fn check(samples: &[f64], tau0: f64, need: usize) -> Result<(), AllanError> {
    if !(tau0 > 0.0 && tau0.is_finite()) {
        return Err(AllanError::SampleInterval(tau0));
    }
    // Without a way out on the way, the loop runs in lanes.
    let finite = samples.iter().fold(true, |all, s| all & s.is_finite());
    if !finite && let Some(index) = samples.iter().position(|s| !s.is_finite()) {
        return Err(AllanError::NotFinite { index, value: samples[index] });
    }
    if samples.len() < need {
        return Err(AllanError::TooShort { got: samples.len(), need, what: "an Allan variance" });
    }
    if samples.iter().all(|s| *s == samples[0]) {
        return Err(AllanError::Constant { count: samples.len(), value: samples[0] });
    }
    Ok(())
}
