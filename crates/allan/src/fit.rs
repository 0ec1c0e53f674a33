use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

use crate::covariance::{CovarianceTable, Layout};
use crate::select::{FitData, OBSERVABLE, Selection, select};
use crate::subset::SubsetFit;
use crate::{AllanError, Curve, Estimator, Term, cramer_rao};

/// What a log says about one term.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// In the curve, and known to 30 % or better even by the Cramér-Rao bound.
    Seen,
    /// In the curve, but no method could tell its size from this log to better than 30 %.
    NotObservable,
    /// Not in the curve; it may be there below the upper end of the interval.
    Bounded,
}

/// One term of the fitted error model.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Which, with correlation time or frequency where it has one.
    pub term: Term,
    /// The coefficient Q, N, B, K, R, sigma or amplitude in SI units; 0 for a term that is not in the curve.
    pub value: f64,
    /// Standard error of the coefficient, the chosen terms taken as the right ones.
    pub standard_error: f64,
    /// 95 % interval of the coefficient, in which terms that nearly got in count too. For a bounded term:
    /// 0 and the upper end (infinite where the log sets none).
    pub interval: (f64, f64),
    /// Standard error of correlation time or frequency in their unit.
    pub shape_error: Option<f64>,
    /// Cramér-Rao bound of the coefficient, relative; for the terms that are not random the relative standard error.
    pub bound: f64,
    /// Seen, not observable, or bounded.
    pub verdict: Verdict,
}

/// An error model fitted to a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The five power laws always; Markov and sinusoid where the curve shows them.
    pub parameters: Vec<Parameter>,
    /// Weighted sum of squared residuals, all correlations counted.
    pub chi2: f64,
    /// Its degrees of freedom.
    pub freedom: usize,
    /// Does the model miss the curve by more than chance would (0.1 %)? Then the log holds something that is none of
    /// these terms (motion, temperature, an outlier).
    pub misfit: bool,
    /// Relative error of the Allan variance that the model has been allowed at every averaging time, because it
    /// misses the curve; 0 where it does not. The intervals allow for it.
    pub model_error: f64,
    /// Sample interval (s) and length (s) of the log.
    pub tau0: f64,
    /// Length of the log (s).
    pub duration: f64,
}

impl Fit {
    /// Allan variance of the model at averaging time `tau` (s), terms in the curve only.
    #[must_use]
    pub fn allan_variance(&self, tau: f64) -> f64 {
        self.parameters.iter().map(|p| p.value * p.value * p.term.allan_variance(tau)).sum()
    }

    /// The parameter of a term; of a Markov process or a sinusoid, whatever its shape.
    #[must_use]
    pub fn parameter(&self, term: Term) -> Option<&Parameter> {
        let kind = std::mem::discriminant(&term);
        self.parameters.iter().find(|p| std::mem::discriminant(&p.term) == kind)
    }
}

/// Fits curves of one length and sample interval; what does not depend on the values is computed once.
#[derive(Debug, Clone)]
pub struct Fitter {
    octaves: FitData,
    half_octaves: FitData,
}

/// Longest averaging time, as part of the log, that takes part in a fit.
const SHARE: f64 = 4.0;
/// Fewest octaves that a fit makes sense on.
const FEWEST: usize = 5;

impl Fitter {
    /// For curves like this one: overlapping estimates (or of a [`crate::Pyramid`]) at all octaves, better at two
    /// per octave or a multiple, which is needed to see a sinusoid. Times beyond a quarter of the log are left out.
    ///
    /// # Errors
    /// Not an overlapping estimate, or fewer than five octaves.
    pub fn new(curve: &Curve) -> Result<Self, AllanError> {
        if curve.estimator != Estimator::Overlapping {
            return Err(AllanError::FitEstimator);
        }
        let data = |per: u32| {
            let factors = crate::Grid::PerOctave(per).factors(curve.n_phase);
            let mut part = curve.up_to(SHARE);
            part.points.retain(|p| factors.binary_search(&p.m).is_ok());
            let layout = Layout {
                factors: part.points.iter().map(|p| p.m).collect(),
                strides: strides(&part),
                n_phase: curve.n_phase,
                tau0: curve.tau0,
            };
            let table = CovarianceTable::new(&layout, &Term::POWER_LAWS);
            FitData { curve: part, layout, table }
        };
        let (octaves, half_octaves) = (data(1), data(2));
        if octaves.curve.points.len() < FEWEST {
            return Err(AllanError::TooShort {
                got: curve.n_phase - 1,
                need: 64,
                what: "a fit of noise terms",
            });
        }
        Ok(Self { octaves, half_octaves })
    }

