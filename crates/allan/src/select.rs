//! Which terms does the curve show? All subsets are fitted, and each term must pay for itself.

use std::f64::consts::LN_2;

use nalgebra::{DMatrix, DVector};

use crate::covariance::{CovarianceTable, Layout};
use crate::subset::{Problem, SubsetFit};
use crate::{AllanError, Curve, Term, cramer_rao, quantile};

/// What a term must gain in twice the log likelihood to be accepted: three standard deviations. On simulated
/// logs at most 3 % get a false term (recovery.md).
const PRICE: f64 = 9.0;
/// A ramp has no scatter of its own and so fits the last, widely scattering points too eagerly.
const PRICE_RAMP: f64 = 30.0;
/// A term with a shape has two parameters, found among many.
const PRICE_SHAPE: f64 = 25.0;
/// What a term must gain beyond that where not even the Cramér-Rao bound tells its size. A little flicker and a little
/// random walk look alike then: what can be sized is the likelier find, and next to it flicker, which instruments have at
/// shorter times than they wander.
const PRICE_UNSEEN: f64 = 4.0;
const PRICE_UNSEEN_WALK: f64 = 10.0;
/// Largest Cramér-Rao bound, relative, of a term that a log can be said to show.
pub(crate) const OBSERVABLE: f64 = 0.30;
/// For intervals, subsets count with this milder price: what nearly paid for itself still adds to what is unknown.
const PRICE_INTERVAL: f64 = 2.0;
const PRICE_INTERVAL_RAMP: f64 = 6.0;
const PRICE_INTERVAL_SHAPE: f64 = 15.0;

/// The best subset, and all feasible ones with their weights.
pub(crate) struct Selection {
    pub problem: Problem,
    pub best: SubsetFit,
    /// The best one if terms whose size cannot be told cost no more than others: can these terms explain the curve?
    paid: SubsetFit,
    pub all: Vec<(f64, SubsetFit)>,
    /// Relative error of the model that the fit allows for.
    pub slack: f64,
}

fn price(term: Term) -> f64 {
    match term {
        Term::Ramp => PRICE_RAMP,
        Term::Markov { .. } | Term::Sinusoid { .. } => PRICE_SHAPE,
        _ => PRICE,
    }
}

fn price_interval(term: Term) -> f64 {
    match term {
        Term::Ramp => PRICE_INTERVAL_RAMP,
        Term::Markov { .. } | Term::Sinusoid { .. } => PRICE_INTERVAL_SHAPE,
        _ => PRICE_INTERVAL,
    }
}

impl Selection {
    /// All subsets of `terms`.
    pub fn of(curve: &Curve, terms: &[Term], table: CovarianceTable, slack: f64) -> Result<Self, AllanError> {
        let problem = Problem::new(curve, terms, table, slack);
        let score = |fit: &SubsetFit, price: fn(Term) -> f64| {
            fit.deviance + fit.chosen.iter().map(|c| price(terms[*c])).sum::<f64>()
        };
        let fits: Vec<SubsetFit> = (1u32..1 << terms.len())
            .filter_map(|bits| {
                let chosen: Vec<usize> = (0..terms.len()).filter(|i| bits >> i & 1 == 1).collect();
                // Fewer points than parameters leave nothing to judge by.
                if chosen.len() < curve.points.len() { problem.fit(&chosen) } else { None }
            })
            .collect();
        let scored: Vec<(f64, &SubsetFit)> = fits.iter().map(|f| (score(f, price), f)).collect();
        let paid = cheapest(scored.clone(), |_| 0.0).ok_or(AllanError::Fit(curve.points.len()))?.clone();
        let best =
            cheapest(scored, |fit| unseen(curve, terms, fit)).map_or_else(|| paid.clone(), Clone::clone);
        let least = fits.iter().map(|f| score(f, price_interval)).fold(f64::INFINITY, f64::min);
        let all: Vec<(f64, SubsetFit)> =
            fits.into_iter().map(|f| ((0.5 * (least - score(&f, price_interval))).exp(), f)).collect();
        let whole: f64 = all.iter().map(|(w, _)| w).sum();
        let all = all.into_iter().map(|(w, f)| (w / whole, f)).collect();
        Ok(Self { problem, best, paid, all, slack })
    }

    fn chosen_terms(&self) -> Vec<Term> {
        self.best.chosen.iter().map(|c| self.problem.terms[*c]).collect()
    }

    /// Number of points less number of parameters.
    pub fn freedom(&self) -> usize {
        self.freedom_of(&self.best)
    }

    fn freedom_of(&self, fit: &SubsetFit) -> usize {
        let shaped = fit.chosen.iter().filter(|c| self.problem.terms[**c].shape().is_some()).count();
        self.problem.points().saturating_sub(fit.chosen.len() + shaped).max(1)
    }

    /// Does the curve differ from the fit by more than chance, at this confidence?
    pub fn misfits(&self, confidence: f64) -> Result<bool, AllanError> {
        Ok(self.best.chi2 > quantile(self.freedom() as f64, confidence)?)
    }

    /// Could these terms make the curve, at this confidence, were it not for a term whose size cannot be told?
    fn explains(&self, confidence: f64) -> Result<bool, AllanError> {
        Ok(self.paid.chi2 <= quantile(self.freedom_of(&self.paid) as f64, confidence)?)
    }
}

/// The fit with the least score after what is added to it; the bounds behind that are costly, so they are asked for only
/// while they can decide.
fn cheapest(mut scored: Vec<(f64, &SubsetFit)>, extra: impl Fn(&SubsetFit) -> f64) -> Option<&SubsetFit> {
    scored.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Option<(f64, &SubsetFit)> = None;
    for (score, fit) in scored {
        if best.is_some_and(|(least, _)| least <= score) {
            break;
        }
        let whole = score + extra(fit);
        if best.is_none_or(|(least, _)| whole < least) {
            best = Some((whole, fit));
        }
    }
    best.map(|(_, fit)| fit)
}

/// The price of those terms of a fit whose size the log cannot tell.
fn unseen(curve: &Curve, terms: &[Term], fit: &SubsetFit) -> f64 {
    let chosen: Vec<Term> = fit.chosen.iter().map(|c| terms[*c]).collect();
    let bounds = cramer_rao(&chosen, &fit.powers, curve.n_phase - 1, curve.tau0);
    let unseen = chosen.iter().zip(bounds).filter(|(_, bound)| bound.is_some_and(|b| b > OBSERVABLE));
    unseen.map(|(term, _)| if *term == Term::RandomWalk { PRICE_UNSEEN_WALK } else { PRICE_UNSEEN }).sum()
}

/// Power laws first; a Markov process and a sinusoid only if those leave a misfit, and each only if it pays.
pub(crate) fn select(octaves: &FitData, half_octaves: &FitData) -> Result<Selection, AllanError> {
    let laws = Term::POWER_LAWS.to_vec();
    let plain = Selection::of(&octaves.curve, &laws, octaves.table.clone(), 0.0)?;
    if plain.explains(0.99)? {
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
