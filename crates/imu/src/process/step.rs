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
    /// A step with one state: `x' = phi x + n11 w1`, `y = mean x + n31 w1 + n33 w3`.
    pub fn first_order(phi: f64, mean: f64, [n11, n31, n33]: [f64; 3]) -> Step {
        Step {
            phi: [[phi, 0.0], [0.0, 0.0]],
            mean: [mean, 0.0],
            noise: [[n11, 0.0, 0.0], [0.0; 3], [n31, 0.0, n33]],
        }
    }

    /// Noise of state 0 or 1, or of the mean (2), from three normals.
    #[inline]
    pub(crate) fn noise_of(&self, row: usize, w: [f64; 3]) -> f64 {
        let n = &self.noise[row];
        n[0] * w[0] + n[1] * w[1] + n[2] * w[2]
    }

    /// Moves the states `x` without noise and returns the interval mean.
    #[inline]
    pub(crate) fn coast(&self, x: &mut [f64; 2]) -> f64 {
        let ([x1, x2], phi) = (*x, &self.phi);
        *x = [phi[0][0] * x1 + phi[0][1] * x2, phi[1][0] * x1 + phi[1][1] * x2];
        self.mean[0] * x1 + self.mean[1] * x2
    }
}

/// What one step of a process needs: decides how an injector keeps it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Nothing: the coefficient keeps the first state of [`ProcessKind::initial`](super::ProcessKind::initial).
    Constant,
    /// No state and w3.
    White,
    /// The first state, w1 and w3.
    First,
    /// Two states and three normals.
    Second,
    /// Two states that move freely, without noise.
    Free,
}
