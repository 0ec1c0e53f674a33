/// Most states of the linear model of one coefficient.
pub const MAX_STATES: usize = 12;

/// A coefficient c(t) as output of a continuous linear system driven by white noise:
///
/// ```text
/// x' = A x + w,   w white of spectral density Q
/// c  = C x + v,   v white of spectral density `white`
/// ```
///
/// with `x(0)` of mean `x0` and covariance `p0`. Only the first `n` states are in use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearModel {
    /// Number of states.
    pub n: usize,
    /// System matrix A, 1/s.
    pub a: [[f64; MAX_STATES]; MAX_STATES],
    /// Two-sided spectral density Q of the noise that drives the states.
    pub q: [[f64; MAX_STATES]; MAX_STATES],
    /// Output row C.
    pub c: [f64; MAX_STATES],
    /// Mean of the initial state: not zero where a value was fixed.
    pub x0: [f64; MAX_STATES],
    /// Covariance of the initial state.
    pub p0: [[f64; MAX_STATES]; MAX_STATES],
    /// Two-sided spectral density of white noise added to the coefficient, unit² s.
    pub white: f64,
}

impl LinearModel {
    /// A model without states and without noise.
    pub const NONE: LinearModel = LinearModel {
        n: 0,
        a: [[0.0; MAX_STATES]; MAX_STATES],
        q: [[0.0; MAX_STATES]; MAX_STATES],
        c: [0.0; MAX_STATES],
        x0: [0.0; MAX_STATES],
        p0: [[0.0; MAX_STATES]; MAX_STATES],
        white: 0.0,
    };

    /// One state that is the coefficient itself: x' = a x + w with density `q`.
    pub fn scalar(a: f64, q: f64, x0: f64, p0: f64) -> LinearModel {
        let mut m = LinearModel { n: 1, ..LinearModel::NONE };
        (m.a[0][0], m.q[0][0], m.c[0], m.x0[0], m.p0[0][0]) = (a, q, 1.0, x0, p0);
        m
    }

    /// Two states of which the first is the coefficient, moved by the system matrix `a`.
    pub fn planar(a: [[f64; 2]; 2], x0: [f64; 2]) -> LinearModel {
        let mut m = LinearModel { n: 2, ..LinearModel::NONE };
        for i in 0..2 {
            m.a[i][..2].copy_from_slice(&a[i]);
        }
        m.c[0] = 1.0;
        m.x0[..2].copy_from_slice(&x0);
        m
    }

    /// The sum of two independent coefficients. States beyond [`MAX_STATES`] are dropped, which
    /// validated processes do not reach.
    pub fn plus(mut self, o: &LinearModel) -> LinearModel {
        let n = self.n;
        for i in 0..o.n.min(MAX_STATES - n) {
            for j in 0..o.n.min(MAX_STATES - n) {
                self.a[n + i][n + j] = o.a[i][j];
                self.q[n + i][n + j] = o.q[i][j];
                self.p0[n + i][n + j] = o.p0[i][j];
            }
            self.c[n + i] = o.c[i];
            self.x0[n + i] = o.x0[i];
        }
        self.n = (n + o.n).min(MAX_STATES);
        self.white += o.white;
        self
    }
}
