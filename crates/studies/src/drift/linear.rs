//! Linear propagation on a stationary base: transition matrices of the error dynamics.

use nalgebra::{DMatrix, SMatrix, SVector};
use schuler_frames::Vec3;
use schuler_imu::Instrument;
use schuler_strapdown::{ErrorDynamics, NavError, Vertical};

use super::case::{Case, column};
use super::scene::Scene;

/// Navigation errors and the acceleration state of a third-order baro loop.
const N: usize = 10;
/// Gyro and accelerometer errors along body axes.
const U: usize = 6;
const BARO: usize = 9;

/// `x' = f x + b u`, x the nine errors of [`NavError::as_array`] and the baro state, u = (eps_b, nabla_b).
///
/// Kept in balanced units (position times w, attitude times g/w, w the Schuler rate), in which every
/// entry is a rate: the exponential of the raw matrix would lose digits to its spread.
pub struct Linear {
    f: SMatrix<f64, N, N>,
    b: SMatrix<f64, N, U>,
    scale: SVector<f64, N>,
}

/// One step of constant length of the linear system under inputs that are linear in time.
pub struct Step {
    phi: SMatrix<f64, N, N>,
    /// Answer to a constant input, and to one that grows by one a second from zero.
    gamma: [SMatrix<f64, N, U>; 2],
    scale: SVector<f64, N>,
    dt: f64,
}

impl Linear {
    /// The complete error dynamics.
    pub fn complete(scene: &Scene) -> Linear {
        let dynamics = ErrorDynamics { gravity: scene.gravity, vertical: scene.vertical };
        let system = dynamics.system(&scene.truth, Vec3::claim(scene.f_b));
        let mut f: SMatrix<f64, N, N> = SMatrix::zeros();
        f.fixed_view_mut::<9, 9>(0, 0).copy_from(&system.f);
        if let Vertical::Damped(baro) = scene.vertical {
            // a' = k3 dh, v_D' = … + a, dh = -x_D
            f[(5, BARO)] = 1.0;
            f[(BARO, 2)] = -baro.k3;
        }
        let mut b: SMatrix<f64, N, U> = SMatrix::zeros();
        b.fixed_view_mut::<9, 3>(0, 0).copy_from(&system.b_gyro);
        b.fixed_view_mut::<9, 3>(0, 3).copy_from(&system.b_accel);
        Linear::balanced(f, b, scene)
    }

    /// The single-axis equations of the textbooks: no Foucault coupling, no turn of the tilts with the Earth
    /// and, as their laws for noise are stated, no way from heading into the channels.
    pub fn single_axis(scene: &Scene) -> Linear {
        let site = &scene.site;
        let mut f: SMatrix<f64, N, N> = SMatrix::zeros();
        for axis in 0..2 {
            f[(axis, 3 + axis)] = 1.0;
        }
        (f[(3, 7)], f[(4, 6)]) = (site.g, -site.g);
        (f[(7, 3)], f[(6, 4)]) = (-1.0 / site.r_m, 1.0 / site.r_n);
        let complete = Linear::complete(scene);
        let mut b = complete.b;
        for (row, scale) in complete.scale.iter().enumerate() {
            b.row_mut(row).scale_mut(1.0 / scale);
        }
        b.row_mut(5).fill(0.0);
        Linear::balanced(f, b, scene)
    }

    fn balanced(mut f: SMatrix<f64, N, N>, mut b: SMatrix<f64, N, U>, scene: &Scene) -> Linear {
        let w = (scene.site.g / scene.site.r_m).sqrt();
        let tilt = scene.site.g / w;
        let scale = SVector::from([w, w, w, 1.0, 1.0, 1.0, tilt, tilt, tilt, 1.0 / w]);
        for row in 0..N {
            for column in 0..N {
                f[(row, column)] *= scale[row] / scale[column];
            }
            b.row_mut(row).scale_mut(scale[row]);
        }
        Linear { f, b, scale }
    }

