//! Transition and process noise of an interval from what was gathered over it.

use fearless_simd::{Simd, SimdBase, SimdFrom, dispatch, f64x4, f64x8};
use nalgebra::{Matrix3, Vector3};
use schuler_imu::Instrument;

use super::body::Rows;
use super::gather::{LANES, load, store};
use super::padded::{Columns3, Padded};
use super::slow::Slow;
use super::waiting::store_rows;
use super::{Accumulator, Model, Propagation};
use crate::Vertical;

impl<const N: usize> Accumulator<N> {
    pub(super) fn finish(&self, model: &Model<N>, out: &mut Propagation<N>) {
        let t = self.t;
        out.dt = t;
        out.sources = self.sources.clone();
        let force = self.body.gained() / t;
        let slow = self.slow(model, force);
        let level = self.level;
        dispatch!(level, simd => {
            self.transition(simd, model, &slow, out);
            let along = self.sources(simd, model, &slow, out);
            self.noise(simd, model, &along, out);
        });
    }

    /// Zero where the channel down is held and nothing drives it, else one.
    #[inline(always)]
    pub(super) fn down(&self) -> f64 {
        if self.dynamics.vertical == Vertical::Held { 0.0 } else { 1.0 }
    }

    /// What source states do: their columns of Phi and Q, and the directions in t in which their coefficients enter.
    #[inline(always)]
    fn sources<S: Simd>(
        &self,
        simd: S,
        model: &Model<N>,
        x: &Slow,
        out: &mut Propagation<N>,
    ) -> [[f64; 4]; N] {
        let (nav, sources) = (model.nav_len(), model.len() - model.nav_len());
        let mut along = [[0.0; 4]; N];
        let mut first = 0;
        while first < sources {
            let end = (first + LANES).min(sources);
            let of_body = self.of_body(simd, first);
            let made = self.couplings(simd, x, &of_body, first);
            let mut rows = [[[0.0; 4]; LANES]; 3];
            let zero = f64x8::splat(simd, 0.0);
            store_rows([made[0], made[1], made[2], made[3]], &mut rows[0]);
            store_rows([made[4], made[5], made[6], made[7]], &mut rows[1]);
            store_rows([made[8], zero, zero, zero], &mut rows[2]);
            for (lane, column) in out.phi_n[nav + first..nav + end].iter_mut().enumerate() {
                let lane = lane % LANES;
                if nav == 9 {
                    for (column, rows) in column.chunks_exact_mut(4).zip(&rows) {
                        column.copy_from_slice(&rows[lane]);
                    }
                } else {
                    for (column, &full) in column.iter_mut().zip(model.full()) {
                        *column = rows[full / 4][lane][full % 4];
                    }
                }
            }
            let (directions, made) = self.noise_of_sources(simd, &of_body, first);
            let [dx, dy, dz] = directions;
            store_rows([dx, dy, dz, zero], &mut rows[0]);
            along[first..end].copy_from_slice(&rows[0][..end - first]);
            for (i, row) in out.q_n[..nav].iter_mut().enumerate() {
                let from = if nav == 9 { made[i] } else { made[model.full()[i]] };
                store(from, &mut row[nav + first..]);
            }
            first = end;
        }
        along
    }

    /// Integrals of what the body does, along the directions of source states.
    #[inline(always)]
    fn of_body<S: Simd>(&self, simd: S, first: usize) -> OfBody<S> {
        let e = three::<S, N>(simd, &self.enters, first);
        let body = &self.body;
        OfBody {
            turned: times_rows(&body.turned, &e),
            turning: times_rows(&body.turning, &e),
            tilted: times_rows(&body.tilted, &e),
            tilting: times_rows(&body.tilting, &e),
        }
    }

