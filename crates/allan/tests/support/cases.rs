//! Known noises to recover, six hours at 10 Hz each, after the cases of published comparisons.
use schuler_allan::{Curve, Estimator, Fit, Fitter, Grid, Phase, SunEq3, Term, sun_eq3};

use super::simulate::{Simulator, Truth};

pub const TAU0: f64 = 0.1;
pub const SAMPLES: usize = 216_000;

/// deg/√h and deg/h in SI.
pub const DEG_SQRT_H: f64 = std::f64::consts::PI / 180.0 / 60.0;
pub const DEG_H: f64 = std::f64::consts::PI / 180.0 / 3600.0;

pub struct Case {
    pub name: &'static str,
    pub truth: Truth,
    /// First seed; runs take consecutive ones.
    pub seed: u64,
}

pub fn cases() -> Vec<Case> {
    // Density of the random walk whose line crosses another one at tau: K² tau / 3 = variance there.
    let crossing = |variance: f64, tau: f64| (3.0 * variance / tau).sqrt();
    let flat = |b: f64| (0.664_282 * b).powi(2);
    let none = Truth::default();
    let (n1, b1) = (0.1 * DEG_SQRT_H, DEG_H);
    let list = [
        ("N, B, K: MEMS", Truth { white: n1, flicker: b1, random_walk: crossing(flat(b1), 2000.0), ..none }),
        (
            "N, B, K: strong flicker",
            Truth {
                white: 3.0 * n1,
                flicker: 10.0 * b1,
                random_walk: crossing(flat(10.0 * b1), 3000.0),
                ..none
            },
        ),
        (
            "N, B, K: strong walk",
            Truth { white: n1, flicker: 5.0 * b1, random_walk: crossing(flat(5.0 * b1), 200.0), ..none },
        ),
        ("N, B: FOG", Truth { white: 0.03 * n1, flicker: 0.005 * b1, ..none }),
        ("N, K", Truth { white: n1, random_walk: crossing(n1 * n1 / 300.0, 300.0), ..none }),
        ("Q, N, B: RLG", Truth { quantization: 5e-6, white: 0.03 * n1, flicker: 0.05 * b1, ..none }),
        ("N alone", Truth { white: 0.03 * n1, ..none }),
    ];
    list.into_iter()
        .enumerate()
        .map(|(i, (name, truth))| Case { name, truth, seed: 1_000_000 * (i as u64 + 1) })
        .collect()
}

impl Truth {
    /// True coefficient of a term, 0 where there is none.
    pub fn value(&self, term: Term) -> f64 {
        match term {
            Term::Quantization => self.quantization,
            Term::White => self.white,
            Term::Flicker => self.flicker,
            Term::RandomWalk => self.random_walk,
            Term::Ramp => self.ramp,
            Term::Markov { .. } => self.markov.map_or(0.0, |m| m.0),
            Term::Sinusoid { .. } => self.sinusoid.map_or(0.0, |s| s.0),
            _ => 0.0,
        }
    }
}

/// Fits of the first `runs` logs of a case, and what the paper's equation (3) makes of the same curves.
pub fn fits(case: &Case, runs: usize) -> Vec<(Fit, SunEq3)> {
    let mut simulator = Simulator::new(case.truth, SAMPLES, TAU0);
    let mut fitter = None;
    (0..runs)
        .map(|run| {
            let phase = Phase::from_rate(&simulator.rate(case.seed + run as u64), TAU0).unwrap();
            let curve = Curve::estimate(&phase, Estimator::Overlapping, &Grid::PerOctave(2)).unwrap();
            let fitter = fitter.get_or_insert_with(|| Fitter::new(&curve).unwrap());
            (fitter.fit(&curve).unwrap(), sun_eq3(&curve.up_to(4.0)).unwrap())
        })
        .collect()
}

/// How well one term was recovered.
pub struct Score {
    pub term: Term,
    /// Relative Cramér-Rao bound at the truth.
    pub bound: f64,
    /// Root mean square of the relative errors, 1 where the term was not found.
    pub rms: f64,
    /// Share of runs in which it was found.
    pub found: f64,
    /// Share of runs in which the 95 % interval or limit holds the truth.
    pub coverage: f64,
    /// Root mean square of equation (3) where it gave a real number, and the share of runs where it did not.
    pub sun_rms: f64,
    pub sun_imaginary: f64,
}

pub fn scores(case: &Case, fits: &[(Fit, SunEq3)]) -> Vec<Score> {
    let terms: Vec<Term> = Term::POWER_LAWS.into_iter().filter(|t| case.truth.value(*t) > 0.0).collect();
    let powers: Vec<f64> = terms.iter().map(|t| case.truth.value(*t).powi(2)).collect();
    let bounds = schuler_allan::cramer_rao(&terms, &powers, SAMPLES, TAU0);
    let runs = fits.len() as f64;
    let mean = |f: &dyn Fn(&(Fit, SunEq3)) -> f64| fits.iter().map(f).sum::<f64>() / runs;
    terms
        .iter()
        .zip(bounds)
        .map(|(term, bound)| {
            let truth = case.truth.value(*term);
            let parameter =
                |f: &Fit| f.parameter(*term).expect("invariant: power laws are always reported").clone();
            let index = Term::POWER_LAWS.iter().position(|t| t == term).expect("invariant: a power law");
            let real: Vec<f64> = fits.iter().filter_map(|f| f.1.parameters[index]).collect();
            Score {
                term: *term,
                bound: bound.expect("invariant: all simulated terms are random"),
                rms: mean(&|f| (parameter(&f.0).value / truth - 1.0).powi(2)).sqrt(),
                found: mean(&|f| f64::from(parameter(&f.0).value > 0.0)),
                coverage: mean(&|f| {
                    let (low, high) = parameter(&f.0).interval;
                    f64::from(low <= truth && truth <= high)
                }),
                sun_rms: (real.iter().map(|v| (v / truth - 1.0).powi(2)).sum::<f64>() / real.len() as f64)
                    .sqrt(),
                sun_imaginary: 1.0 - real.len() as f64 / runs,
            }
        })
        .collect()
}

/// Share of runs with a term that is seen and is not true.
pub fn false_terms(case: &Case, fits: &[(Fit, SunEq3)]) -> f64 {
    let wrong = |f: &Fit| f.parameters.iter().any(|p| p.value > 0.0 && case.truth.value(p.term) == 0.0);
    fits.iter().filter(|f| wrong(&f.0)).count() as f64 / fits.len() as f64
}

/// Share of runs in which equation (3) has a negative coefficient.
pub fn sun_negative(fits: &[(Fit, SunEq3)]) -> f64 {
    fits.iter().filter(|f| f.1.coefficients.iter().any(|c| *c < 0.0)).count() as f64 / fits.len() as f64
}
