//! Transition and process noise of an interval from what was gathered over it.

use fearless_simd::dispatch;
use nalgebra::{Matrix3, SMatrix, Vector3};
use schuler_frames::{B, Geodetic, T, Vec3};
use schuler_imu::Instrument;

use super::{Accumulator, Model, Propagation};
use crate::{Pva, Vertical};

type Nine = SMatrix<f64, 9, 9>;

/// The slow dynamics over half an interval, by blocks; those that are not there are zero.
struct Slow {
    rr: Matrix3<f64>,
    vr: Matrix3<f64>,
    vv: Matrix3<f64>,
    pr: Matrix3<f64>,
    pv: Matrix3<f64>,
    pp: Matrix3<f64>,
}

impl<const N: usize> Accumulator<N> {
    pub(super) fn finish(&self, model: &Model<N>, out: &mut Propagation<N>) {
        let t = self.t;
        out.dt = t;
        let force = self.m0 / t;
        let slow = self.slow(model, force);
        // Nothing here asks for lanes by itself, but small matrices gain from wide ones.
        let level = self.level;
        dispatch!(level, _simd => self.assemble(model, &slow, force, out));
    }

    #[inline(always)]
    fn assemble(&self, model: &Model<N>, slow: &Slow, force: Vector3<f64>, out: &mut Propagation<N>) {
        self.transition(model, slow, out);
        self.couplings(model, slow, out);
        self.noise(model, force, out);
    }

    /// One where the row down is driven by nothing.
    #[inline(always)]
    fn free(&self) -> Vector3<f64> {
        Vector3::new(1.0, 1.0, if self.dynamics.vertical == Vertical::Held { 0.0 } else { 1.0 })
    }

    /// Dynamics without the fast part, in the middle of the interval, errors that were left out of the model being zero.
    fn slow(&self, model: &Model<N>, force: Vector3<f64>) -> Slow {
        let (a, b) = (&self.start, &self.end);
        let middle = Pva {
            position: Geodetic::new(
                0.5 * (a.position.lat + b.position.lat),
                b.position.lon,
                0.5 * (a.position.h + b.position.h),
            ),
            v_t: self.v0 * (1.0 / self.t),
            c_tb: b.c_tb,
        };
        let f_b: Vec3<B> = b.c_tb.inverse() * Vec3::<T>::claim([force[0], force[1], force[2]]);
        let mut s = model.form().system(&self.dynamics, &middle, f_b).f;
        for (axis, free) in self.free().iter().enumerate() {
            s[(axis, 3 + axis)] -= free;
        }
        if model.nav_len() < 9 {
            for k in (0..9).filter(|k| !model.full().contains(k)) {
                s.row_mut(k).fill(0.0);
                s.column_mut(k).fill(0.0);
            }
        }
        let half = 0.5 * self.t;
        let block = |row: usize, column: usize| s.fixed_view::<3, 3>(row, column) * half;
        Slow {
            rr: block(0, 0),
            vr: block(3, 0),
            vv: block(3, 3),
            pr: block(6, 0),
            pv: block(6, 3),
            pp: block(6, 6),
        }
    }

