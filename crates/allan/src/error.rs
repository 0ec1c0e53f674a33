use thiserror::Error;

/// What can be wrong with a log or a request. Every message names the place, the value and the need.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum AllanError {
    /// A sample is NaN or infinite.
    #[error("sample {index} is {value}: every sample must be a finite number")]
    NotFinite {
        /// Position of the sample, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// All samples are equal: stuck output, or the wrong column.
    #[error(
        "all {count} samples equal {value}: a constant column has no noise to estimate (stuck sensor, or the wrong column?)"
    )]
    Constant {
        /// Number of samples.
        count: usize,
        /// Their common value.
        value: f64,
    },
    /// Fewer samples than the estimate needs.
    #[error("{got} samples are too few: {what} needs at least {need}")]
    TooShort {
        /// Samples there are.
        got: usize,
        /// Samples needed.
        need: usize,
        /// For what.
        what: &'static str,
    },
    /// The sample interval is not a positive finite number of seconds.
    #[error("the sample interval is {0} s: it must be positive, for example 0.01 s for 100 Hz")]
    SampleInterval(f64),
    /// Time does not increase.
    #[error("time goes from {before} s to {after} s at row {index}: it must increase")]
    TimeBackwards {
        /// Row of the later time, from 0.
        index: usize,
        /// Time of the row before.
        before: f64,
        /// Time of this row.
        after: f64,
    },
    /// Rows are missing.
    #[error(
        "{count} gap(s) in time, the first before row {index}: {step} s where {interval} s is usual; split the log at its gaps or name one part"
    )]
    Gap {
        /// Row after the first gap, from 0.
        index: usize,
        /// The step found there.
        step: f64,
        /// The usual step.
        interval: f64,
        /// Number of gaps.
        count: usize,
    },
    /// Steps differ from the usual one without being gaps.
    #[error(
        "time is not uniform: the step before row {index} is {step} s where {interval} s is usual; resample the log, or give a rate instead of the time column if the stamps only jitter"
    )]
    NonUniform {
        /// Row after the step, from 0.
        index: usize,
        /// The step found there.
        step: f64,
        /// The usual step.
        interval: f64,
    },
    /// A confidence level outside (0, 1).
    #[error("confidence level {0} must lie between 0 and 1, for example 0.95")]
    Confidence(f64),
    /// Equivalent degrees of freedom that are not positive.
    #[error("{0} degrees of freedom: there must be more than none")]
    DegreesOfFreedom(f64),
    /// A fit was asked of an estimate it is not made for.
    #[error("a fit needs overlapping Allan variances: their covariance is known")]
    FitEstimator,
    /// A curve with other averaging times or another length than the fitter was made for.
    #[error("the curve has other averaging times or another length than the one this fitter was made for")]
    FitLayout,
    /// A variance that no noise has.
    #[error(
        "the variance at {tau} s is {variance}: a fit needs positive ones (is the log shorter than its quantization?)"
    )]
    FitVariance {
        /// Averaging time (s).
        tau: f64,
        /// The variance there.
        variance: f64,
    },
    /// No combination of terms has positive coefficients.
    #[error("no combination of noise terms fits the {0} points of the curve")]
    Fit(usize),
}
