//! Transition and process noise of an interval from what was gathered over it.

use fearless_simd::{Simd, SimdBase, SimdFrom, dispatch, f64x4};
use nalgebra::{Matrix3, Vector3};
use schuler_frames::{B, Geodetic, T, Vec3};
use schuler_imu::Instrument;

use super::gather::{STEPS, load, store};
use super::padded::{Columns3, Padded};
use super::{Accumulator, Model, Propagation};
use crate::{Pva, Vertical};

/// The slow dynamics over half an interval, by blocks; those that are not there are zero.
struct Slow {
    rr: Columns3,
    vr: Columns3,
    vv: Columns3,
    pr: Columns3,
    pv: Columns3,
    pp: Columns3,
}

impl<const N: usize> Accumulator<N> {
    pub(super) fn finish(&self, model: &Model<N>, out: &mut Propagation<N>) {
        let t = self.t;
        out.dt = t;
        let force = Vector3::from(self.sums.gained) / t;
        let slow = self.slow(model, force);
        let level = self.level;
        dispatch!(level, simd => {
            self.transition(simd, model, &slow, out);
            self.couplings(simd, model, &slow, out);
            self.noise(simd, model, force, out);
        });
    }

    /// Zero where the channel down is held and nothing drives it, else one.
    #[inline(always)]
    fn down(&self) -> f64 {
        if self.dynamics.vertical == Vertical::Held { 0.0 } else { 1.0 }
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
        for (axis, free) in [1.0, 1.0, self.down()].into_iter().enumerate() {
            s[(axis, 3 + axis)] -= free;
        }
        if model.nav_len() < 9 {
            for k in (0..9).filter(|k| !model.full().contains(k)) {
                s.row_mut(k).fill(0.0);
                s.column_mut(k).fill(0.0);
            }
        }
        let half = 0.5 * self.t;
        let block = |row: usize, column: usize| {
            core::array::from_fn(|j| {
                let x = &s.data.0[column + j];
                [x[row] * half, x[row + 1] * half, x[row + 2] * half, 0.0]
            })
        };
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
    fn transition<S: Simd>(&self, simd: S, model: &Model<N>, slow: &Slow, out: &mut Propagation<N>) {
        let (t, down) = (self.t, self.down());
        let (gained, moved) = (Vector3::from(self.sums.gained), Vector3::from(self.sums.moved));
        let free = f64x4::simd_from(simd, [1.0, 1.0, down, 0.0]);
        let j = Padded::cross(simd, moved).rows(free);
        let m = Padded::cross(simd, gained).rows(free);
        let before = j * (2.0 / t);
        let after = Padded::cross(simd, gained * t - moved).rows(free) * (2.0 / t);
        let k = j * (2.0 / 3.0);
        let (rr, vr) = (Padded::new(simd, &slow.rr), Padded::new(simd, &slow.vr));
        let (vv, pr) = (Padded::new(simd, &slow.vv), Padded::new(simd, &slow.pr));
        let (pv, pp) = (Padded::new(simd, &slow.pv), Padded::new(simd, &slow.pp));
        // T where position moves with velocity, from the left and from the right.
        let to = free * t;
        let from = [t, t, t * down];
        let tv_vr = vr.rows(to);
        let round = pv * m * (1.0 / 3.0);
        let id = Padded::diagonal(simd, [1.0; 3]);
        let by_r = [
            id + (rr + rr * rr) * 2.0 + tv_vr + k * pr,
            (vr + vr * rr + vv * vr) * 2.0 + after * pr + vr * tv_vr * (2.0 / 3.0),
            pr * 2.0,
        ];
        let by_v = [
            Padded::diagonal(simd, from)
                + rr.scaled(from)
                + vv.rows(to)
                + k * pv
                + tv_vr.scaled(from) * (1.0 / 3.0),
            id + (vv + vv * vv) * 2.0 + vr.scaled(from) + after * pv,
            pv * 2.0 + pr.scaled(from) + round * pv * 2.0,
        ];
        let by_p = [
            j + rr * k + k * pp + (vv * m).rows(to) * (1.0 / 3.0),
            m + vr * k + vv * before + after * pp + m * round,
            id + (pp + pp * pp) * 2.0 + pr * k + pv * before,
        ];
        if model.nav_len() == 9 {
            for (three, blocks) in out.phi_n[..9].chunks_exact_mut(3).zip([by_r, by_v, by_p]) {
                for (j, column) in three.iter_mut().enumerate() {
                    for (i, block) in blocks.iter().enumerate() {
                        // The fourth lane is overwritten by the next block.
                        block.columns()[j].store_slice(&mut column[3 * i..3 * i + 4]);
                    }
                }
            }
        } else {
            let blocks = [by_r, by_v, by_p];
            for (column, &full_j) in model.full().iter().enumerate() {
                for (i, &full_i) in model.full().iter().enumerate() {
                    out.phi_n[column][i] = blocks[full_j / 3][full_i / 3].columns()[full_j % 3][full_i % 3];
                }
            }
        }
    }

    /// Phi_ns = E F_ns, with one S as in `transition`: ∫ v dt is r, and of r two thirds.
    #[inline(always)]
    fn couplings<S: Simd>(&self, simd: S, model: &Model<N>, x: &Slow, out: &mut Propagation<N>) {
        let (nav, t) = (model.nav_len(), self.t);
        let sources = model.len() - nav;
        let free = [1.0, 1.0, self.down()];
        let mut first = 0;
        while first < sources {
            let (mut r, mut v) =
                (three::<S, N>(simd, &self.columns.dr, first), three::<S, N>(simd, &self.columns.dv, first));
            let p = three::<S, N>(simd, &self.columns.phi, first);
            (r[2], v[2]) = (r[2] * free[2], v[2] * free[2]);
            let (mut of_v, mut of_r) = (r, r);
            for i in 0..3 {
                (of_v[i], of_r[i]) = (r[i] * (2.0 / t), r[i] * (2.0 / 3.0));
            }
            let mut moved = [[0.0; STEPS]; 9];
            for i in 0..3 {
                let late = times::<S>(&x.vv, &v, i) * (free[i] * t / 3.0);
                let position = r[i] + times::<S>(&x.rr, &of_r, i) + late;
                let velocity = v[i] + times::<S>(&x.vr, &of_r, i) + times::<S>(&x.vv, &of_v, i);
                let attitude = p[i]
                    + times::<S>(&x.pr, &of_r, i)
                    + times::<S>(&x.pv, &of_v, i)
                    + times::<S>(&x.pp, &p, i);
                store::<S>(position, &mut moved[i]);
                store::<S>(velocity, &mut moved[3 + i]);
                store::<S>(attitude, &mut moved[6 + i]);
            }
            let end = (first + S::f64s::LEN).min(sources);
            for (lane, column) in out.phi_n[nav + first..nav + end].iter_mut().enumerate() {
                if nav == 9 {
                    for i in 0..9 {
                        column[i] = moved[i][lane % STEPS];
                    }
                } else {
                    for (i, &full) in model.full().iter().enumerate() {
                        column[i] = moved[full][lane];
                    }
                }
            }
            first = end;
        }
    }

    /// Noise through the fast part, the force being constant.
    #[inline(always)]
    fn noise<S: Simd>(&self, simd: S, model: &Model<N>, force: Vector3<f64>, out: &mut Propagation<N>) {
        let nav = model.nav_len();
        let fast = Fast::new(simd, force, self.down());
        let mut q = self.white_noise(simd, model, &fast);
        let along = self.noise_of_sources(simd, model, force, out);
        let mut group = None;
        let mut spread = Padded::zero(simd);
        for (number, block) in model.blocks().enumerate().filter(|(_, b)| b.len > 0) {
            let Some(step) = &self.of_interval[number] else { continue };
            for (k, s) in block.states().enumerate() {
                for l in 0..block.len {
                    out.set_source(s, l, step.phi[k][l], step.q[(3 + k, 3 + l)]);
                }
            }
            let (Some(instrument), true) = (block.instrument(), block.is_driven()) else { continue };
            if !self.as_before[number] {
                if let Some((instrument, number)) = group.replace((instrument, number)) {
                    self.spread_noise(&mut q, &fast, instrument, number, spread);
                }
                spread = Padded::zero(simd);
            }
            let s = block.first - nav;
            spread.add_square(f64x4::simd_from(simd, [along[0][s], along[1][s], along[2][s], 0.0]));
        }
        if let Some((instrument, number)) = group {
            self.spread_noise(&mut q, &fast, instrument, number, spread);
        }
        // Of a column on or above the diagonal, as it is the same as a row on or below.
        let mut rows = [[0.0; 12]; 9];
        let of_row = [
            [Some(&q.rr), None, None],
            [Some(&q.rv), Some(&q.vv), None],
            [Some(&q.rp), Some(&q.vp), Some(&q.pp)],
        ];
        for (row, blocks) in rows.chunks_exact_mut(3).zip(of_row) {
            for (j, row) in row.iter_mut().enumerate() {
                for (i, block) in blocks.iter().enumerate() {
                    if let Some(block) = block {
                        block.columns()[j].store_slice(&mut row[3 * i..3 * i + 4]);
                    }
                }
            }
        }
        for i in 0..nav {
            for j in 0..=i {
                let value = if nav == 9 { rows[i][j] } else { rows[model.full()[i]][model.full()[j]] };
                (out.q_n[i][j], out.q_n[j][i]) = (value, value);
            }
        }
    }

    /// Directions in t in which the coefficients of the source states enter, and their covariance with the navigation errors:
    /// the integrals z3, z2, z1 of a coefficient enter position, velocity and attitude.
    #[inline(always)]
    fn noise_of_sources<S: Simd>(
        &self,
        simd: S,
        model: &Model<N>,
        force: Vector3<f64>,
        out: &mut Propagation<N>,
    ) -> [[f64; N]; 3] {
        let (t, nav) = (self.t, model.nav_len());
        let sources = model.len() - nav;
        let free = [1.0, 1.0, self.down()];
        let axes = &self.sums.turned;
        let mut along = [[0.0; N]; 3];
        let lanes = S::f64s::LEN;
        for first in (0..sources).step_by(lanes) {
            let enters = three::<S, N>(simd, &self.enters, first);
            for i in 0..3 {
                let d = enters[0] * axes[i][0] + enters[1] * axes[i][1] + enters[2] * axes[i][2];
                store::<S>(d * (1.0 / t), &mut along[i][first..]);
            }
        }
        if self.special {
            for (number, block) in model.blocks().enumerate().filter(|(_, b)| b.column.is_none()) {
                for s in block.states() {
                    for i in 0..3 {
                        along[i][s - nav] = self.way[number][i] / t;
                    }
                }
            }
        }
        for first in (0..sources).step_by(lanes) {
            let (d, z) =
                (three::<S, N>(simd, &along, first), three::<S, N>(simd, &self.with_integrals, first));
            let gyro = load::<S>(simd, &self.columns.gyro[first..]);
            let mut made = [[0.0; STEPS]; 9];
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                // -f × along of a gyro, along of an accelerometer.
                let turned = d[j] * force[k] - d[k] * force[j];
                let reach = (d[i] + (turned - d[i]) * gyro) * free[i];
                store::<S>(reach * z[0], &mut made[i]);
                store::<S>(reach * z[1], &mut made[3 + i]);
                store::<S>(-(d[i] * gyro) * z[2], &mut made[6 + i]);
            }
            let end = (first + lanes).min(sources);
            for (i, row) in out.q_n[..nav].iter_mut().enumerate() {
                let from = if nav == 9 { &made[i] } else { &made[model.full()[i]] };
                for (out, made) in row[nav + first..nav + end].iter_mut().zip(from) {
                    *out = *made;
                }
            }
        }
        along
    }

