//! What no vehicle can do, or no model here follows.

/// The largest speed over ground that is believed, m/s: the Earth's escape velocity and a little.
pub const MAX_SPEED: f64 = 12e3;

/// A part of a trajectory that cannot be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{problem}; expected {expected}", part.map_or(String::new(), |k| format!("part {}: ", k + 1)))]
pub struct Impossible {
    /// Which segment, waypoint or row, from 0, if it is one of them.
    pub part: Option<usize>,
    /// What is wrong.
    pub problem: String,
    /// What would be right.
    pub expected: String,
}

impl Impossible {
    /// Of no part in particular.
    pub fn new(problem: impl Into<String>, expected: impl Into<String>) -> Self {
        Impossible { part: None, problem: problem.into(), expected: expected.into() }
    }

    /// The same of the part `k`, from 0.
    pub fn at(self, k: usize) -> Self {
        Impossible { part: Some(k), ..self }
    }

    /// Refuses a speed (m/s) that is none.
    pub fn speed(speed: f64) -> Result<(), Self> {
        if (0.0..=MAX_SPEED).contains(&speed) {
            return Ok(());
        }
        Err(Self::new(format!("a speed of {speed:.1} m/s"), "0 to 12 km/s"))
    }
}
