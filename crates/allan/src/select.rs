//! Which terms does the curve show? All subsets are fitted, and each term must pay for itself.

use std::f64::consts::LN_2;

use nalgebra::{DMatrix, DVector};

use crate::covariance::{CovarianceTable, Layout};
use crate::subset::{Problem, SubsetFit};
use crate::{AllanError, Curve, Term, quantile};

/// What a term must gain in twice the log likelihood to be accepted: three standard deviations. On simulated
/// logs this lets 1 to 2 % of false terms in (recovery.md).
const PRICE: f64 = 9.0;
/// A ramp has no scatter of its own and so fits the last, widely scattering points too eagerly.
const PRICE_RAMP: f64 = 13.0;
/// A term with a shape has two parameters, found among many.
const PRICE_SHAPE: f64 = 22.0;
/// For intervals, subsets count with this milder price: what nearly paid for itself still adds to what is unknown.
const PRICE_INTERVAL: f64 = 2.0;

/// The best subset, and all feasible ones with their weights.
pub(crate) struct Selection {
    pub problem: Problem,
    pub best: SubsetFit,
    pub all: Vec<(f64, SubsetFit)>,
    /// Relative error of the model that the fit allows for.
    pub slack: f64,
}

fn price(term: Term, each: f64) -> f64 {
    match term {
        Term::Ramp => each + PRICE_RAMP - PRICE,
        Term::Markov { .. } | Term::Sinusoid { .. } => each + PRICE_SHAPE - PRICE,
        _ => each,
    }
}

impl Selection {
    /// All subsets of `terms`.
    pub fn of(curve: &Curve, terms: &[Term], table: CovarianceTable, slack: f64) -> Result<Self, AllanError> {
        let problem = Problem::new(curve, terms, table, slack);
        let score = |fit: &SubsetFit, each: f64| {
            fit.deviance + fit.chosen.iter().map(|c| price(terms[*c], each)).sum::<f64>()
        };
        let fits: Vec<SubsetFit> = (1u32..1 << terms.len())
            .filter_map(|bits| {
                let chosen: Vec<usize> = (0..terms.len()).filter(|i| bits >> i & 1 == 1).collect();
                // Fewer points than parameters leave nothing to judge by.
                if chosen.len() < curve.points.len() { problem.fit(&chosen) } else { None }
            })
            .collect();
        let best = fits.iter().min_by(|a, b| score(a, PRICE).total_cmp(&score(b, PRICE))).cloned();
        let best = best.ok_or(AllanError::Fit(curve.points.len()))?;
        let least = fits.iter().map(|f| score(f, PRICE_INTERVAL)).fold(f64::INFINITY, f64::min);
        let all: Vec<(f64, SubsetFit)> =
            fits.into_iter().map(|f| ((0.5 * (least - score(&f, PRICE_INTERVAL))).exp(), f)).collect();
        let whole: f64 = all.iter().map(|(w, _)| w).sum();
        let all = all.into_iter().map(|(w, f)| (w / whole, f)).collect();
        Ok(Self { problem, best, all, slack })
    }

    fn chosen_terms(&self) -> Vec<Term> {
        self.best.chosen.iter().map(|c| self.problem.terms[*c]).collect()
    }

    /// Number of points less number of parameters.
    pub fn freedom(&self) -> usize {
        let shaped = self.chosen_terms().iter().filter(|t| t.shape().is_some()).count();
        self.problem.points().saturating_sub(self.best.chosen.len() + shaped).max(1)
    }

    /// Does the curve differ from the fit by more than chance, at this confidence?
    pub fn misfits(&self, confidence: f64) -> Result<bool, AllanError> {
        Ok(self.best.chi2 > quantile(self.freedom() as f64, confidence)?)
    }
}