    /// That of white noise: with G, A, R the densities that drive attitude, velocity and position, and F = [f ×],
    ///
    /// ```text
    /// Q_pp = G T,  Q_vp = F G T²/2,  Q_rp = F G T³/6,  Q_vv = A T + F G F' T³/3,
    /// Q_rv = A T²/2 + F G F' T⁴/8,   Q_rr = R T + A T³/3 + F G F' T⁵/20
    /// ```
    ///
    /// (in Q_vp the first moment of the force is taken as it was).
    #[inline(always)]
    fn white_noise<S: Simd>(&self, simd: S, model: &Model<N>, fast: &Fast<S>) -> Noise<S> {
        let t = self.t;
        let down = self.down();
        let mut densities = [Padded::zero(simd); 3];
        for (k, density) in densities.iter_mut().enumerate() {
            // Of position, velocity and attitude, by itself and by a sensor.
            let first = 3 * k;
            let own = &model.nav_noise;
            *density = Padded::diagonal(simd, [own[first], own[first + 1], own[first + 2]]);
            let held = if k == 1 { down } else { 1.0 };
            if k > 0 {
                *density = *density
                    + match self.isotropic[2 - k] {
                        Some(density) => Padded::diagonal(simd, [density, density, density * held]),
                        None => padded(simd, &(self.white[2 - k] / t))
                            .scaled([1.0, 1.0, held])
                            .rows(f64x4::simd_from(simd, [1.0, 1.0, held, 0.0])),
                    };
            }
            if model.nav_len() < 9 {
                let mut mask = [0.0; 4];
                for &full in model.full().iter().filter(|&full| full / 3 == k) {
                    mask[full % 3] = 1.0;
                }
                *density = density.scaled([mask[0], mask[1], mask[2]]).rows(f64x4::simd_from(simd, mask));
            }
        }
        let [r, a, g] = densities;
        let (gained, moved) = (Vector3::from(self.sums.gained), Vector3::from(self.sums.moved));
        let moment = Padded::cross(simd, gained * t - moved).rows(fast.free);
        let fg = fast.f * g;
        let fgf = fg * fast.f_transposed;
        let (t2, t3) = (t * t, t * t * t);
        Noise {
            pp: g * t,
            vp: moment * g,
            rp: fg * (t3 / 6.0),
            vv: a * t + fgf * (t3 / 3.0),
            rv: a * (t2 / 2.0) + fgf * (t2 * t2 / 8.0),
            rr: r * t + a * (t3 / 3.0) + fgf * (t3 * t2 / 20.0),
        }
    }

