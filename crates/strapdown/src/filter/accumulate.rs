//! Transition and process noise accumulated over several IMU steps.

use nalgebra::{Matrix3, SMatrix, Vector3};
use schuler_frames::{B, Dcm, Rot, T, Vec3};
use schuler_imu::{Instrument, Truth};

use super::small_process::SmallStep;
use super::{Model, Propagation};
use crate::{ErrorDynamics, Increments, Pva, Vertical};

type Nine = SMatrix<f64, 9, 9>;

/// Gathers what the transition over an interval needs, IMU step by IMU step, for a fraction of the cost of a time update.
///
/// In the error dynamics, three things are fast: attitude, specific force and sensor axes turn with the body,
///
/// ```text
/// dr' = dv,   dv' = f_t × phi + C nabla,   phi' = -C eps
/// ```
///
/// and these are nilpotent: their transition is a set of plain sums over the steps, in the order of time (the same sums as
/// in the preintegration of IMU samples). All else, S (Earth and transport rate, Coriolis, gravity gradient, metric,
/// damping), is slow and taken in the middle of the interval:
///
/// ```text
/// Phi = exp(S T/2) Phi_fast exp(S T/2),   Q = exp(S T/2) Q_fast exp(S T/2)'
/// ```
///
/// (the symmetric splitting of Strang, SIAM J. Numer. Anal. 5, 1968: what it leaves out is of third order in T, times two
/// slow rates or one slow and the turn over T). Intervals of up to a second are meant; for constant dynamics over longer
/// ones there is [`Propagation::exact`].
#[derive(Clone, Debug)]
pub struct Accumulator<const N: usize> {
    dynamics: ErrorDynamics,
    start: Pva,
    end: Pva,
    /// Length so far, and of the last step.
    t: f64,
    dt: f64,
    /// Integral of f_t, and its integral.
    m0: Vector3<f64>,
    m1: Vector3<f64>,
    /// Integral of C.
    c0: Matrix3<f64>,
    /// Integrals of the densities of white noise in t: gyro, accelerometer.
    white: [Matrix3<f64>; 2],
    /// Attitude, velocity and position error that a unit of each source state has made so far.
    phi: [[f64; N]; 3],
    dv: [[f64; N]; 3],
    dr: [[f64; N]; 3],
    /// Direction in t in which each block has entered, integrated.
    way: [[f64; 3]; N],
    /// Coefficient of its block that a unit of each state at the start makes now.
    weight: [f64; N],
    /// Each block over one step, and over one interval, of the lengths that came last.
    of_step: [Option<SmallStep>; N],
    of_interval: [Option<SmallStep>; N],
    interval: f64,
}

impl<const N: usize> Accumulator<N> {
    /// An interval that begins with the navigator at `pva`.
    pub fn new(model: &Model<N>, dynamics: ErrorDynamics, pva: &Pva) -> Self {
        let mut new = Accumulator {
            dynamics,
            start: *pva,
            end: *pva,
            t: 0.0,
            dt: 0.0,
            m0: Vector3::zeros(),
            m1: Vector3::zeros(),
            c0: Matrix3::zeros(),
            white: [Matrix3::zeros(); 2],
            phi: [[0.0; N]; 3],
            dv: [[0.0; N]; 3],
            dr: [[0.0; N]; 3],
            way: [[0.0; 3]; N],
            weight: [0.0; N],
            of_step: [None; N],
            of_interval: [None; N],
            interval: 0.0,
        };
        new.begin(model, pva);
        new
    }

    /// Begins anew with the navigator at `pva`: after a correction of it.
    pub fn begin(&mut self, model: &Model<N>, pva: &Pva) {
        (self.start, self.end) = (*pva, *pva);
        self.t = 0.0;
        (self.m0, self.m1, self.c0) = (Vector3::zeros(), Vector3::zeros(), Matrix3::zeros());
        self.white = [Matrix3::zeros(); 2];
        (self.phi, self.dv, self.dr) = ([[0.0; N]; 3], [[0.0; N]; 3], [[0.0; N]; 3]);
        self.way = [[0.0; 3]; N];
        for block in model.blocks() {
            self.weight[block.first..block.first + block.len].copy_from_slice(&block.c[..block.len]);
        }
    }

