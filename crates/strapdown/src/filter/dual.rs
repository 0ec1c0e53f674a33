//! The true errors of a filter that believes in another model than what is true.

use nalgebra::SMatrix;

use super::observation::{Now, Observation};
use super::scalar_update::{joseph, seen};
use super::{Filter, FilterError, Model, Propagation, Row};

/// Covariance of the true errors together with what a filter makes of them, when truth has `T` states and the filter,
/// which knows nothing of that, `N`.
///
/// Truth x' = Phi_t x + w; the filter's estimate x^ follows its own Phi_f and its own gains K, which come from its own P, Q
/// and R:
///
/// ```text
/// P_xx := Phi_t P_xx Phi_t' + Q_t,   P_xe := Phi_t P_xe Phi_f',   P_ee := Phi_f P_ee Phi_f'        (time)
/// nu = h_t x + v - h_f x^,           x^ := x^ + K nu                                               (measurement)
/// P_xe := P_xe + cov(x, nu) K',      P_ee := P_ee + cov(x^, nu) K' + K cov(x^, nu)' + K var(nu) K'
/// ```
///
/// What the filter gets wrong is x^ - x for the states that both have: [`Dual::error_variance`]. Where both lists are the
/// same, it is the filter's own P. Taking estimates out of the navigator changes nothing in linear theory, so none is
/// modelled.
///
/// Source: the sensitivity equations of sub-optimal filters, Gelb (ed.), Applied Optimal Estimation, chapter 7.
#[derive(Clone, Debug)]
pub struct Dual<const T: usize, const N: usize> {
    truth: Model<T>,
    /// The filter, whose `x` is not used.
    pub filter: Filter<N>,
    xx: SMatrix<f64, T, T>,
    /// Rows: states of the filter; columns: truth.
    ex: SMatrix<f64, T, N>,
    ee: SMatrix<f64, N, N>,
    /// State of truth that each state of the filter estimates.
    twin: [Option<usize>; N],
}

impl<const T: usize, const N: usize> Dual<T, N> {
    /// Truth over `truth`, its navigation errors with the standard deviations `nav_sigma`; `filter` at its start.
    ///
    /// Navigation errors belong together by their kind, source states by their component and number, extra states by their
    /// name. Both models must be in the same form.
    ///
    /// # Errors
    /// [`FilterError::Sigma`] for a deviation that is negative or not finite.
    pub fn new(truth: Model<T>, nav_sigma: &[f64; 9], filter: Filter<N>) -> Result<Self, FilterError> {
        let xx = truth.p0(nav_sigma)?;
        let mut twin = [None; N];
        for (k, twin) in twin.iter_mut().enumerate().take(filter.model.len()) {
            *twin = filter.model.twin_in(k, &truth);
        }
        Ok(Dual { truth, filter, xx, ex: SMatrix::zeros(), ee: SMatrix::zeros(), twin })
    }

    /// Covariance of the true errors.
    pub fn truth_covariance(&self) -> &SMatrix<f64, T, T> {
        &self.xx
    }

    /// The same, to be changed where something happens to the truth that the filter does not know of.
    pub fn truth_covariance_mut(&mut self) -> &mut SMatrix<f64, T, T> {
        &mut self.xx
    }

    /// True covariance of the errors of estimates `i` and `j`, x^ - x; a state that truth does not have is zero there.
    pub fn error_covariance(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (self.twin[i], self.twin[j]);
        let cross = |t: Option<usize>, e: usize| t.map_or(0.0, |t| self.ex[(t, e)]);
        let own = a.zip(b).map_or(0.0, |(a, b)| self.xx[(a, b)]);
        self.ee[(i, j)] - cross(a, j) - cross(b, i) + own
    }

    /// True variance of the error of estimate `k`.
    pub fn error_variance(&self, k: usize) -> f64 {
        self.error_covariance(k, k)
    }

