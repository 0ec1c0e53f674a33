//! Truth and filter together, for one source.

use nalgebra::{DMatrix, DVector, SMatrix};
use schuler_strapdown::Pva;

use super::super::passage::Sample;
use super::super::scene::Scene;
use super::super::source::{Kind, Nine, Noise, Source};
use super::super::stepper::Stepper;
use super::aid;
use super::nominal::{Gain, Passed};
use crate::scenario::BudgetFilter;

/// What an interval does to r, s and b.
struct Move<'a> {
    passed: &'a Passed,
    phi_ns: DMatrix<f64>,
    phi_ss: DMatrix<f64>,
    /// Of r and s.
    q: DMatrix<f64>,
}

impl Move<'_> {
    /// m := A m.
    fn carry(&self, m: &mut DMatrix<f64>) {
        let (truth, all) = (9 + self.phi_ss.nrows(), m.nrows());
        let r = self.passed.phi_nn * m.rows(0, 9) + &self.phi_ns * m.rows(9, truth - 9)
            - &self.passed.phi_nb * m.rows(truth, all - truth);
        let s = &self.phi_ss * m.rows(9, truth - 9);
        m.rows_mut(0, 9).copy_from(&r);
        m.rows_mut(9, truth - 9).copy_from(&s);
        if let Some(phi_bb) = &self.passed.phi_bb {
            let b = phi_bb * m.rows(truth, all - truth);
            m.rows_mut(truth, all - truth).copy_from(&b);
        }
    }

    /// l := l A.
    fn carry_back(&self, l: &mut DMatrix<f64>) {
        let (truth, all) = (9 + self.phi_ss.nrows(), l.ncols());
        let n = l.columns(0, 9).into_owned();
        let s = &n * &self.phi_ns + l.columns(9, truth - 9) * &self.phi_ss;
        let mut b = l.columns(truth, all - truth).into_owned();
        if let Some(phi_bb) = &self.passed.phi_bb {
            b *= phi_bb;
        }
        b -= &n * &self.passed.phi_nb;
        l.columns_mut(0, 9).copy_from(&(n * self.passed.phi_nn));
        l.columns_mut(9, truth - 9).copy_from(&s);
        l.columns_mut(truth, all - truth).copy_from(&b);
    }
}

/// One source on its way.
pub struct Walker<'a> {
    scene: &'a Scene<'a>,
    settings: &'a BudgetFilter,
    stepper: Stepper<'a>,
    /// Number of true states, nine and those of the source, and of all.
    truth: usize,
    all: usize,
    noise: Option<Noise>,
    /// Of r, s and b: a factor L of the covariance at the start (L L'), what has become of it, and the covariance by what came in
    /// since. A factor keeps the digits that a covariance loses where the filter's estimate cancels the source.
    start: DMatrix<f64>,
    factor: DMatrix<f64>,
    since: DMatrix<f64>,
    /// Whether anything comes in.
    driven: bool,
    pub rows: Vec<Nine>,
    /// How the nine errors at the end answer to r, s and b, and their covariance by what came in later.
    lambda: DMatrix<f64>,
    later: Nine,
}

