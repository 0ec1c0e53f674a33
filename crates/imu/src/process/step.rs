/// One exact step of a process with at most two states: with standard normals w1, w2, w3,
///
/// ```text
/// x1' = phi x + n11 w1
/// x2' = phi x + n21 w1 + n22 w2
/// y   = mean x + n31 w1 + n32 w2 + n33 w3
/// ```
///
/// where y is the mean of the coefficient over the interval. The three rows are drawn jointly, so
/// that state and mean have their exact covariance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// Transition of the states.
    pub phi: [[f64; 2]; 2],
    /// Interval mean of the coefficient per state at the start of the interval.
    pub mean: [f64; 2],
    /// Lower triangular factor of the covariance of (x1, x2, y).
    pub noise: [[f64; 3]; 3],
}

impl Step {
    /// All zero.
    pub const NONE: Step = Step { phi: [[0.0; 2]; 2], mean: [0.0; 2], noise: [[0.0; 3]; 3] };

    /// A step with one state: `x' = phi x + n11 w1`, `y = mean x + n31 w1 + n33 w3`.
    pub fn first_order(phi: f64, mean: f64, [n11, n31, n33]: [f64; 3]) -> Step {
        Step {
            phi: [[phi, 0.0], [0.0, 0.0]],
            mean: [mean, 0.0],
            noise: [[n11, 0.0, 0.0], [0.0; 3], [n31, 0.0, n33]],
        }
    }
}

/// What one step of a process needs: decides how an injector keeps it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Nothing: the coefficient keeps the first state of [`ProcessKind::initial`](super::ProcessKind::initial).
    Constant,
    /// No state, a normal.
    White,
    /// One state, a normal.
    First,
    /// Two states, a normal.
    Second,
    /// Two states that move freely, without noise.
    Free,
}