    /// Length of the interval so far, s.
    pub fn elapsed(&self) -> f64 {
        self.t
    }

    /// One IMU step of `dt` (s), after which the navigator is at `pva`. `increments` are what it was fed with.
    pub fn step(&mut self, model: &Model<N>, pva: &Pva, increments: &Increments, dt: f64) {
        let seen = Truth::increments(increments.dtheta.as_array(), increments.dv.as_array());
        self.step_seen(model, pva, &seen, increments, dt);
    }

    /// As [`Accumulator::step`] where thermal and other terms need to know what else the sensors have `seen`.
    pub fn step_seen(&mut self, model: &Model<N>, pva: &Pva, seen: &Truth, increments: &Increments, dt: f64) {
        if dt != self.dt {
            self.dt = dt;
            for (slot, block) in self.of_step.iter_mut().zip(model.blocks()) {
                *slot = Some(SmallStep::new(block, dt));
            }
        }
        let c = midway(self.end.c_tb, pva.c_tb);
        self.end = *pva;
        let a = c * increments.dv.as_nalgebra();
        let inputs = model.inputs(seen, dt);
        for (sum, instrument) in self.white.iter_mut().zip(Instrument::ALL) {
            *sum += c * model.white(instrument, &inputs) * c.transpose() * dt;
        }
        for (number, block) in model.blocks().enumerate() {
            let Some(step) = self.of_step[number] else { continue };
            let direction = c * Vector3::from(block.column(&inputs)) * dt;
            for axis in 0..3 {
                self.way[number][axis] += direction[axis];
            }
            let first = block.first;
            let w: [f64; 2] =
                core::array::from_fn(|k| if k < block.len { self.weight[first + k] } else { 0.0 });
            // The row w(t) = c e^(a t): its mean over the step.
            let carried =
                |m: &[[f64; 2]; 2]| [w[0] * m[0][0] + w[1] * m[1][0], w[0] * m[0][1] + w[1] * m[1][1]];
            let mean = carried(&step.average);
            for k in 0..block.len {
                let s = first + k;
                let push = direction * mean[k];
                let mut theta = Vector3::new(self.phi[0][s], self.phi[1][s], self.phi[2][s]);
                let dv = match block.instrument() {
                    Some(Instrument::Gyro) => {
                        theta -= push * 0.5;
                        a.cross(&theta)
                    }
                    Some(Instrument::Accel) => a.cross(&theta) + push,
                    None => Vector3::zeros(),
                };
                for axis in 0..3 {
                    self.dr[axis][s] += dt * (self.dv[axis][s] + 0.5 * dv[axis]);
                    self.dv[axis][s] += dv[axis];
                    if block.instrument() == Some(Instrument::Gyro) {
                        self.phi[axis][s] -= push[axis];
                    }
                }
            }
            self.weight[first..first + block.len].copy_from_slice(&carried(&step.phi)[..block.len]);
        }
        self.m1 += (self.m0 + a * 0.5) * dt;
        self.m0 += a;
        self.c0 += c * dt;
        self.t += dt;
    }