    /// Position, velocity and attitude error that source states make which go `a + b t` over the interval: with C and f changing
    /// evenly, ∫ t C = T ∫C - ∫∫C exactly, and of ∫ f × (∫ u C du) the most is half of ∫ f × t (∫C).
    #[inline(always)]
    fn evenly<S: Simd>(&self, simd: S, of: &OfBody<S>, first: usize) -> [[f64x8<S>; 3]; 3] {
        let (t, gained) = (self.t, self.body.gained());
        let (a, b) = (load(simd, &self.over[0][first..]), load(simd, &self.over[1][first..]));
        let gyro = load(simd, &self.columns.gyro[first..]);
        let (at_end, later) = (a + b * t, b * (t * t / 6.0));
        let (half, quarter, most) = (b * 0.5, b * 0.25, a + b * (0.5 * t));
        let tilting = a + b * (0.25 * t);
        let mut bent = of.turned;
        for i in 0..3 {
            bent[i] = of.turned[i] * (0.5 * t) - of.turning[i];
        }
        let mut out = [bent; 3];
        for i in 0..3 {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            let turned = of.turned[i] * at_end - of.turning[i] * b;
            let turning = of.turning[i] * a + of.turned[i] * later;
            let crossed = bent[l] * gained[j] - bent[j] * gained[l];
            let tilted = of.tilted[i] * most - of.tilting[i] * half + crossed * quarter;
            // A gyro turns the attitude back.
            out[0][i] = turning - (turning + of.tilting[i] * tilting) * gyro;
            out[1][i] = turned - (turned + tilted) * gyro;
            out[2][i] = -(turned * gyro);
        }
        out
    }

