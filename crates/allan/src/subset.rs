use nalgebra::{DMatrix, DVector};

use crate::covariance::CovarianceTable;
use crate::gls::{Solution, solve};
use crate::{Curve, Term};

/// A curve and a list of candidate terms, made ready for fitting any subset of them.
pub(crate) struct Problem {
    pub terms: Vec<Term>,
    /// Estimated variances.
    variance: Vec<f64>,
    /// Their averaging times, in seconds and as shares of the log.
    tau: Vec<f64>,
    lengths: Vec<f64>,
    /// Allan variance of each term at each time over the estimate there, columns scaled to a maximum of one.
    shapes: DMatrix<f64>,
    /// Power of a term = scale × its fitted coefficient.
    scale: Vec<f64>,
    table: CovarianceTable,
    /// Relative error of the model itself at each averaging time, independent between them.
    slack: f64,
}

/// A fitted subset.
#[derive(Debug, Clone)]
pub(crate) struct SubsetFit {
    /// Indices into the terms of the problem.
    pub chosen: Vec<usize>,
    /// Power of each chosen term.
    pub powers: Vec<f64>,
    /// Covariance of the powers.
    pub covariance: DMatrix<f64>,
    /// Relative standard error of the correlation time or frequency of each chosen term.
    pub shape_errors: Vec<Option<f64>>,
    /// r' V^-1 r.
    pub chi2: f64,
    /// ln det V + r' V^-1 r: minus twice the log likelihood of the estimates as Gaussian, up to a constant.
    pub deviance: f64,
}

/// Share of a variance added to it: the sums over lags are no better, and neighbours on a dense grid differ by less.
const RIDGE: f64 = 0.003;
/// Reweighting settles by a factor of ten a round or faster.
const ROUNDS: usize = 30;

impl Problem {
    pub fn new(curve: &Curve, terms: &[Term], table: CovarianceTable, slack: f64) -> Self {
        let variance: Vec<f64> = curve.points.iter().map(|p| p.variance).collect();
        let tau: Vec<f64> = curve.points.iter().map(|p| p.tau).collect();
        let mut shapes = DMatrix::from_fn(variance.len(), terms.len(), |i, p| {
            terms[p].allan_variance(tau[i]) / variance[i]
        });
        let mut scale = Vec::new();
        for mut column in shapes.column_iter_mut() {
            let top = column.max();
            column /= top;
            scale.push(1.0 / top);
        }
        let lengths = curve.points.iter().map(|p| p.m as f64 / curve.n_phase as f64).collect();
        Self { terms: terms.to_vec(), variance, tau, lengths, shapes, scale, table, slack }
    }

    /// Number of estimates.
    pub fn points(&self) -> usize {
        self.variance.len()
    }

    /// Covariance of the estimates over the estimates, for scaled coefficients of all terms.
    fn relative_covariance(&self, theta: &[f64]) -> DMatrix<f64> {
        let powers: Vec<f64> = theta.iter().zip(&self.scale).map(|(t, s)| t * s).collect();
        let mut v = self.table.at(&powers);
        for i in 0..v.nrows() {
            v[(i, i)] *= 1.0 + RIDGE;
            for j in 0..v.ncols() {
                v[(i, j)] /= self.variance[i] * self.variance[j];
            }
            v[(i, i)] += self.slack * self.slack;
        }
        v
    }

    /// Reweighted generalised least squares with these terms only; `None` where a coefficient is not positive.
    pub fn fit(&self, chosen: &[usize]) -> Option<SubsetFit> {
        let a = self.shapes.select_columns(chosen);
        let y = DVector::from_element(self.variance.len(), 1.0);
        // Start: relative errors that grow with the averaging time, as the degrees of freedom fall.
        let start = DMatrix::from_diagonal(&DVector::from_column_slice(&self.lengths));
        let mut now = solve(&a, &y, start)?;
        for _ in 0..ROUNDS {
            let mut theta = vec![0.0; self.terms.len()];
            for (c, t) in chosen.iter().zip(now.theta.iter()) {
                theta[*c] = t.max(1e-9);
            }
            let next = solve(&a, &y, self.relative_covariance(&theta))?;
            let moved = (&next.theta - &now.theta).amax() / next.theta.amax();
            now = next;
            if moved < 1e-6 {
                break;
            }
        }
        if now.theta.iter().all(|t| *t > 0.0) { Some(self.finish(chosen, &now)) } else { None }
    }

