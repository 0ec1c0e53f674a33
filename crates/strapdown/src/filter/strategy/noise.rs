//! The noise of a measurement estimated from the innovations.

use nalgebra::SMatrix;

use super::{Moment, Square3, Strategy};

/// Bounds of an estimated variance, as factors on what the measurement says.
const RANGE: [f64; 2] = [1e-4, 1e4];

/// The estimate within its bounds, as a diagonal R.
fn bounded(estimate: [f64; 3], r: &Square3, len: usize) -> Square3 {
    let mut out = *r;
    for i in 0..len {
        for j in 0..len {
            out[i][j] = if i == j { estimate[i].clamp(RANGE[0] * r[i][i], RANGE[1] * r[i][i]) } else { 0.0 };
        }
    }
    out
}

/// R by what the last `M` updates left over: the mean of residual squared and its own uncertainty,
/// `R = (1/M) Σ (e e' + H P⁺ H')`, row by row. With the R that was used and S = H P⁻ H' + R, by innovations
///
/// ```text
/// e = (R/S) nu,   H P⁺ H' = R - R²/S,   so that each update says  R + (R/S)² (nu² - S)
/// ```
///
/// which is never negative and says little where P, not R, makes the innovation. The window starts full of the variance that
/// the measurement says; the estimate stays within 1e-4 and 1e4 of that.
///
/// Noise that is coloured is not told from white noise of the same variance: for that the filter must be given its states
/// ([`Model::add_extra`](crate::filter::Model::add_extra)).
///
/// Source: Mehra, Approaches to adaptive filtering, IEEE Trans. Automatic Control 17 (1972), covariance matching; the form by
/// residuals as Mohamed and Schwarz, Adaptive Kalman filtering for INS/GPS, Journal of Geodesy 73 (1999).
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualNoise<const M: usize> {
    said: [[f64; 3]; M],
    count: usize,
}

impl<const M: usize> ResidualNoise<M> {
    /// Nothing has been seen.
    pub const fn new() -> Self {
        ResidualNoise { said: [[0.0; 3]; M], count: 0 }
    }

    /// The estimate.
    fn mean(&self, r: &Square3, len: usize) -> Square3 {
        let mean = |row: usize| self.said.iter().map(|s| s[row]).sum::<f64>() / M as f64;
        bounded(core::array::from_fn(mean), r, len)
    }
}

impl<const M: usize> Default for ResidualNoise<M> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize, const M: usize> Strategy<N> for ResidualNoise<M> {
    fn before(&mut self, _: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        if M == 0 {
            return moment.r;
        }
        if self.count == 0 {
            self.said = [core::array::from_fn(|i| moment.r[i][i]); M];
        }
        let used = self.mean(&moment.r, moment.len());
        for i in 0..moment.len() {
            let (r, nu) = (used[i][i], moment.innovation[i]);
            let s = moment.predicted(i) + r;
            self.said[self.count % M][i] = r + (r / s) * (r / s) * (nu * nu - s);
        }
        self.count += 1;
        self.mean(&moment.r, moment.len())
    }
}

/// R by recursion over all innovations, the older ones fading:
///
/// ```text
/// R_k = b R_{k-1} + (1 - b) (nu nu' - H P⁻ H')
/// ```
///
/// on the diagonal, from the variance that the measurement says; what is used stays within 1e-4 and 1e4 of that. Unlike
/// [`ResidualNoise`] it believes the filter's P, so that it must not be asked while P is large or wrong.
///
/// Source: Sage and Husa, Adaptive filtering with unknown prior statistics, Joint Automatic Control Conference (1969), in the
/// form with fading weights, which start at their final value so that the first innovations do not decide alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SageHusa {
    /// Forgetting factor b, between zero and one, usually 0.95 to 0.99.
    pub b: f64,
    r: Option<[f64; 3]>,
}

impl SageHusa {
    /// With the forgetting factor `b`.
    pub const fn new(b: f64) -> Self {
        SageHusa { b, r: None }
    }
}

impl<const N: usize> Strategy<N> for SageHusa {
    fn before(&mut self, _: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        let old = self.r.unwrap_or(core::array::from_fn(|i| moment.r[i][i]));
        let estimate = core::array::from_fn(|i| {
            let nu = moment.innovation[i];
            let seen = if i < moment.len() { nu * nu - moment.predicted(i) } else { old[i] };
            self.b * old[i] + (1.0 - self.b) * seen
        });
        self.r = Some(estimate);
        bounded(estimate, &moment.r, moment.len())
    }
}