    /// Phi_ns = E F_ns, with one S as in `transition`: ∫ v dt is r, and of r two thirds; a tilt that the rates of S make of one
    /// acts upon velocity for a third of the interval.
    #[inline(always)]
    fn couplings<S: Simd>(&self, simd: S, x: &Slow, of: &OfBody<S>, first: usize) -> [f64x8<S>; 9] {
        let (t, force) = (self.t, self.body.gained());
        let free = [1.0, 1.0, self.down()];
        let [mut r, mut v, p] = if self.followed {
            [
                three::<S, N>(simd, &self.columns.dr, first),
                three::<S, N>(simd, &self.columns.dv, first),
                three::<S, N>(simd, &self.columns.phi, first),
            ]
        } else {
            self.evenly(simd, of, first)
        };
        (r[2], v[2]) = (r[2] * free[2], v[2] * free[2]);
        let (mut of_v, mut of_r) = (r, r);
        for i in 0..3 {
            (of_v[i], of_r[i]) = (r[i] * (2.0 / t), r[i] * (2.0 / 3.0));
        }
        let turned = [times(&x.pp, &p, 0), times(&x.pp, &p, 1), times(&x.pp, &p, 2)];
        let mut made = [p[0]; 9];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let tilted = (turned[k] * force[j] - turned[j] * force[k]) * (free[i] / 3.0);
            let late = times(&x.vv, &v, i) * (free[i] * t / 3.0);
            made[i] = r[i] + times(&x.rr, &of_r, i) + late;
            made[3 + i] = v[i] + times(&x.vr, &of_r, i) + times(&x.vv, &of_v, i) + tilted;
            made[6 + i] = p[i] + times(&x.pr, &of_r, i) + times(&x.pv, &of_v, i) + turned[i];
        }
        made
    }

    /// Directions in t in which the coefficients of the source states enter, and their covariance with the navigation errors:
    /// the integrals z3, z2, z1 of a coefficient enter position, velocity and attitude. What came in the interval from noise is
    /// the larger the later: by it the directions are weighed where one integral lies between (C and f of time u by u), while
    /// two integrals bring their mean back to the middle.
    #[inline(always)]
    fn noise_of_sources<S: Simd>(
        &self,
        simd: S,
        of: &OfBody<S>,
        first: usize,
    ) -> ([f64x8<S>; 3], [f64x8<S>; 9]) {
        let t = self.t;
        let free = [1.0, 1.0, self.down()];
        let (per_t, per_square) = (1.0 / t, 2.0 / (t * t));
        let (mut d, mut late) = (of.turned, of.turning);
        for i in 0..3 {
            d[i] = of.turned[i] * per_t;
            late[i] = (of.turned[i] * t - of.turning[i]) * per_square;
        }
        if self.special {
            let (way, by_time) =
                (three::<S, N>(simd, &self.way, first), three::<S, N>(simd, &self.way_by_time, first));
            for i in 0..3 {
                d[i] += way[i] * per_t;
                late[i] += by_time[i] * per_square;
            }
        }
        // Three quarters of the way: from its mean and the mean of its integral.
        let force = self.body.gained() * (2.5 * per_t) - self.body.moved() * (1.5 * per_square);
        let z = three::<S, N>(simd, &self.with_integrals, first);
        let gyro = load(simd, &self.columns.gyro[first..]);
        let mut made = [gyro; 9];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            // -f × along of a gyro, along of an accelerometer.
            let turned = d[j] * force[k] - d[k] * force[j];
            let two = (d[i] + (turned - d[i]) * gyro) * free[i];
            let one = (late[i] + (turned - late[i]) * gyro) * free[i];
            made[i] = two * z[0];
            made[3 + i] = one * z[1];
            made[6 + i] = -(late[i] * gyro) * z[2];
        }
        (d, made)
    }

    /// Noise through the fast part, the force being constant.
    #[inline(always)]
    fn noise<S: Simd>(&self, simd: S, model: &Model<N>, along: &[[f64; 4]; N], out: &mut Propagation<N>) {
        let nav = model.nav_len();
        let force = self.body.gained() / self.t;
        let fast = Fast::new(simd, force, self.down());
        let mut q = self.white_noise(simd, model, &fast);
        for run in self.runs.iter().map_while(Option::as_ref) {
            let mut spread = Padded::zero(simd);
            for s in (run.first..run.end).step_by(run.len) {
                spread.add_square(f64x4::simd_from(simd, along[s]));
            }
            self.spread_noise(&mut q, &fast, run.instrument, run.number, spread);
        }
        if nav == 9 {
            q.store(&mut out.q_n);
        } else {
            let mut rows = [[0.0; 9]; 9];
            q.store(&mut rows);
            for (out, &i) in out.q_n.iter_mut().zip(model.full()) {
                for (out, &j) in out.iter_mut().zip(model.full()) {
                    *out = rows[i][j];
                }
            }
        }
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
        let (gained, moved) = (self.body.gained(), self.body.moved());
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

impl<S: Simd> Noise<S> {
    /// Writes the first nine columns of `rows`: a column of a block is a row of the one that mirrors it.
    #[inline(always)]
    fn store<const W: usize>(&self, rows: &mut [[f64; W]; 9]) {
        let (rv, rp, vp) = (self.rv.transposed(), self.rp.transposed(), self.vp.transposed());
        for (k, [a, b, c]) in
            [[&self.rr, &rv, &rp], [&self.rv, &self.vv, &vp], [&self.rp, &self.vp, &self.pp]]
                .iter()
                .enumerate()
        {
            for i in 0..3 {
                let row = &mut rows[3 * k + i];
                a.columns()[i].store_slice(&mut row[0..4]);
                b.columns()[i].store_slice(&mut row[3..7]);
                row[6..9].copy_from_slice(&c.columns()[i].as_array()[..3]);
            }
        }
    }
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

/// What a [`Body`](super::body::Body) has gathered, along the directions of as many source states as there are lanes.
struct OfBody<S: Simd> {
    turned: [f64x8<S>; 3],
    turning: [f64x8<S>; 3],
    tilted: [f64x8<S>; 3],
    tilting: [f64x8<S>; 3],
}

/// Three rows of source states from the state `first` on.
#[inline(always)]
fn three<S: Simd, const N: usize>(simd: S, rows: &[[f64; N]; 3], first: usize) -> [f64x8<S>; 3] {
    let [x, y, z] = rows;
    [load(simd, &x[first..]), load(simd, &y[first..]), load(simd, &z[first..])]
}

/// Row `i` of a v, for as many v as there are lanes.
#[inline(always)]
fn times<S: Simd>(a: &Columns3, v: &[f64x8<S>; 3], i: usize) -> f64x8<S> {
    v[0] * a[0][i] + v[1] * a[1][i] + v[2] * a[2][i]
}

/// The same with a by rows, all three.
#[inline(always)]
fn times_rows<S: Simd>([x, y, z]: &Rows, v: &[f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [
        v[0] * x[0] + v[1] * x[1] + v[2] * x[2],
        v[0] * y[0] + v[1] * y[1] + v[2] * y[2],
        v[0] * z[0] + v[1] * z[1] + v[2] * z[2],
    ]
}