    /// Ends the interval: its transition and process noise. The next one begins where this one ends.
    pub fn close(&mut self, model: &Model<N>) -> Propagation<N> {
        let mut out = Propagation::identity(model);
        let t = self.t;
        if t <= 0.0 {
            return out;
        }
        out.dt = t;
        if t != self.interval {
            self.interval = t;
            for (slot, block) in self.of_interval.iter_mut().zip(model.blocks()) {
                *slot = Some(SmallStep::new(block, t));
            }
        }
        let force = self.m0 / t;
        let half = exponential(&(self.slow(model, force) * (0.5 * t)));

        let mut fast = Nine::identity();
        fast.fixed_view_mut::<3, 3>(0, 3).fill_diagonal(t);
        fast.fixed_view_mut::<3, 3>(0, 6).copy_from(&self.m1.cross_matrix());
        fast.fixed_view_mut::<3, 3>(3, 6).copy_from(&self.m0.cross_matrix());
        let mut q = self.fast_noise(model, force);
        let held = self.dynamics.vertical == Vertical::Held;
        if held {
            for row in [2, 5] {
                fast.row_mut(row).fill(0.0);
                fast[(row, row)] = 1.0;
            }
        }

        let full = model.full();
        for (number, block) in model.blocks().enumerate() {
            let Some(step) = &self.of_interval[number] else { continue };
            let along = Vector3::from(self.way[number]) / t;
            // Directions in which z3, z2 and z1 of the block enter position, velocity and attitude.
            let mut reach = [[0.0; 3]; 9];
            for axis in 0..3 {
                match block.instrument() {
                    Some(Instrument::Gyro) => {
                        let tilt = -along;
                        let push = force.cross(&tilt);
                        reach[axis][0] = push[axis];
                        reach[3 + axis][1] = push[axis];
                        reach[6 + axis][2] = tilt[axis];
                    }
                    Some(Instrument::Accel) => {
                        reach[axis][1] = along[axis];
                        reach[3 + axis][2] = along[axis];
                    }
                    None => {}
                }
            }
            if held {
                (reach[2], reach[5]) = ([0.0; 3], [0.0; 3]);
            }
            let driven = block.q.iter().flatten().any(|q| *q != 0.0);
            if driven {
                for i in 0..9 {
                    for j in 0..9 {
                        let mut sum = 0.0;
                        for k in 0..3 {
                            for l in 0..3 {
                                sum += reach[i][k] * step.q[(k, l)] * reach[j][l];
                            }
                        }
                        q[(i, j)] += sum;
                    }
                }
            }
            for k in 0..block.len {
                let s = block.first + k;
                let mut column = nalgebra::SVector::<f64, 9>::zeros();
                let mut cross = nalgebra::SVector::<f64, 9>::zeros();
                for axis in 0..3 {
                    let keep = !(held && axis == 2);
                    column[axis] = if keep { self.dr[axis][s] } else { 0.0 };
                    column[3 + axis] = if keep { self.dv[axis][s] } else { 0.0 };
                    column[6 + axis] = self.phi[axis][s];
                }
                for i in 0..9 {
                    cross[i] = (0..3).map(|z| reach[i][z] * step.q[(z, 3 + k)]).sum();
                }
                let (column, cross) = (half * column, half * cross);
                for (i, &full_i) in full.iter().enumerate() {
                    out.phi_n[i][s] = column[full_i];
                    out.q_n[i][s] = cross[full_i];
                }
                for l in 0..block.len {
                    out.phi_s[s][l] = step.phi[k][l];
                    out.q_s[s][l] = step.q[(3 + k, 3 + l)];
                }
            }
        }

        let phi = half * fast * half;
        let q = half * q * half.transpose();
        for (i, &full_i) in full.iter().enumerate() {
            for (j, &full_j) in full.iter().enumerate() {
                out.phi_n[i][j] = phi[(full_i, full_j)];
                out.q_n[i][j] = 0.5 * (q[(full_i, full_j)] + q[(full_j, full_i)]);
            }
        }
        let end = self.end;
        self.begin(model, &end);
        out
    }

    /// Dynamics without the fast part, in the middle of the interval, errors that were left out of the model being zero.
    fn slow(&self, model: &Model<N>, force: Vector3<f64>) -> Nine {
        let (a, b) = (&self.start, &self.end);
        let middle = Pva {
            position: schuler_frames::Geodetic::new(
                0.5 * (a.position.lat + b.position.lat),
                b.position.lon,
                0.5 * (a.position.h + b.position.h),
            ),
            v_t: (a.v_t + b.v_t) * 0.5,
            c_tb: b.c_tb,
        };
        let to_body: Dcm<B, T> = b.c_tb.inverse().as_dcm();
        let f_b = to_body * Vec3::<T>::claim([force[0], force[1], force[2]]);
        let mut s = model.form().system(&self.dynamics, &middle, f_b).f;
        s.fixed_view_mut::<3, 3>(3, 6).fill(0.0);
        for axis in 0..if self.dynamics.vertical == Vertical::Held { 2 } else { 3 } {
            s[(axis, 3 + axis)] -= 1.0;
        }
        for k in (0..9).filter(|k| !model.full().contains(k)) {
            s.row_mut(k).fill(0.0);
            s.column_mut(k).fill(0.0);
        }
        s
    }