impl<'a> Walker<'a> {
    pub fn new(
        scene: &'a Scene<'a>,
        settings: &'a BudgetFilter,
        source: &Source,
        estimated: usize,
    ) -> Walker<'a> {
        let stepper = Stepper::new(scene, source);
        let (truth, start) = (stepper.len(), stepper.start(source));
        let all = truth + estimated;
        let factor = factor(start.view((0, 0), (truth, truth)).into_owned().resize(all, all, 0.0));
        let noise = match source.kind {
            Kind::Noise(noise) => Some(noise),
            _ => None,
        };
        Walker {
            scene,
            settings,
            stepper,
            truth,
            all,
            noise,
            rows: vec![square(&factor, None)],
            start: factor.clone(),
            factor,
            since: DMatrix::zeros(all, all),
            driven: false,
            lambda: DMatrix::identity(9, all),
            later: Nine::zeros(),
        }
    }

    fn step<'p>(&mut self, passed: &'p Passed, samples: &[Sample]) -> Move<'p> {
        let step = self.stepper.over(passed.begin, passed.end, samples);
        let (phi, q, truth) = (step.phi(), step.q(), self.truth);
        Move {
            passed,
            phi_ns: DMatrix::from_fn(9, truth - 9, |i, j| phi[(i, 9 + j)]),
            phi_ss: DMatrix::from_fn(truth - 9, truth - 9, |i, j| phi[(9 + i, 9 + j)]),
            q: DMatrix::from_fn(truth, truth, |i, j| q[(i, j)]),
        }
    }

    /// On over intervals, the first of which begins with the navigator at `pva`.
    pub fn on<'s>(&mut self, pva: &Pva, passed: &[Passed], samples: impl Fn(&Passed) -> &'s [Sample]) {
        self.stepper.begin(pva);
        for passed in passed {
            let step = self.step(passed, samples(passed));
            step.carry(&mut self.factor);
            if self.driven {
                for _ in 0..2 {
                    step.carry(&mut self.since);
                    self.since.transpose_mut();
                }
            }
            if step.q.iter().any(|q| *q != 0.0) {
                self.driven = true;
                let mut of_truth = self.since.view_mut((0, 0), (self.truth, self.truth));
                of_truth += &step.q;
            }
            for gain in &passed.gains {
                self.update(gain, passed);
            }
            if self.scene.rows.binary_search(&passed.end).is_ok() {
                self.rows.push(square(&self.factor, None) + nine(&self.since));
            }
        }
    }

    /// Sensitivity of a measurement to r, s and b, its gain, and the variance of its noise where that is this source.
    fn seen(&self, gain: &Gain, passed: &Passed) -> (DVector<f64>, DVector<f64>, f64) {
        let (truth, all) = (self.truth, self.all);
        let (mut h, mut k) = (DVector::zeros(all), DVector::zeros(all));
        h.rows_mut(0, 9).copy_from(&gain.h_n);
        k.rows_mut(0, 9).copy_from(&gain.k_n);
        if gain.h_gyro != [0.0; 3] {
            for state in 9..truth {
                let error = self.stepper.gyro(state, &passed.seen);
                h[state] = gain.h_gyro.iter().zip(error).map(|(h, e)| h * e).sum();
            }
        }
        for b in 0..all - truth {
            (h[truth + b], k[truth + b]) = (-gain.h_b[b], -gain.k_b[b]);
        }
        let same = |noise: &Noise| noise.kind == gain.kind && noise.axis == gain.axis;
        let r = self.noise.filter(same).and_then(|noise| aid(&self.settings.aiding, noise.kind));
        (h, k, r.map_or(0.0, |aid| aid.sigma[gain.axis].powi(2)))
    }

    /// L := (I - k h') L, and of what came in since P := (I - k h') P (I - k h')' + k k' r.
    fn update(&mut self, gain: &Gain, passed: &Passed) {
        let (h, k, r) = self.seen(gain, passed);
        let seen = h.transpose() * &self.factor;
        self.factor -= &k * seen;
        if !self.driven && r == 0.0 {
            return;
        }
        self.driven = true;
        // One side after the other: the second takes rounding of the first down as well.
        let seen = h.transpose() * &self.since;
        self.since -= &k * seen;
        let seen = &self.since * &h;
        self.since += (&k * r - seen) * k.transpose();
    }

    /// Back over intervals, the first of which begins with the navigator at `pva`: of a measurement, with the row lambda of
    /// what the end answers to,
    ///
    /// ```text
    /// var := var + (lambda k)² r,   lambda := lambda (I - k h')
    /// ```
    pub fn back<'s>(&mut self, pva: &Pva, passed: &[Passed], samples: impl Fn(&Passed) -> &'s [Sample]) {
        self.stepper.begin(pva);
        let steps: Vec<Move> = passed.iter().map(|passed| self.step(passed, samples(passed))).collect();
        for step in steps.iter().rev() {
            for gain in step.passed.gains.iter().rev() {
                let (h, k, r) = self.seen(gain, step.passed);
                let answer = SMatrix::<f64, 9, 1>::from_column_slice((&self.lambda * k).as_slice());
                self.later += answer * answer.transpose() * r;
                self.lambda -= answer * h.transpose();
            }
            let of_truth = self.lambda.columns(0, self.truth).into_owned();
            self.later += square(&of_truth, Some(&step.q));
            step.carry_back(&mut self.lambda);
        }
    }

    /// The covariance at the end, from all that came in on the way back.
    pub fn adjoint(&self) -> Nine {
        self.later + square(&(&self.lambda * &self.start), None)
    }
}

/// l p l', or l l' without a p; `l` has nine rows, or the first nine count.
fn square(l: &DMatrix<f64>, p: Option<&DMatrix<f64>>) -> Nine {
    let l = l.rows(0, 9);
    let whole = match p {
        Some(p) => l * p * l.transpose(),
        None => l * l.transpose(),
    };
    Nine::from_column_slice(whole.as_slice())
}

/// A factor of a covariance: a column for each pivot that is more than rounding.
fn factor(mut p: DMatrix<f64>) -> DMatrix<f64> {
    const ROUNDING: f64 = 1e-13;
    let n = p.nrows();
    let whole = p.diagonal();
    let mut columns = Vec::new();
    for k in 0..n {
        if p[(k, k)] > ROUNDING * whole[k] {
            let column = p.column(k) / p[(k, k)].sqrt();
            p -= &column * column.transpose();
            columns.push(column);
        }
    }
    if columns.is_empty() { DMatrix::zeros(n, 0) } else { DMatrix::from_columns(&columns) }
}

fn nine(p: &DMatrix<f64>) -> Nine {
    Nine::from_fn(|i, j| 0.5 * (p[(i, j)] + p[(j, i)]))
}