    /// Fits the error model to a curve with the same averaging times.
    ///
    /// The powers of the terms are found by generalised least squares on the variances, with the covariance of the
    /// overlapping estimates under the fitted model itself (exact for Gaussian noise), reweighted until it settles.
    /// All subsets of terms with positive powers compete; each must gain nine in twice the log likelihood.
    /// Intervals average over subsets.
    ///
    /// # Errors
    /// A curve of another length or grid, a variance that is not positive.
    pub fn fit(&self, curve: &Curve) -> Result<Fit, AllanError> {
        let on = |data: &FitData| -> Result<FitData, AllanError> {
            let mut part = curve.clone();
            part.points.retain(|p| data.layout.factors.binary_search(&p.m).is_ok());
            let same = curve.n_phase == data.layout.n_phase
                && part.points.len() == data.layout.factors.len()
                && strides(&part) == data.layout.strides;
            if !same {
                return Err(AllanError::FitLayout);
            }
            if let Some(p) = part.points.iter().find(|p| !(p.variance > 0.0 && p.variance.is_finite())) {
                return Err(AllanError::FitVariance { tau: p.tau, variance: p.variance });
            }
            Ok(FitData { curve: part, ..data.clone() })
        };
        let selection = select(&on(&self.octaves)?, &on(&self.half_octaves)?)?;
        let n = curve.n_phase - 1;
        let terms: Vec<Term> = selection.best.chosen.iter().map(|c| selection.problem.terms[*c]).collect();
        let bounds = cramer_rao(&terms, &selection.best.powers, n, curve.tau0);
        let parameters = (0..selection.problem.terms.len())
            .filter_map(|i| match selection.best.chosen.iter().position(|c| *c == i) {
                Some(k) => Some(found(&selection, i, k, bounds[k])),
                // A shape that did not get in is a shape of nothing.
                None if selection.problem.terms[i].shape().is_some() => None,
                None => Some(Ok(bounded(&selection, i))),
            })
            .collect::<Result<_, _>>()?;
        Ok(Fit {
            parameters,
            chi2: selection.best.chi2,
            freedom: selection.freedom(),
            misfit: selection.slack > 0.0 || selection.misfits(0.999)?,
            model_error: selection.slack,
            tau0: curve.tau0,
            duration: n as f64 * curve.tau0,
        })
    }
}

/// Samples between the starts of two differences.
fn strides(curve: &Curve) -> Vec<usize> {
    let whole = |p: &crate::Point| p.terms == curve.n_phase - 2 * p.m;
    curve.points.iter().map(|p| if whole(p) { 1 } else { p.m / crate::pyramid::STRIDE }).collect()
}

/// Fits the error model to one curve; see [`Fitter`], which is quicker for many.
///
/// # Errors
/// As [`Fitter::new`] and [`Fitter::fit`].
pub fn fit(curve: &Curve) -> Result<Fit, AllanError> {
    Fitter::new(curve)?.fit(curve)
}

fn found(s: &Selection, term: usize, k: usize, bound: Option<f64>) -> Result<Parameter, AllanError> {
    let power = s.best.powers[k];
    let value = power.sqrt();
    // d c = d(c²) / 2c.
    let standard_error = s.best.covariance[(k, k)].sqrt() / (2.0 * value);
    let bound = bound.unwrap_or(standard_error / value);
    let kind = s.problem.terms[term];
    Ok(Parameter {
        term: kind,
        value,
        standard_error,
        interval: (
            mixture_quantile(&s.all, term, power, 0.025)?,
            mixture_quantile(&s.all, term, power, 0.975)?,
        ),
        shape_error: s.best.shape_errors[k].zip(kind.shape()).map(|(e, shape)| e * shape),
        bound,
        verdict: if bound <= OBSERVABLE { Verdict::Seen } else { Verdict::NotObservable },
    })
}