    /// Noise of the nine errors by white noise through the fast part, the force being constant: with G, A, R the densities
    /// that drive attitude, velocity and position, and F = [f ×],
    ///
    /// ```text
    /// Q_pp = G T,  Q_vp = F G T²/2,  Q_rp = F G T³/6,  Q_vv = A T + F G F' T³/3,
    /// Q_rv = A T²/2 + F G F' T⁴/8,   Q_rr = R T + A T³/3 + F G F' T⁵/20
    /// ```
    fn fast_noise(&self, model: &Model<N>, force: Vector3<f64>) -> Nine {
        let t = self.t;
        let diagonal = |first: usize| {
            Matrix3::from_diagonal(&Vector3::from_column_slice(&model.nav_noise[first..first + 3]))
        };
        let kept = |first: usize, m: &Matrix3<f64>| {
            Matrix3::from_fn(|i, j| {
                let keep = |k: usize| model.full().contains(&(first + k));
                if keep(i) && keep(j) { m[(i, j)] } else { 0.0 }
            })
        };
        let g = kept(6, &(self.white[0] / t + diagonal(6)));
        let mut accel = self.white[1] / t;
        if self.dynamics.vertical == Vertical::Held {
            accel.row_mut(2).fill(0.0);
            accel.column_mut(2).fill(0.0);
        }
        let a = kept(3, &(accel + diagonal(3)));
        let r = kept(0, &diagonal(0));
        let mut f = force.cross_matrix();
        if self.dynamics.vertical == Vertical::Held {
            f.row_mut(2).fill(0.0);
        }
        // The first moment of the force is known as it was.
        let mut moment = (self.m0 * t - self.m1).cross_matrix();
        if self.dynamics.vertical == Vertical::Held {
            moment.row_mut(2).fill(0.0);
        }
        let fg = f * g;
        let fgf = fg * f.transpose();
        let (t2, t3) = (t * t, t * t * t);
        let mut q = Nine::zeros();
        let mut block = |row: usize, column: usize, m: Matrix3<f64>| {
            q.fixed_view_mut::<3, 3>(row, column).copy_from(&m);
            if row != column {
                q.fixed_view_mut::<3, 3>(column, row).copy_from(&m.transpose());
            }
        };
        block(6, 6, g * t);
        block(3, 6, moment * g);
        block(0, 6, fg * (t3 / 6.0));
        block(3, 3, a * t + fgf * (t3 / 3.0));
        block(0, 3, a * (t2 / 2.0) + fgf * (t2 * t2 / 8.0));
        block(0, 0, r * t + a * (t3 / 3.0) + fgf * (t3 * t2 / 20.0));
        q
    }
}

/// The attitude half way between two near ones: the sum of their quaternions, made a unit.
fn midway(a: Rot<T, B>, b: Rot<T, B>) -> Matrix3<f64> {
    let (a, b) = (a.as_quaternion(), b.as_quaternion());
    // q and -q are the same attitude.
    let sign = if a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0.0 { -1.0 } else { 1.0 };
    let [w, x, y, z]: [f64; 4] = core::array::from_fn(|k| a[k] + sign * b[k]);
    let k = 2.0 / (w * w + x * x + y * y + z * z);
    let (x2, y2, z2) = (k * x, k * y, k * z);
    Matrix3::new(
        1.0 - y * y2 - z * z2,
        x * y2 - w * z2,
        x * z2 + w * y2,
        x * y2 + w * z2,
        1.0 - x * x2 - z * z2,
        y * z2 - w * x2,
        x * z2 - w * y2,
        y * z2 + w * x2,
        1.0 - x * x2 - y * y2,
    )
}

/// exp(m) of a small matrix: four terms.
fn exponential(m: &Nine) -> Nine {
    let id = Nine::identity();
    id + m * (id + m * (id + m * (id + m * 0.25) * (1.0 / 3.0)) * 0.5)
}