    /// Phi_nn = E F E by blocks, with E = exp(X), X = S T/2, and F the fast part [I, T, J; 0, I, M; 0, 0, I], J the double and
    /// M the single integral of [f ×]; but the terms with one S, ∫ F(T, t) S F(t, 0) dt, are made right to their order:
    /// where force acts before or after S, its first moment is taken as it was (∫ M(t) dt and the rest of M T, 2/T because
    /// X is half of S T), and with J, the force being constant there, it is two thirds of the product. Products of X with
    /// itself are kept where they turn or damp, and the third term of each Schuler loop (velocity, level, velocity and position,
    /// velocity, position), which counts in the long run: it is (w_s T)²/6 of the first.
    #[inline(always)]
    fn transition(&self, model: &Model<N>, x: &Slow, out: &mut Propagation<N>) {
        let t = self.t;
        let free = Matrix3::from_diagonal(&self.free());
        let (j, m) = (free * self.m1.cross_matrix(), free * self.m0.cross_matrix());
        let before = free * self.m1.cross_matrix() * (2.0 / t);
        let after = free * (self.m0 * t - self.m1).cross_matrix() * (2.0 / t);
        // T where position moves with velocity.
        let tv = free * t;
        let id = Matrix3::identity();
        let mut phi = Nine::zeros();
        let mut block = |row: usize, column: usize, b: Matrix3<f64>| {
            phi.fixed_view_mut::<3, 3>(row, column).copy_from(&b);
        };
        let k = j * (2.0 / 3.0);
        block(0, 0, id + (x.rr + x.rr * x.rr) * 2.0 + tv * x.vr + k * x.pr);
        block(0, 3, tv + x.rr * tv + tv * x.vv + k * x.pv + tv * x.vr * tv * (1.0 / 3.0));
        block(0, 6, j + x.rr * k + k * x.pp + tv * x.vv * m * (1.0 / 3.0));
        block(3, 0, (x.vr + x.vr * x.rr + x.vv * x.vr) * 2.0 + after * x.pr + x.vr * tv * x.vr * (2.0 / 3.0));
        block(3, 3, id + (x.vv + x.vv * x.vv) * 2.0 + x.vr * tv + after * x.pv);
        let round = x.pv * m * (1.0 / 3.0);
        block(3, 6, m + x.vr * k + x.vv * before + after * x.pp + m * round);
        block(6, 0, x.pr * 2.0);
        block(6, 3, x.pv * 2.0 + x.pr * tv + round * x.pv * 2.0);
        block(6, 6, id + (x.pp + x.pp * x.pp) * 2.0 + x.pr * k + x.pv * before);
        for (column, &full_j) in model.full().iter().enumerate() {
            for (i, &full_i) in model.full().iter().enumerate() {
                out.phi_n[column][i] = phi[(full_i, full_j)];
            }
        }
    }

    /// Phi_ns = E F_ns, with one S as in `transition`: ∫ v dt is r, and of r two thirds.
    #[inline(always)]
    fn couplings(&self, model: &Model<N>, x: &Slow, out: &mut Propagation<N>) {
        let (first, free, per_t) = (model.nav_len(), self.free(), 2.0 / self.t);
        let all = first == 9;
        for s in first..model.len() {
            let of = |rows: &[[f64; N]; 3]| {
                Vector3::new(rows[0][s - first], rows[1][s - first], rows[2][s - first])
            };
            let r = of(&self.columns.dr).component_mul(&free);
            let v = of(&self.columns.dv).component_mul(&free);
            let p = of(&self.columns.phi);
            let (of_v, of_r) = (r * per_t, r * (2.0 / 3.0));
            let late = (x.vv * v).component_mul(&free) * (self.t / 3.0);
            let moved = [
                r + x.rr * of_r + late,
                v + x.vr * of_r + x.vv * of_v,
                p + x.pr * of_r + x.pv * of_v + x.pp * p,
            ];
            let column = &mut out.phi_n[s];
            if all {
                for k in 0..9 {
                    column[k] = moved[k / 3][k % 3];
                }
            } else {
                for (i, &full) in model.full().iter().enumerate() {
                    column[i] = moved[full / 3][full % 3];
                }
            }
        }
    }

    /// Noise through the fast part, the force being constant.
    #[inline(always)]
    fn noise(&self, model: &Model<N>, force: Vector3<f64>, out: &mut Propagation<N>) {
        let t = self.t;
        let free = self.free();
        let f = Matrix3::from_diagonal(&free) * force.cross_matrix();
        let mut q = self.white_noise(model, &f);
        let axes = self.c0 / t;
        let mut group = Group::default();
        for (number, block) in model.blocks().enumerate().filter(|(_, b)| b.len > 0) {
            let Some(step) = &self.of_interval[number] else { continue };
            for (k, s) in block.states().enumerate() {
                for l in 0..block.len {
                    out.set_source(s, l, step.phi[k][l], step.q[(3 + k, 3 + l)]);
                }
            }
            let (Some(instrument), true) = (block.instrument(), block.q != [[0.0; 2]; 2]) else { continue };
            let along = match block.column {
                Some(column) => axes * Vector3::from(column),
                None => Vector3::from(self.way[number]) / t,
            };
            // Directions in which the integrals z3, z2, z1 of the coefficient enter position, velocity and attitude, and
            // which integral that is.
            let (reach, z) = match instrument {
                Instrument::Gyro => ([-(f * along), -along], [0, 1, 2]),
                Instrument::Accel => ([along.component_mul(&free), Vector3::zeros()], [1, 2, 2]),
            };
            for (k, s) in block.states().enumerate() {
                for (i, &full) in model.full().iter().enumerate() {
                    let kind = full / 3;
                    out.q_n[i][s] = reach[kind / 2][full % 3] * step.q[(z[kind], 3 + k)];
                }
            }
            let integrals = step.q.fixed_view::<3, 3>(0, 0).into_owned();
            if group.instrument != Some(instrument) || group.integrals != integrals {
                group.add_to(&mut q, &f, &free);
                group = Group { instrument: Some(instrument), integrals, spread: Matrix3::zeros() };
            }
            group.spread += along * along.transpose();
        }
        group.add_to(&mut q, &f, &free);
        for (i, &full_i) in model.full().iter().enumerate() {
            for (j, &full_j) in model.full().iter().enumerate().skip(i) {
                let value = q[(full_i, full_j)];
                (out.q_n[i][j], out.q_n[j][i]) = (value, value);
            }
        }
    }