/// Coefficient below which the true one lies with probability `p`. In each subset the power is chi-square with the
/// mean and variance of its estimate, or zero where the subset does without the term.
fn mixture_quantile(all: &[(f64, SubsetFit)], term: usize, start: f64, p: f64) -> Result<f64, AllanError> {
    let mut parts = Vec::new();
    let mut zero = 0.0;
    for (weight, fit) in all.iter().filter(|(w, _)| *w > 1e-6) {
        match fit.chosen.iter().position(|c| *c == term) {
            Some(k) => {
                let nu = 2.0 * fit.powers[k].powi(2) / fit.covariance[(k, k)];
                let law = ChiSquared::new(nu).map_err(|_| AllanError::DegreesOfFreedom(nu))?;
                parts.push((*weight, fit.powers[k], nu, law));
            }
            None => zero += weight,
        }
    }
    // Confidence that the true power is below x: the estimate is as large as it is, or larger, by chance.
    let below = |x: f64| {
        zero + parts.iter().map(|(w, power, nu, law)| w * (1.0 - law.cdf(nu * power / x))).sum::<f64>()
    };
    if zero >= p {
        return Ok(0.0);
    }
    let (mut low, mut high) = (start.ln() - 60.0, start.ln() + 60.0);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        if below(middle.exp()) < p { low = middle } else { high = middle }
    }
    Ok((0.5 * high).exp())
}

/// Upper limit of a term that is not in the best subset: the power at which an estimate as low as the one found
/// would come in 2.5 % of logs. Its scatter has a part from the other terms (normal) and one of its own (chi-square).
///
/// 2.5 %, not 5 %: it is the upper end of the same two-sided interval that a found term gets. A choice between one and two
/// sides that depends on the log would hold the truth too seldom (Feldman and Cousins, Phys. Rev. D 57 (1998) 3873).
/// An estimate further below zero than one standard deviation sets no lower limit than that one does.
fn bounded(s: &Selection, term: usize) -> Parameter {
    let kind = s.problem.terms[term];
    let mut limit = f64::INFINITY;
    if let Some((estimate, sigma)) = s.problem.beside(&s.best, term, 0.0) {
        let reached = estimate.max(-sigma);
        let exceeds = |u: f64| {
            let own =
                s.problem.beside(&s.best, term, u).map_or(0.0, |(_, e)| (e * e - sigma * sigma).max(0.0));
            chance_below(reached, u, 2.0 * u * u / own, sigma) < 0.025
        };
        let (mut low, mut high) = (0.0, 1e4 * (sigma + estimate.max(0.0)));
        if exceeds(high) {
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if exceeds(middle) { high = middle } else { low = middle }
            }
            limit = high.sqrt();
        }
    }
    Parameter {
        term: kind,
        value: 0.0,
        standard_error: 0.0,
        interval: (0.0, limit),
        shape_error: None,
        bound: f64::INFINITY,
        verdict: Verdict::Bounded,
    }
}

/// Probability of a sum at or below `x`: a chi-square variable with `nu` degrees of freedom and mean `u`, and a normal one with
/// standard deviation `sigma`. The first by its cube root, which is nearly normal (Wilson and Hilferty 1931).
fn chance_below(x: f64, u: f64, nu: f64, sigma: f64) -> f64 {
    const NODES: usize = 64;
    let normal = Normal::standard();
    let spread = 2.0 / (9.0 * nu.max(0.1));
    let chance = |i: usize| {
        let z = normal.inverse_cdf((i as f64 + 0.5) / NODES as f64);
        let part = u * (1.0 - spread + z * spread.sqrt()).max(0.0).powi(3);
        normal.cdf((x - part) / sigma)
    };
    (0..NODES).map(chance).sum::<f64>() / NODES as f64
}
