//! What can be wrong with a filter's input.

/// Why a filter cannot be built or updated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterError {
    /// More states or sources than the capacity chosen.
    #[error("the filter needs room for {need} states and sources but its capacity is {capacity}")]
    Capacity {
        /// Room needed so far.
        need: usize,
        /// The capacity N.
        capacity: usize,
    },
    /// A process couples more states than the closed forms are made for.
    #[error("a process that couples {states} states is not supported, at most 2")]
    Coupled {
        /// Number of states that act upon each other.
        states: usize,
    },
    /// A measurement's noise covariance is not positive definite.
    #[error(
        "the noise of a measurement must have a positive definite covariance, but pivot {row} is {pivot}"
    )]
    Noise {
        /// Row of the pivot.
        row: usize,
        /// The pivot that should be positive.
        pivot: f64,
    },
    /// A measurement or a prediction that is not a finite number.
    #[error("row {row} of a measurement is not a finite number")]
    NotFinite {
        /// Row of the measurement.
        row: usize,
    },
    /// Correlated noise where only independent noise is taken.
    #[error("the noise of rows {row} and {column} must be independent here")]
    Correlated {
        /// One row.
        row: usize,
        /// The other.
        column: usize,
    },
    /// A standard deviation that is negative or not a finite number.
    #[error("state {state} needs a standard deviation of zero or more, not {sigma}")]
    Sigma {
        /// Number of the state.
        state: usize,
        /// What was given.
        sigma: f64,
    },
    /// The covariance has lost what makes it one; nothing that follows would mean anything.
    #[error("the variance {variance} of an innovation is not positive: the covariance is broken")]
    Covariance {
        /// Predicted variance of the innovation.
        variance: f64,
    },
    /// A state that the filter does not have.
    #[error("there is no state {state}: the filter has {n}")]
    NoState {
        /// Number asked for.
        state: usize,
        /// Number of states.
        n: usize,
    },
}
