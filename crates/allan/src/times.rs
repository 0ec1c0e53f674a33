use std::ops::Range;

use crate::AllanError;

/// Share of the usual step by which one step may differ before time counts as not uniform. Stamps are often
/// rounded to a milli- or microsecond, which moves a step but not the mean interval.
pub const STEP_TOLERANCE: f64 = 0.1;

/// The sample interval (s) of a uniform time column (s).
///
/// # Errors
/// Time that is not finite or does not increase; a gap (a step of 1.5 times the usual one or more);
/// any other step that differs by more than [`STEP_TOLERANCE`].
pub fn sample_interval(t: &[f64]) -> Result<f64, AllanError> {
    let parts = split_at_gaps(t)?;
    let usual = usual_step(t);
    if parts.len() > 1 {
        let index = parts[1].start;
        let step = t[index] - t[index - 1];
        return Err(AllanError::Gap { index, step, interval: usual, count: parts.len() - 1 });
    }
    Ok((t[t.len() - 1] - t[0]) / (t.len() - 1) as f64)
}

/// The parts of a time column (s) between its gaps, as ranges of rows; one range where there is no gap.
///
/// # Errors
/// As [`sample_interval`], gaps excepted.
pub fn split_at_gaps(t: &[f64]) -> Result<Vec<Range<usize>>, AllanError> {
    if t.len() < 3 {
        return Err(AllanError::TooShort { got: t.len(), need: 3, what: "a sample interval" });
    }
    if let Some(index) = t.iter().position(|s| !s.is_finite()) {
        return Err(AllanError::NotFinite { index, value: t[index] });
    }
    if let Some(i) = t.windows(2).position(|w| w[1] <= w[0]) {
        return Err(AllanError::TimeBackwards { index: i + 1, before: t[i], after: t[i + 1] });
    }
    let usual = usual_step(t);
    let mut parts = Vec::new();
    let mut start = 0;
    for i in 1..t.len() {
        let step = t[i] - t[i - 1];
        if step >= 1.5 * usual {
            parts.push(start..i);
            start = i;
        } else if (step - usual).abs() > STEP_TOLERANCE * usual {
            return Err(AllanError::NonUniform { index: i, step, interval: usual });
        }
    }
    parts.push(start..t.len());
    Ok(parts)
}

/// Median step: a few gaps or jumps do not move it.
fn usual_step(t: &[f64]) -> f64 {
    let mut steps: Vec<f64> = t.windows(2).map(|w| w[1] - w[0]).collect();
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}