    /// The step of length `dt` (s), by the exponential of the system with its inputs as states.
    pub fn step(&self, dt: f64) -> Step {
        const M: usize = N + 2 * U;
        // The input's unit is chosen so that its column is of the size of the others.
        let unit = self.f.amax() / self.b.amax();
        let mut m = DMatrix::<f64>::zeros(M, M);
        m.view_mut((0, 0), (N, N)).copy_from(&(self.f * dt));
        m.view_mut((0, N), (N, U)).copy_from(&(self.b * (unit * dt)));
        m.view_mut((N, N + U), (U, U)).fill_with_identity();
        let e = m.exp();
        let block = |column: usize| e.fixed_view::<N, U>(0, column).into_owned() / unit;
        Step {
            phi: e.fixed_view::<N, N>(0, 0).into_owned(),
            gamma: [block(N), block(N + U) * dt],
            scale: self.scale,
            dt,
        }
    }

    /// Standard deviations of the errors that the random sources of `case` cause, at the rows of the scene.
    pub fn sigmas(&self, scene: &Scene, case: &Case) -> Vec<NavError> {
        let models: Vec<_> = case
            .spec
            .components()
            .map(|c| {
                let column = column(&c, scene);
                let offset = if c.instrument() == Instrument::Gyro { 0 } else { 3 };
                let mut entry: SVector<f64, N> = SVector::zeros();
                for axis in 0..3 {
                    entry += self.b.column(offset + axis) * column[axis];
                }
                (entry, c.evolution().linear_model())
            })
            .collect();
        let states: usize = models.iter().map(|(_, m)| m.n).sum();
        let n = N + states;
        let (mut a, mut q, mut p) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        a.view_mut((0, 0), (N, N)).copy_from(&self.f);
        let mut at = N;
        for (entry, m) in &models {
            let mut nav_q = q.view_mut((0, 0), (N, N));
            nav_q += entry * entry.transpose() * m.white;
            for i in 0..m.n {
                // A state of size one makes the balanced errors grow like the Schuler rate would.
                let size = |k: usize| unit_of(entry.amax() * m.c[k].abs(), self.f.amax());
                for r in 0..N {
                    a[(r, at + i)] = entry[r] * m.c[i] * size(i);
                }
                for j in 0..m.n {
                    a[(at + i, at + j)] = m.a[i][j] * size(j) / size(i);
                    q[(at + i, at + j)] = m.q[i][j] / (size(i) * size(j));
                    p[(at + i, at + j)] = m.p0[i][j] / (size(i) * size(j));
                }
            }
            at += m.n;
        }
        let mut steps: Vec<(u64, DMatrix<f64>, DMatrix<f64>)> = Vec::new();
        let mut rows = vec![self.deviation(&p)];
        for pair in scene.rows.windows(2) {
            let count = pair[1] - pair[0];
            let known = steps.iter().position(|(c, _, _)| *c == count);
            let k = known.unwrap_or_else(|| {
                let (phi, qd) = van_loan(&a, &q, count as f64 * scene.dt);
                steps.push((count, phi, qd));
                steps.len() - 1
            });
            let (_, phi, qd) = &steps[k];
            p = phi * &p * phi.transpose() + qd;
            rows.push(self.deviation(&p));
        }
        rows
    }

    fn deviation(&self, p: &DMatrix<f64>) -> NavError {
        // A variance that is zero but for rounding may come out below zero; anything else must show.
        let sd = |k: usize| if p[(k, k)].abs() < 1e-30 { 0.0 } else { p[(k, k)].sqrt() / self.scale[k] };
        NavError {
            dr: Vec3::new(sd(0), sd(1), sd(2)),
            dv: Vec3::new(sd(3), sd(4), sd(5)),
            phi: Vec3::new(sd(6), sd(7), sd(8)),
        }
    }
}

/// The unit of a state whose effect of size `effect` shall have the size `wanted`.
fn unit_of(effect: f64, wanted: f64) -> f64 {
    if effect > 0.0 { wanted / effect } else { 1.0 }
}

