//! Exact discretisation of constant dynamics over a step of any length.

use nalgebra::SMatrix;
use schuler_imu::Truth;

use super::block::Block;
use super::{Model, Propagation};
use crate::System;

/// Navigation errors and the states of one block.
const D: usize = 9 + super::block::MAX_BLOCK;

type Square = SMatrix<f64, D, D>;

impl<const N: usize> Propagation<N> {
    /// The exact transition and process noise over `dt` (s) where nothing changes: under `system` (of the model's form),
    /// the sensors having `seen` the same rate and specific force all the time.
    ///
    /// Each block of source states, together with the navigation errors that it drives, is discretised by itself,
    /// because blocks do not act upon each other:
    ///
    /// ```text
    /// A = [F  b c],   Phi = exp(A dt),   Q = ∫ exp(A s) Q_c exp(A s)' ds from 0 to dt
    ///     [0  a  ]
    /// ```
    ///
    /// by their series over a step halved until it is short, then Q := Phi Q Phi' + Q and Phi := Phi² for each halving.
    /// Same result as Van Loan's method (IEEE Trans. Automatic Control 23, 1978), without its exp(-A dt).
    pub fn exact(model: &Model<N>, system: &System, seen: &Truth, dt: f64) -> Self {
        let mut out = Propagation::identity(model);
        out.dt = dt;
        let inputs = model.inputs(seen, dt);
        let full = model.full();
        let kept = |k: usize| full.contains(&k);

        let mut nav = Square::zeros();
        let mut density = Square::zeros();
        let white = model.nav_density(system, &inputs);
        for (i, j) in (0..9).flat_map(|i| (0..9).map(move |j| (i, j))).filter(|&(i, j)| kept(i) && kept(j)) {
            nav[(i, j)] = system.f[(i, j)];
            density[(i, j)] = white[(i, j)];
        }
        let size = nav_size(&nav);
        let (phi, q) = discretize(&nav, &density, size, dt);
        for (i, &full_i) in full.iter().enumerate() {
            for (j, &full_j) in full.iter().enumerate() {
                out.phi_n[j][i] = phi[(full_i, full_j)];
                out.q_n[i][j] = q[(full_i, full_j)];
            }
        }

        for block in model.blocks().filter(|b| b.len > 0) {
            let (a, density) = with_block(&nav, system, block, block.column(&inputs), &kept);
            let rate = libm::sqrt(block.a.iter().flatten().map(|x| x * x).sum());
            let (phi, q) = discretize(&a, &density, size + rate, dt);
            for (k, s) in block.states().enumerate() {
                for (i, &full_i) in full.iter().enumerate() {
                    out.phi_n[s][i] = phi[(full_i, 9 + k)];
                    out.q_n[i][s] = q[(full_i, 9 + k)];
                }
                for l in 0..block.len {
                    out.sources.set(s, l, block.len == 2, phi[(9 + k, 9 + l)], q[(9 + k, 9 + l)]);
                }
            }
            for (i, &full_i) in full.iter().enumerate() {
                for (j, &full_j) in full.iter().enumerate() {
                    out.q_n[i][j] += q[(full_i, full_j)];
                }
            }
        }
        out
    }
}

/// The dynamics `nav` with the states of `block` behind them, and the density of what drives those.
fn with_block(
    nav: &Square,
    system: &System,
    block: &Block,
    column: [f64; 3],
    kept: &impl Fn(usize) -> bool,
) -> (Square, Square) {
    let (mut a, mut density) = (*nav, Square::zeros());
    let column = nalgebra::Vector3::from(column);
    let enters = match block.instrument() {
        Some(schuler_imu::Instrument::Gyro) => system.b_gyro * column,
        Some(schuler_imu::Instrument::Accel) => system.b_accel * column,
        None => SMatrix::zeros(),
    };
    for k in 0..block.len {
        for i in (0..9).filter(|&i| kept(i)) {
            a[(i, 9 + k)] = enters[i] * block.c[k];
        }
        for l in 0..block.len {
            a[(9 + k, 9 + l)] = block.a[k][l];
            density[(9 + k, 9 + l)] = block.q[k][l];
        }
    }
    (a, density)
}

/// Norm of navigation dynamics in units in which every entry is of the size of a rate: metres by the Schuler rate,
/// radians by g over it.
fn nav_size(a: &Square) -> f64 {
    const W: f64 = 1.25e-3;
    const UNIT: [f64; 3] = [W, 1.0, 9.8 / W];
    let square = |i: usize, j: usize| {
        let scaled = a[(i, j)] * UNIT[i / 3] / UNIT[j / 3];
        scaled * scaled
    };
    libm::sqrt((0..9).flat_map(|i| (0..9).map(move |j| (i, j))).map(|(i, j)| square(i, j)).sum())
}

/// Transition and noise of `a` driven by `density` over `dt`; `size` bounds the rates of `a`.
///
/// By the series of both over a short step, then doubled.
pub(crate) fn discretize<const M: usize>(
    a: &SMatrix<f64, M, M>,
    density: &SMatrix<f64, M, M>,
    size: f64,
    dt: f64,
) -> (SMatrix<f64, M, M>, SMatrix<f64, M, M>) {
    let mut halvings = 0;
    while libm::ldexp(size * dt, -halvings) > 0.1 && halvings < 60 {
        halvings += 1;
    }
    let h = libm::ldexp(dt, -halvings);
    let a = a * h;
    // Terms of order k are below 0.1^k/k! and 0.2^k/(k+1)!: the first left out is below 1e-17 of the sum.
    const ORDER: u32 = 12;
    let mut phi = SMatrix::<f64, M, M>::identity();
    for k in (1..ORDER).rev() {
        phi = SMatrix::identity() + a * phi * (1.0 / f64::from(k));
    }
    let mut q = SMatrix::<f64, M, M>::zeros();
    if density.iter().any(|d| *d != 0.0) {
        let mut term = density * h;
        q = term;
        for k in 2..=ORDER {
            let turned = a * term;
            term = (turned + turned.transpose()) * (1.0 / f64::from(k));
            q += term;
        }
    }
    for _ in 0..halvings {
        q += phi * q * phi.transpose();
        phi = phi * phi;
    }
    (phi, (q + q.transpose()) * 0.5)
}
