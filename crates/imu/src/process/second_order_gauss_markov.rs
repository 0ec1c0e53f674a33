use core::f64::consts::TAU;

use libm::{exp, expm1, sqrt};

use super::{Arguments, Form, LinearModel, Parameter, ParameterUnit, ProcessKind, Range, Shape, Step};
use crate::Unit;

/// Second-order Gauss-Markov process with two equal poles, stationary from t = 0.
///
/// Smoother than the first order: the coefficient has a derivative. States are the coefficient and
/// its derivative.
pub struct SecondOrderGaussMarkov;

impl ProcessKind for SecondOrderGaussMarkov {
    fn name(&self) -> &'static str {
        "second_order_gauss_markov"
    }
    fn doc(&self) -> &'static str {
        "Second-order Gauss-Markov process (two equal poles), stationary from t = 0"
    }
    fn formula(&self) -> &'static str {
        "c'' = -2 c'/tau - c/tau^2 + w, E c(t) c(s) = sigma^2 (1 + |t - s|/tau) exp(-|t - s|/tau)"
    }
    fn source(&self) -> &'static str {
        "Gelb, Applied Optimal Estimation, second-order Gauss-Markov process"
    }
    fn forms(&self) -> &'static [Form] {
        const FORMS: &[Form] = &[&[
            Parameter {
                name: "sigma",
                unit: ParameterUnit::Coefficient(0),
                range: Range::NonNegative,
                example: 1.0,
                doc: "standard deviation at any time",
            },
            Parameter {
                name: "tau",
                unit: ParameterUnit::Own(Unit::SECOND),
                range: Range::Positive,
                example: 2.0,
                doc: "time constant of each of the two poles",
            },
        ]];
        FORMS
    }
    fn shape(&self, _: &Arguments) -> Shape {
        Shape::Second
    }
    fn initial(&self, a: &Arguments, _: usize, [w1, w2]: [f64; 2]) -> [f64; 2] {
        let [sigma, tau, ..] = a.values;
        [sigma * w1, sigma / tau * w2]
    }
    /// The covariance of (c, c', mean) is the integral over the interval of the products of their
    /// responses to an impulse, taken numerically: all its parts are positive, so nothing cancels,
    /// where the closed form loses everything for steps much shorter than tau.
    fn step(&self, a: &Arguments, _: usize, dt: f64) -> Step {
        let [sigma, tau, ..] = a.values;
        let u = dt / tau;
        let e = exp(-u);
        // In units of tau and sigma; white noise that drives c'' has density 4.
        let mut covariance = [[0.0; 3]; 3];
        let mut mean = [0.0; 2];
        quadrature(u, |s, weight| {
            let e = exp(-s);
            let response = [s * e, (1.0 - s) * e, mean_response(s) / u];
            for (row, r) in covariance.iter_mut().zip(response) {
                row.iter_mut().zip(response).for_each(|(c, q)| *c += 4.0 * weight * r * q);
            }
            mean[0] += weight * (1.0 + s) * e / u;
            mean[1] += weight * s * e / u;
        });
        let mut noise = cholesky(covariance);
        for (row, scale) in noise.iter_mut().zip([sigma, sigma / tau, sigma]) {
            row.iter_mut().for_each(|n| *n *= scale);
        }
        Step {
            phi: [[(1.0 + u) * e, dt * e], [-u / tau * e, (1.0 - u) * e]],
            mean: [mean[0], mean[1] * tau],
            noise,
        }
    }
    fn linear_model(&self, a: &Arguments) -> LinearModel {
        let [sigma, tau, ..] = a.values;
        let beta = 1.0 / tau;
        let mut m = LinearModel::planar([[0.0, 1.0], [-beta * beta, -2.0 * beta]], [0.0; 2]);
        m.q[1][1] = 4.0 * beta * beta * beta * sigma * sigma;
        (m.p0[0][0], m.p0[1][1]) = (sigma * sigma, beta * beta * sigma * sigma);
        m
    }
    /// s²/x² (4x - 9 + 4 (3 + x) e^-x - (3 + 2x) e^-2x) with x = averaging time over tau.
    fn allan_variance(&self, a: &Arguments, averaging: f64) -> f64 {
        let [sigma, tau, ..] = a.values;
        let x = averaging / tau;
        let bracket = if x > 1.0 {
            4.0 * x - 9.0 + 4.0 * (3.0 + x) * exp(-x) - (3.0 + 2.0 * x) * exp(-2.0 * x)
        } else {
            // The same as a power series, whose terms begin with x^4/2.
            let mut power = -x * x * x / 6.0;
            (4..40)
                .map(|n| {
                    let n = f64::from(n);
                    power *= -x / n;
                    power * (n - 3.0) * (libm::exp2(n) - 4.0)
                })
                .sum()
        };
        sigma * sigma * bracket / (x * x)
    }
    fn spectrum(&self, a: &Arguments, f: f64) -> Option<f64> {
        let [sigma, tau, ..] = a.values;
        let w = TAU * f * tau;
        let d = 1.0 + w * w;
        Some(4.0 * sigma * sigma * tau / (d * d))
    }
}

/// 1 - (1 + s) e^-s, the integral from 0 to s of r e^-r.
fn mean_response(s: f64) -> f64 {
    if s > 0.5 {
        return -expm1(-s) - s * exp(-s);
    }
    let mut term = 0.5 * s * s;
    (0..18)
        .map(|k| {
            let k = f64::from(k);
            let value = term;
            // r^(k+1) (-1)^k/k! integrates to s^(k+2) (-1)^k/(k! (k+2)).
            term *= -s * (k + 2.0) / ((k + 1.0) * (k + 3.0));
            value
        })
        .sum()
}

/// Calls `add(s, weight)` for the nodes of a quadrature over 0 to `end` of functions like
/// polynomials times e^-s: Gauss-Legendre with five points on panels of at most 1/4, and beyond
/// 40, where only constants are left, one panel.
fn quadrature(end: f64, mut add: impl FnMut(f64, f64)) {
    // Abramowitz and Stegun 25.4.30, n = 5.
    const NODES: [(f64, f64); 5] = [
        (-0.906_179_845_938_664, 0.236_926_885_056_189),
        (-0.538_469_310_105_683, 0.478_628_670_499_366),
        (0.0, 0.568_888_888_888_889),
        (0.538_469_310_105_683, 0.478_628_670_499_366),
        (0.906_179_845_938_664, 0.236_926_885_056_189),
    ];
    let fine = end.min(40.0);
    let panels = libm::ceil(4.0 * fine);
    let mut panel = |from: f64, width: f64| {
        for (x, w) in NODES {
            add(from + 0.5 * width * (1.0 + x), 0.5 * width * w);
        }
    };
    for k in 0..panels as usize {
        panel(k as f64 * fine / panels, fine / panels);
    }
    if end > fine {
        panel(fine, end - fine);
    }
}

/// Lower triangular factor of a positive semi-definite matrix.
fn cholesky(p: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut l = [[0.0; 3]; 3];
    for j in 0..3 {
        let square: f64 = p[j][j] - (0..j).map(|k| l[j][k] * l[j][k]).sum::<f64>();
        l[j][j] = sqrt(square.max(0.0));
        for i in j + 1..3 {
            let rest: f64 = p[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            l[i][j] = if l[j][j] > 0.0 { rest / l[j][j] } else { 0.0 };
        }
    }
    l
}
