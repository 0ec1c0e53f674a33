//! Sums over runs, method by method and row by row.

use super::run::{Row, Trace};

/// Sums over runs of one method at one row.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sums {
    /// Runs that had an attitude.
    pub count: u64,
    /// Of the squares of the nine errors (dr, dv, phi).
    pub squares: [f64; 9],
    /// Of the method's own variances of phi.
    pub variances: [f64; 3],
    /// Of its own covariances of phi north and down.
    pub cross: f64,
    /// Of the normalized estimation error squared, and how many had one.
    pub nees: f64,
    pub with_nees: u64,
    /// Of the normalized innovations squared of all updates up to the row, and of their degrees of freedom.
    pub nis: f64,
    pub nis_freedom: u64,
}

impl Sums {
    fn add(&mut self, row: &Row) {
        let errors = row.error.as_array();
        if errors.iter().any(|e| e.is_nan()) {
            return;
        }
        self.count += 1;
        for (sum, e) in self.squares.iter_mut().zip(errors) {
            *sum += e * e;
        }
        for (sum, s) in self.variances.iter_mut().zip(row.sigma) {
            *sum += s * s;
        }
        self.cross += row.cross;
        if row.nees.is_finite() {
            self.nees += row.nees;
            self.with_nees += 1;
        }
        self.nis += row.tally.nis;
        self.nis_freedom += row.tally.rows;
    }

    fn merge(&mut self, other: &Sums) {
        self.count += other.count;
        self.squares.iter_mut().zip(other.squares).for_each(|(a, b)| *a += b);
        self.variances.iter_mut().zip(other.variances).for_each(|(a, b)| *a += b);
        self.cross += other.cross;
        self.nees += other.nees;
        self.with_nees += other.with_nees;
        self.nis += other.nis;
        self.nis_freedom += other.nis_freedom;
    }

    /// Root mean squares of the nine errors; NaN where no run had an attitude.
    pub fn rms(&self) -> [f64; 9] {
        self.squares.map(|s| (s / self.count as f64).sqrt())
    }

    /// Root mean squares of the method's own standard deviations.
    pub fn sigma(&self) -> [f64; 3] {
        self.variances.map(|s| (s / self.count as f64).sqrt())
    }

    /// Mean normalized innovation squared a degree of freedom of the updates since `before`, and their degrees of freedom: 1 if the
    /// filter is consistent. Without any the mean is NaN.
    pub fn nis_since(&self, before: Option<&Sums>) -> (f64, u64) {
        let (sum, freedom) = before.map_or((0.0, 0), |b| (b.nis, b.nis_freedom));
        // A run that failed meanwhile is in one of the sums alone.
        if before.is_some_and(|b| b.count != self.count) {
            return (f64::NAN, 0);
        }
        let freedom = self.nis_freedom - freedom;
        ((self.nis - sum) / freedom as f64, freedom)
    }

    /// Mean normalized estimation error squared a degree of freedom: 1 if the method is consistent.
    pub fn nees_ratio(&self) -> f64 {
        self.nees / (3 * self.with_nees) as f64
    }
}

/// All methods over a group of runs.
#[derive(Clone, Debug, Default)]
pub struct Totals {
    /// Method by method, row by row.
    pub sums: Vec<Vec<Sums>>,
    /// Errors phi at the end of the alignment, method by method, run by run.
    pub finals: Vec<Vec<[f64; 3]>>,
    /// Runs without an attitude at the end, and the first reason, method by method.
    pub failures: Vec<(u64, Option<String>)>,
}

impl Totals {
    /// Adds a run, whose alignment ends at the row `end`.
    pub fn add(&mut self, traces: &[Trace], end: usize) {
        if self.sums.is_empty() {
            self.sums = traces.iter().map(|t| vec![Sums::default(); t.rows.len()]).collect();
            self.finals = vec![Vec::new(); traces.len()];
            self.failures = vec![(0, None); traces.len()];
        }
        for (i, trace) in traces.iter().enumerate() {
            for (sums, row) in self.sums[i].iter_mut().zip(&trace.rows) {
                sums.add(row);
            }
            self.finals[i].push(trace.rows[end].error.phi.as_array());
            if let Some(why) = &trace.failure {
                self.failures[i].0 += 1;
                self.failures[i].1.get_or_insert_with(|| why.clone());
            }
        }
    }

    /// Appends a group of later runs.
    pub fn merge(&mut self, other: Totals) {
        if self.sums.is_empty() {
            *self = other;
            return;
        }
        for (sums, others) in self.sums.iter_mut().zip(&other.sums) {
            sums.iter_mut().zip(others).for_each(|(a, b)| a.merge(b));
        }
        for (finals, others) in self.finals.iter_mut().zip(other.finals) {
            finals.extend(others);
        }
        for (failure, other) in self.failures.iter_mut().zip(other.failures) {
            failure.0 += other.0;
            if failure.1.is_none() {
                failure.1 = other.1;
            }
        }
    }
}