    /// Time update of both, each by its own step over the same time.
    pub fn propagate(&mut self, truth: &Propagation<T>, filter: &Propagation<N>) {
        truth.apply(&mut self.xx);
        for e in 0..self.filter.model.len() {
            let mut column = self.ex.column(e).into_owned();
            truth.carry(&mut column);
            self.ex.set_column(e, &column);
        }
        for t in 0..self.truth.len() {
            let mut row = self.ex.row(t).transpose();
            filter.carry(&mut row);
            self.ex.set_row(t, &row.transpose());
        }
        filter.transport(&mut self.ee);
        self.filter.propagate(filter);
    }

    /// Measurement update. The filter takes `observation` as it is; the noise of its rows is independent and its true
    /// variances are `r`. `extra` says which states of truth act on it beside navigation and sensor errors: state and
    /// column, as in [`Observation::extra`].
    ///
    /// # Errors
    /// [`FilterError::Correlated`] where the filter's R is not diagonal, and as [`Filter::update_with`].
    pub fn update(
        &mut self,
        observation: &Observation,
        now: &Now,
        r: [f64; 3],
        extra: &[(usize, [f64; 3])],
    ) -> Result<(), FilterError> {
        let mut of_truth = *observation;
        of_truth.extra = [None; super::MAX_EXTRA];
        for &(state, column) in extra {
            of_truth = of_truth.with_extra(state, column)?;
        }
        if let Some(&(state, _)) = extra.iter().find(|(state, _)| *state >= self.truth.len()) {
            return Err(FilterError::NoState { state, n: self.truth.len() });
        }
        let len = observation.len;
        if let Some((row, column)) = (0..len)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .find(|&(i, j)| observation.r[i][j] != 0.0 || observation.r[j][i] != 0.0)
        {
            return Err(FilterError::Correlated { row, column });
        }
        let of_truth = of_truth.rows(&self.truth, now);
        let of_filter = self.filter.rows(observation, now)?;
        for i in 0..len {
            self.scalar(&of_truth[i], &of_filter[i], r[i], observation.r[i][i])?;
        }
        Ok(())
    }

    fn scalar(&mut self, h_t: &Row<T>, h_f: &Row<N>, r_true: f64, r: f64) -> Result<(), FilterError> {
        let (nt, nf) = (self.truth.len(), self.filter.model.len());
        let (b, predicted) = seen(&self.filter.p, h_f, nf);
        let s = predicted + r;
        if !(s > 0.0 && s.is_finite()) {
            return Err(FilterError::Covariance { variance: s });
        }
        let gain = b.map(|b| b / s);
        // cov(x, nu) and cov(x^, nu).
        let (mut of_x, variance_x) = seen(&self.xx, h_t, nt);
        let (mut of_e, variance_e) = seen(&self.ee, h_f, nf);
        of_e.iter_mut().for_each(|c| *c = -*c);
        let mut between = 0.0;
        for (t, h) in h_t.pairs() {
            for e in 0..nf {
                of_e[e] += h * self.ex[(t, e)];
            }
            between += h_f.pairs().map(|(e, g)| h * g * self.ex[(t, e)]).sum::<f64>();
        }
        for (e, g) in h_f.pairs() {
            for t in 0..nt {
                of_x[t] -= g * self.ex[(t, e)];
            }
        }
        let nu = variance_x - 2.0 * between + variance_e + r_true;
        for e in 0..nf {
            for t in 0..nt {
                self.ex[(t, e)] += of_x[t] * gain[e];
            }
        }
        for i in 0..nf {
            for j in 0..=i {
                let value = self.ee[(i, j)] + of_e[i] * gain[j] + gain[i] * of_e[j] + gain[i] * gain[j] * nu;
                (self.ee[(i, j)], self.ee[(j, i)]) = (value, value);
            }
        }
        joseph(&mut self.filter.p, &gain, &b, predicted, r, nf);
        Ok(())
    }
}
