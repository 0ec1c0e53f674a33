//! Fading memory: old information counts less.

use nalgebra::SMatrix;

use super::{Moment, Square3, Strategy, Window, inflate, scale_by};
use crate::filter::scalar_update::seen;

/// Exponential fading memory: `P⁻ = lambda Phi P Phi' + Q` with a constant factor, so that a residual counts with
/// `lambda^-k` k updates later.
///
/// Source: Sorenson and Sacks, Recursive fading memory filtering, Information Sciences 3 (1971).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExponentialFading {
    /// The factor on the covariance per measurement, one or more.
    pub lambda: f64,
}

impl ExponentialFading {
    /// The factor that halves the weight of a residual within `half_life` (s) at one measurement every `dt` (s).
    pub fn with_half_life(half_life: f64, dt: f64) -> Self {
        ExponentialFading { lambda: libm::exp2(dt / half_life) }
    }
}

impl<const N: usize> Strategy<N> for ExponentialFading {
    fn before(&mut self, p: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        inflate(p, self.lambda.max(1.0), moment.n);
        moment.r
    }
}

/// One factor for the whole covariance, from the innovations of the last `M` updates:
///
/// ```text
/// C = (1/M) Σ nu nu',   lambda = max(1, tr(C - H Q H' - R) / tr(H Phi P Phi' H')),   P⁻ = lambda Phi P Phi' + Q
/// ```
///
/// once the window's innovations are larger than predicted by a test of chi-square. The factor that makes the covariance
/// of the innovations what it is seen to be.
#[derive(Clone, Debug, PartialEq)]
pub struct AdaptiveFading<const M: usize> {
    window: Window<M>,
}

impl<const M: usize> AdaptiveFading<M> {
    /// Starts where a consistent filter would have such innovations with probability `p`.
    pub fn new(p: f64) -> Self {
        AdaptiveFading { window: Window::new(p) }
    }
}

impl<const N: usize, const M: usize> Strategy<N> for AdaptiveFading<M> {
    fn before(&mut self, p: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        self.window.push(moment);
        if self.window.exceeds(moment.len()) {
            let c = self.window.covariance();
            let (mut wanted, mut carried) = (0.0, 0.0);
            for i in 0..moment.len() {
                wanted += c[i][i] - moment.driven[i][i] - moment.r[i][i];
                carried += moment.carried[i][i];
            }
            if carried > 0.0 {
                inflate(p, (wanted / carried).max(1.0), moment.n);
            }
        }
        moment.r
    }
}

/// A factor for every channel, from the innovations of the last `M` updates: the diagonal S that makes the variance of
/// each innovation what it is seen to be,
///
/// ```text
/// s_j² = max(1, (C_jj - R_jj) / (H P⁻ H')_jj),   P⁻ := S P⁻ S,   C = (1/M) Σ nu nu'
/// ```
///
/// once the window's innovations are larger than predicted by a test of chi-square. A state fades by the factor of the row
/// with which it is most correlated: the channel north of an alignment by velocity holds tilt east and accelerometer
/// north, the channel east tilt north, heading and their sensors. (Where states that no row measures are given the factor
/// one instead, attitude stays as sure as it was, and nothing is won.)
///
/// Source: the factors from the windowed innovations are those of Geng and Wang, Adaptive estimation of multiple fading
/// factors in Kalman filter for navigation applications, GPS Solutions 12 (2008); the use of different rates for the
/// channels of static alignment is that of Gao and Miao (2011). That a state goes with the row it is most correlated
/// with is ours.
#[derive(Clone, Debug, PartialEq)]
pub struct MultipleFading<const M: usize> {
    window: Window<M>,
}

impl<const M: usize> MultipleFading<M> {
    /// Starts where a consistent filter would have such innovations with probability `p`.
    pub fn new(p: f64) -> Self {
        MultipleFading { window: Window::new(p) }
    }
}

impl<const N: usize, const M: usize> Strategy<N> for MultipleFading<M> {
    fn before(&mut self, p: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        self.window.push(moment);
        if self.window.exceeds(moment.len()) {
            let c = self.window.covariance();
            let mut factor = [1.0; 3];
            let mut shared = [[0.0; N]; 3];
            for (j, row) in moment.rows.iter().enumerate() {
                let (predicted, carried) = (moment.predicted(j), moment.carried[j][j]);
                if predicted > 0.0 && carried > 0.0 {
                    factor[j] = libm::sqrt(((c[j][j] - moment.r[j][j]) / predicted).max(1.0));
                    shared[j] = seen(p, row, moment.n).0.map(|b| b * b / carried);
                }
            }
            let s = core::array::from_fn(|i| {
                let nearest = (0..moment.len()).max_by(|&a, &b| shared[a][i].total_cmp(&shared[b][i]));
                nearest.map_or(1.0, |j| factor[j])
            });
            scale_by(p, &s, moment.n);
        }
        moment.r
    }
}