    /// Adds what the noise makes that drives blocks of the same behaviour as the one of that `number`, on axes of one
    /// instrument: `spread` is the sum of the squares of their directions.
    #[inline(always)]
    fn spread_noise<S: Simd>(
        &self,
        q: &mut Noise<S>,
        fast: &Fast<S>,
        instrument: Instrument,
        number: usize,
        spread: Padded<S>,
    ) {
        let Some(step) = &self.of_interval[number] else { return };
        let z = &step.q;
        match instrument {
            Instrument::Gyro => {
                // phi = -z1 along, dv = -z2 f × along, dr = -z3 f × along
                let fs = fast.f * spread;
                let fsf = fs * fast.f_transposed;
                q.pp = q.pp + spread * z[(2, 2)];
                q.vp = q.vp + fs * z[(1, 2)];
                q.rp = q.rp + fs * z[(0, 2)];
                q.vv = q.vv + fsf * z[(1, 1)];
                q.rv = q.rv + fsf * z[(0, 1)];
                q.rr = q.rr + fsf * z[(0, 0)];
            }
            Instrument::Accel => {
                // dv = z1 along, dr = z2 along
                let s = spread.rows(fast.free).scaled([1.0, 1.0, self.down()]);
                q.vv = q.vv + s * z[(2, 2)];
                q.rv = q.rv + s * z[(1, 2)];
                q.rr = q.rr + s * z[(1, 1)];
            }
        }
    }
}

