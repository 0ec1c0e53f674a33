//! Mean, standard deviation and extremes of one error, in one pass.

/// Running moments (Welford) and extremes.
#[derive(Clone, Copy, Debug)]
pub struct Statistics {
    n: f64,
    mean: f64,
    squares: f64,
    min: f64,
    max: f64,
}

impl Default for Statistics {
    fn default() -> Self {
        Statistics { n: 0.0, mean: 0.0, squares: 0.0, min: f64::INFINITY, max: f64::NEG_INFINITY }
    }
}

impl Statistics {
    /// One value more.
    pub fn add(&mut self, x: f64) {
        self.n += 1.0;
        let from_old = x - self.mean;
        self.mean += from_old / self.n;
        self.squares += from_old * (x - self.mean);
        self.min = self.min.min(x);
        self.max = self.max.max(x);
    }

    /// Mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation about the mean (n - 1); NaN for a single value.
    pub fn deviation(&self) -> f64 {
        (self.squares / (self.n - 1.0)).sqrt()
    }

    /// Smallest value.
    pub fn min(&self) -> f64 {
        self.min
    }

    /// Largest value.
    pub fn max(&self) -> f64 {
        self.max
    }

    /// Largest distance from the mean.
    pub fn largest(&self) -> f64 {
        (self.max - self.mean).max(self.mean - self.min)
    }
}