    /// That of white noise, on and above the diagonal: with G, A, R the densities that drive attitude, velocity and position,
    /// and F = [f ×],
    ///
    /// ```text
    /// Q_pp = G T,  Q_vp = F G T²/2,  Q_rp = F G T³/6,  Q_vv = A T + F G F' T³/3,
    /// Q_rv = A T²/2 + F G F' T⁴/8,   Q_rr = R T + A T³/3 + F G F' T⁵/20
    /// ```
    ///
    /// (in Q_vp the first moment of the force is taken as it was).
    #[inline(always)]
    fn white_noise(&self, model: &Model<N>, f: &Matrix3<f64>) -> Nine {
        let t = self.t;
        let free = self.free();
        let kept = |first: usize| {
            Vector3::from_fn(|k, _| if model.full().contains(&(first + k)) { 1.0 } else { 0.0 })
        };
        let masked = |m: Matrix3<f64>, mask: Vector3<f64>| m.component_mul(&(mask * mask.transpose()));
        let sensor = |k: usize| match self.isotropic[k] {
            Some(density) => Matrix3::from_diagonal_element(density),
            None => self.white[k] / t,
        };
        let g = masked(sensor(0) + diagonal(model, 6), kept(6));
        let a = masked(masked(sensor(1), free) + diagonal(model, 3), kept(3));
        let r = masked(diagonal(model, 0), kept(0));
        let moment = Matrix3::from_diagonal(&free) * (self.m0 * t - self.m1).cross_matrix();
        let fg = f * g;
        let fgf = fg * f.transpose();
        let (t2, t3) = (t * t, t * t * t);
        let mut q = Nine::zeros();
        let mut block = |row: usize, column: usize, m: Matrix3<f64>| {
            q.fixed_view_mut::<3, 3>(row, column).copy_from(&m);
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

/// Blocks of the same behaviour on the axes of one instrument.
#[derive(Default)]
struct Group {
    instrument: Option<Instrument>,
    /// Covariance of the integrals z3, z2, z1 of the coefficient.
    integrals: Matrix3<f64>,
    /// Σ along along' of the directions in which they enter.
    spread: Matrix3<f64>,
}

impl Group {
    /// What the noise that drives them makes of the navigation errors, on and above the diagonal.
    #[inline(always)]
    fn add_to(&self, q: &mut Nine, f: &Matrix3<f64>, free: &Vector3<f64>) {
        let z = |i: usize, j: usize| self.integrals[(i, j)];
        let mut block = |row: usize, column: usize, m: Matrix3<f64>| {
            let mut view = q.fixed_view_mut::<3, 3>(row, column);
            view += m;
        };
        match self.instrument {
            Some(Instrument::Gyro) => {
                // phi = -z1 along, dv = -z2 f × along, dr = -z3 f × along
                let fs = f * self.spread;
                let fsf = fs * f.transpose();
                block(6, 6, self.spread * z(2, 2));
                block(3, 6, fs * z(1, 2));
                block(0, 6, fs * z(0, 2));
                block(3, 3, fsf * z(1, 1));
                block(0, 3, fsf * z(0, 1));
                block(0, 0, fsf * z(0, 0));
            }
            Some(Instrument::Accel) => {
                // dv = z1 along, dr = z2 along
                let s = self.spread.component_mul(&(free * free.transpose()));
                block(3, 3, s * z(2, 2));
                block(0, 3, s * z(1, 2));
                block(0, 0, s * z(1, 1));
            }
            None => {}
        }
    }
}

/// Densities that drive three of the navigation errors directly.
fn diagonal<const N: usize>(model: &Model<N>, first: usize) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from_column_slice(&model.nav_noise[first..first + 3]))
}