/// Power laws first; a Markov process and a sinusoid only if those leave a misfit, and each only if it pays.
pub(crate) fn select(octaves: &FitData, half_octaves: &FitData) -> Result<Selection, AllanError> {
    let laws = Term::POWER_LAWS.to_vec();
    let plain = Selection::of(&octaves.curve, &laws, octaves.table.clone(), 0.0)?;
    if !plain.misfits(0.99)? {
        return Ok(plain);
    }
    let found = with_shapes(half_octaves, 0.0)?;
    if !found.misfits(0.999)? {
        // Nothing with a shape: the plain grid has the better known statistics.
        let shaped = found.chosen_terms().iter().any(|t| t.shape().is_some());
        return Ok(if shaped { found } else { plain });
    }
    // The log holds something else. Give the model the relative error that it needs, or the points with the smallest
    // scatter, those at short times, would drive it alone.
    let shaped = screened(&half_octaves.curve);
    let mut slack = SLACKS[0];
    for wider in SLACKS {
        slack = wider;
        if !half_octaves.selection(&shaped, slack)?.misfits(0.9)? {
            break;
        }
    }
    with_shapes(half_octaves, slack)
}

/// Relative errors of the variance that are tried for a model that misses.
const SLACKS: [f64; 9] = [0.01, 0.02, 0.04, 0.08, 0.15, 0.25, 0.4, 0.6, 1.0];

/// Markov process and sinusoid by simple weights, which a misfit does not upset; each knows of the other.
fn screened(curve: &Curve) -> Vec<Term> {
    let mut shaped: Vec<Term> = Vec::new();
    for kind in [sinusoids, markovs, sinusoids] {
        let grid = kind(curve);
        shaped.retain(|t| !same_kind(*t, grid[0]));
        shaped.extend(screen(curve, &shaped, &grid));
    }
    shaped
}

/// The best subset of power laws, a Markov process and a sinusoid.
fn with_shapes(data: &FitData, slack: f64) -> Result<Selection, AllanError> {
    let mut shaped = screened(&data.curve);
    loop {
        let chosen = data.selection(&shaped, slack)?.chosen_terms();
        // Twice, because the shapes depend on each other.
        for place in (0..shaped.len()).chain(0..shaped.len()) {
            refine(data, slack, &mut shaped, place, &chosen);
        }
        let selection = data.selection(&shaped, slack)?;
        let kept: Vec<Term> = selection.chosen_terms().into_iter().filter(|t| t.shape().is_some()).collect();
        if kept.len() == shaped.len() {
            return Ok(selection);
        }
        shaped = kept;
    }
}

/// A curve with what does not depend on its values.
#[derive(Debug, Clone)]
pub(crate) struct FitData {
    pub curve: Curve,
    pub layout: Layout,
    pub table: CovarianceTable,
}

impl FitData {
    fn selection(&self, shaped: &[Term], slack: f64) -> Result<Selection, AllanError> {
        let terms: Vec<Term> = Term::POWER_LAWS.iter().chain(shaped).copied().collect();
        Selection::of(&self.curve, &terms, self.table.with(&self.layout, shaped), slack)
    }
}

/// Moves the shape of one term to the best likelihood within a grid step to both sides, by golden section, with
/// these kinds of terms in the model.
fn refine(data: &FitData, slack: f64, shaped: &mut [Term], place: usize, chosen: &[Term]) {
    let start = shaped[place];
    if !chosen.iter().any(|t| same_kind(*t, start)) {
        return;
    }
    let others: Vec<Term> = shaped.iter().copied().filter(|t| !same_kind(*t, start)).collect();
    let table = data.table.with(&data.layout, &others);
    let known: Vec<Term> = Term::POWER_LAWS.iter().chain(&others).copied().collect();
    let deviance = |x: f64| {
        let trial = start.scale_shape(x.exp());
        let terms: Vec<Term> = known.iter().copied().chain([trial]).collect();
        let set: Vec<usize> =
            (0..terms.len()).filter(|i| chosen.iter().any(|t| same_kind(*t, terms[*i]))).collect();
        let problem = Problem::new(&data.curve, &terms, table.with(&data.layout, &[trial]), slack);
        problem.fit(&set).map_or(f64::INFINITY, |f| f.deviance)
    };
    let step = grid_step(start) * LN_2;
    // A frequency is known better than a correlation time.
    let rounds = if matches!(start, Term::Sinusoid { .. }) { 16 } else { 8 };
    let x = golden(deviance, -step, step, rounds);
    shaped[place] = start.scale_shape(x.exp());
}