    /// The unconstrained coefficient of term `extra` beside those of `fit`, and its standard deviation, when the
    /// estimates scatter as if its power were `power`: how large could a term be that was not found?
    pub fn beside(&self, fit: &SubsetFit, extra: usize, power: f64) -> Option<(f64, f64)> {
        let mut theta = self.scaled(fit);
        theta[extra] = power / self.scale[extra];
        let columns: Vec<usize> = fit.chosen.iter().copied().chain([extra]).collect();
        let a = self.shapes.select_columns(&columns);
        let s =
            solve(&a, &DVector::from_element(self.variance.len(), 1.0), self.relative_covariance(&theta))?;
        let k = fit.chosen.len();
        Some((s.theta[k] * self.scale[extra], s.covariance[(k, k)].sqrt() * self.scale[extra]))
    }

    fn scaled(&self, fit: &SubsetFit) -> Vec<f64> {
        let mut theta = vec![0.0; self.terms.len()];
        for (c, p) in fit.chosen.iter().zip(&fit.powers) {
            theta[*c] = p / self.scale[*c];
        }
        theta
    }

    fn finish(&self, chosen: &[usize], s: &Solution) -> SubsetFit {
        let scale: Vec<f64> = chosen.iter().map(|c| self.scale[*c]).collect();
        let mut fit = SubsetFit {
            chosen: chosen.to_vec(),
            powers: s.theta.iter().zip(&scale).map(|(t, s)| t * s).collect(),
            covariance: DMatrix::from_fn(scale.len(), scale.len(), |i, j| {
                s.covariance[(i, j)] * scale[i] * scale[j]
            }),
            shape_errors: vec![None; chosen.len()],
            chi2: s.chi2,
            deviance: s.log_det + s.chi2,
        };
        self.admit_shapes(&mut fit);
        fit
    }

    /// Widens the covariance by what is not known of correlation times and frequencies: each joins the linear
    /// problem with the derivative of the curve as its column.
    fn admit_shapes(&self, fit: &mut SubsetFit) {
        let shaped: Vec<usize> =
            (0..fit.chosen.len()).filter(|k| self.terms[fit.chosen[*k]].shape().is_some()).collect();
        if shaped.is_empty() {
            return;
        }
        let n = fit.chosen.len();
        let mut a = self.shapes.select_columns(&fit.chosen).resize_horizontally(n + shaped.len(), 0.0);
        for (column, k) in shaped.iter().enumerate() {
            let term = self.terms[fit.chosen[*k]];
            for i in 0..self.tau.len() {
                let at = |factor: f64| term.scale_shape(factor).allan_variance(self.tau[i]);
                let slope = (at(1.0 + 1e-4) - at(1.0 - 1e-4)) / 2e-4;
                a[(i, n + column)] = fit.powers[*k] * slope / self.variance[i];
            }
        }
        let y = DVector::from_element(self.variance.len(), 1.0);
        if let Some(s) = solve(&a, &y, self.relative_covariance(&self.scaled(fit))) {
            let scale: Vec<f64> = fit.chosen.iter().map(|c| self.scale[*c]).collect();
            fit.covariance = DMatrix::from_fn(n, n, |i, j| s.covariance[(i, j)] * scale[i] * scale[j]);
            for (column, k) in shaped.iter().enumerate() {
                fit.shape_errors[*k] = Some(s.covariance[(n + column, n + column)].sqrt());
            }
        }
    }
}