/// Transition matrix and noise covariance of `x' = a x + w`, w of density q, over `dt` seconds.
///
/// Van Loan's exponential holds exp(-a h) beside exp(a h): over a step that is long against the fastest time
/// constant it cancels or overflows. So it is taken over a short step and doubled, which only adds what is positive.
/// Source: C. F. Van Loan, Computing integrals involving the matrix exponential, IEEE Trans. Automatic
/// Control 23 (1978).
pub(crate) fn van_loan(a: &DMatrix<f64>, q: &DMatrix<f64>, dt: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let n = a.nrows();
    let mut doublings = 0;
    while a.norm() * dt * 0.5f64.powi(doublings) > 0.5 {
        doublings += 1;
    }
    let h = dt * 0.5f64.powi(doublings);
    // The covariance is linear in q, so that q may enter at the size of a.
    let unit = unit_of(q.amax(), a.amax());
    let mut m = DMatrix::zeros(2 * n, 2 * n);
    m.view_mut((0, 0), (n, n)).copy_from(&(a * -h));
    m.view_mut((0, n), (n, n)).copy_from(&(q * (h * unit)));
    m.view_mut((n, n), (n, n)).copy_from(&(a.transpose() * h));
    let e = m.exp();
    let mut phi = e.view((n, n), (n, n)).transpose();
    let mut qd = &phi * e.view((0, n), (n, n)) / unit;
    for _ in 0..doublings {
        qd = &phi * &qd * phi.transpose() + &qd;
        phi = &phi * &phi;
    }
    let symmetric = (&qd + qd.transpose()) * 0.5;
    (phi, symmetric)
}

/// A linear error state on its way.
pub struct Path<'a> {
    step: &'a Step,
    x: SVector<f64, N>,
}

impl<'a> Path<'a> {
    /// Begins with the initial errors of `case` times the units of `step`.
    pub fn new(step: &'a Step, case: &Case) -> Self {
        let mut x = SVector::zeros();
        for (k, value) in case.initial_errors().iter().flatten().enumerate() {
            x[k] = value * step.scale[k];
        }
        Path { step, x }
    }

    /// One step under the input `u` at its start and its rate.
    #[inline]
    pub fn advance(&mut self, u: &SVector<f64, U>, rate: &SVector<f64, U>) {
        self.x = self.step.phi * self.x + self.step.gamma[0] * u + self.step.gamma[1] * rate;
    }

    /// One step under the constant input `u`.
    #[inline]
    pub fn advance_constant(&mut self, u: &SVector<f64, U>) {
        self.x = self.step.phi * self.x + self.step.gamma[0] * u;
    }

    /// The errors now.
    pub fn errors(&self) -> NavError {
        let x = |k: usize| self.x[k] / self.step.scale[k];
        NavError {
            dr: Vec3::new(x(0), x(1), x(2)),
            dv: Vec3::new(x(3), x(4), x(5)),
            phi: Vec3::new(x(6), x(7), x(8)),
        }
    }
}

/// Linear propagation of the known errors of `case` from row to row, exact whatever the distance of rows.
pub fn propagate(linear: &Linear, scene: &Scene, case: &Case) -> Vec<NavError> {
    let [[eps, eps_rate], [nabla, nabla_rate]] = case.known_errors(scene);
    let join = |a: [f64; 3], b: [f64; 3]| SVector::<f64, U>::from([a[0], a[1], a[2], b[0], b[1], b[2]]);
    let (mut u, rate) = (join(eps, nabla), join(eps_rate, nabla_rate));
    let mut steps: Vec<(u64, Step)> = Vec::new();
    let mut x: Option<SVector<f64, N>> = None;
    let mut rows = Vec::with_capacity(scene.rows.len());
    for pair in std::iter::once([0, 0]).chain(scene.rows.windows(2).map(|w| [w[0], w[1]])) {
        let count = pair[1] - pair[0];
        if !steps.iter().any(|(c, _)| *c == count) {
            steps.push((count, linear.step(count as f64 * scene.dt)));
        }
        let step = &steps.iter().find(|(c, _)| *c == count).expect("invariant: pushed just above").1;
        let mut path = Path::new(step, case);
        path.x = x.unwrap_or(path.x);
        path.advance(&u, &rate);
        u += rate * step.dt;
        rows.push(path.errors());
        x = Some(path.x);
    }
    rows
}

/// The inputs of one sample as the linear system takes them.
#[inline]
pub fn input(omega_error: [f64; 3], f_error: [f64; 3]) -> SVector<f64, U> {
    let ([a, b, c], [d, e, f]) = (omega_error, f_error);
    SVector::from([a, b, c, d, e, f])
}