fn golden(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64, rounds: usize) -> f64 {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let width = high - low;
    let (mut a, mut b) = (high - ratio * width, low + ratio * width);
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..rounds {
        if fa <= fb {
            (high, b, fb) = (b, a, fa);
            a = high - ratio * (high - low);
            fa = f(a);
        } else {
            (low, a, fa) = (a, b, fb);
            b = low + ratio * (high - low);
            fb = f(b);
        }
    }
    if fa <= fb { a } else { b }
}

/// Octaves between neighbours when shapes are screened.
fn grid_step(term: Term) -> f64 {
    if matches!(term, Term::Sinusoid { .. }) { 1.0 / 24.0 } else { 0.25 }
}

fn same_kind(a: Term, b: Term) -> bool {
    std::mem::discriminant(&a) == std::mem::discriminant(&b)
}

fn markovs(curve: &Curve) -> Vec<Term> {
    grid(Term::Markov { tau: 2.0 * curve.tau0 }, curve.tau0 * curve.n_phase as f64 / 8.0)
}

fn sinusoids(curve: &Curve) -> Vec<Term> {
    grid(Term::Sinusoid { f0: 4.0 / (curve.tau0 * curve.n_phase as f64) }, 0.5 / curve.tau0)
}

fn grid(first: Term, last: f64) -> Vec<Term> {
    let factor = grid_step(first).exp2();
    (0..).map(|k| first.scale_shape(factor.powi(k))).take_while(|t| t.shape() <= Some(last)).collect()
}

/// The term of the grid that fits best by simple weights beside the power laws and those present.
fn screen(curve: &Curve, present: &[Term], grid: &[Term]) -> Option<Term> {
    let beside = |term: &Term| {
        let terms: Vec<Term> = Term::POWER_LAWS.iter().chain(present).chain([term]).copied().collect();
        Some((weighted_misfit(curve, &terms)?, *term))
    };
    grid.iter().filter_map(beside).min_by(|a, b| a.0.total_cmp(&b.0)).map(|b| b.1)
}

/// Least weighted sum of squares over all subsets with positive coefficients that hold the last term; weights by
/// relative errors that grow with the averaging time.
fn weighted_misfit(curve: &Curve, terms: &[Term]) -> Option<f64> {
    let n = terms.len();
    let rows = curve.points.len();
    let weight = |i: usize| (curve.points[i].m as f64 / curve.n_phase as f64 + 1e-4).sqrt().recip();
    let a = DMatrix::from_fn(rows, n, |i, p| {
        weight(i) * terms[p].allan_variance(curve.points[i].tau) / curve.points[i].variance
    });
    let y = DVector::from_fn(rows, |i, _| weight(i));
    let scale: Vec<f64> = a.column_iter().map(|c| c.norm()).collect();
    let normal = DMatrix::from_fn(n, n, |p, q| a.column(p).dot(&a.column(q)) / (scale[p] * scale[q]));
    let right = DVector::from_fn(n, |p, _| a.column(p).dot(&y) / scale[p]);
    let last = 1u32 << (n - 1);
    (last..2 * last)
        .filter_map(|bits| {
            let set: Vec<usize> = (0..n).filter(|i| bits >> i & 1 == 1).collect();
            let h = normal.select_rows(&set).select_columns(&set);
            let g = right.select_rows(&set);
            let x = h.cholesky()?.solve(&g);
            x.iter().all(|v| *v > 0.0).then(|| y.norm_squared() - x.dot(&g))
        })
        .min_by(f64::total_cmp)
}