/// F = [f ×], and which rows are driven.
struct Fast<S: Simd> {
    free: f64x4<S>,
    f: Padded<S>,
    f_transposed: Padded<S>,
}

impl<S: Simd> Fast<S> {
    #[inline(always)]
    fn new(simd: S, force: Vector3<f64>, down: f64) -> Self {
        let free = f64x4::simd_from(simd, [1.0, 1.0, down, 0.0]);
        Fast {
            free,
            f: Padded::cross(simd, force).rows(free),
            f_transposed: Padded::cross(simd, -force).scaled([1.0, 1.0, down]),
        }
    }
}

/// Blocks of the covariance of the navigation errors, on and above the diagonal.
struct Noise<S: Simd> {
    rr: Padded<S>,
    rv: Padded<S>,
    rp: Padded<S>,
    vv: Padded<S>,
    vp: Padded<S>,
    pp: Padded<S>,
}

#[inline(always)]
fn padded<S: Simd>(simd: S, m: &Matrix3<f64>) -> Padded<S> {
    let mut columns = [[0.0; 4]; 3];
    for j in 0..3 {
        for i in 0..3 {
            columns[j][i] = m[(i, j)];
        }
    }
    Padded::new(simd, &columns)
}

/// Three rows of source states from the state `first` on.
#[inline(always)]
fn three<S: Simd, const N: usize>(simd: S, rows: &[[f64; N]; 3], first: usize) -> [S::f64s; 3] {
    let [x, y, z] = rows;
    [load::<S>(simd, &x[first..]), load::<S>(simd, &y[first..]), load::<S>(simd, &z[first..])]
}

/// Row `i` of a v, for as many v as there are lanes.
#[inline(always)]
fn times<S: Simd>(a: &Columns3, v: &[S::f64s; 3], i: usize) -> S::f64s {
    v[0] * a[0][i] + v[1] * a[1][i] + v[2] * a[2][i]
}
