//! Transition and process noise of an interval from what was gathered over it.

use fearless_simd::{Simd, SimdBase, SimdFrom, dispatch, f64x4};
use nalgebra::{Matrix3, Vector3};
use schuler_imu::Instrument;

use super::body::Evenly;
use super::gather::{load, store};
use super::padded::{Columns3, Padded};
use super::slow::Slow;
use super::waiting::STEPS;
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
            self.couplings(simd, model, &slow, out);
            self.noise(simd, model, out);
        });
    }

    /// Zero where the channel down is held and nothing drives it, else one.
    #[inline(always)]
    pub(super) fn down(&self) -> f64 {
        if self.dynamics.vertical == Vertical::Held { 0.0 } else { 1.0 }
    }

    /// Phi_ns = E F_ns, with one S as in `transition`: ∫ v dt is r, and of r two thirds; a tilt that the rates of S make of one
    /// acts upon velocity for a third of the interval.
    #[inline(always)]
    fn couplings<S: Simd>(&self, simd: S, model: &Model<N>, x: &Slow, out: &mut Propagation<N>) {
        let (nav, t) = (model.nav_len(), self.t);
        let sources = model.len() - nav;
        let free = [1.0, 1.0, self.down()];
        let evenly = if self.followed { None } else { Some(self.body.evenly(simd, t)) };
        let mut first = 0;
        while first < sources {
            let [mut r, mut v, p] = match &evenly {
                Some(evenly) => self.of_body(simd, evenly, first),
                None => [
                    three::<S, N>(simd, &self.columns.dr, first),
                    three::<S, N>(simd, &self.columns.dv, first),
                    three::<S, N>(simd, &self.columns.phi, first),
                ],
            };
            (r[2], v[2]) = (r[2] * free[2], v[2] * free[2]);
            let (mut of_v, mut of_r) = (r, r);
            for i in 0..3 {
                (of_v[i], of_r[i]) = (r[i] * (2.0 / t), r[i] * (2.0 / 3.0));
            }
            let mut moved = [[0.0; STEPS]; 9];
            let turned = [times::<S>(&x.pp, &p, 0), times::<S>(&x.pp, &p, 1), times::<S>(&x.pp, &p, 2)];
            let force = self.body.gained();
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let tilted = (turned[k] * force[j] - turned[j] * force[k]) * (free[i] / 3.0);
                let late = times::<S>(&x.vv, &v, i) * (free[i] * t / 3.0);
                let position = r[i] + times::<S>(&x.rr, &of_r, i) + late;
                let velocity = v[i] + times::<S>(&x.vr, &of_r, i) + times::<S>(&x.vv, &of_v, i) + tilted;
                let attitude = p[i] + times::<S>(&x.pr, &of_r, i) + times::<S>(&x.pv, &of_v, i) + turned[i];
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

    /// Position, velocity and attitude error that source states make which go `a + b t` over the interval.
    #[inline(always)]
    fn of_body<S: Simd>(&self, simd: S, evenly: &Evenly, first: usize) -> [[S::f64s; 3]; 3] {
        let (body, [a, b]) = (&self.body, &self.over);
        let (a, b) = (load::<S>(simd, &a[first..]), load::<S>(simd, &b[first..]));
        let gyro = load::<S>(simd, &self.columns.gyro[first..]);
        let e = three::<S, N>(simd, &self.enters, first);
        let (mut even, mut rising) = (e, e);
        for i in 0..3 {
            (even[i], rising[i]) = (e[i] * a, e[i] * b);
        }
        let mut out = [e; 3];
        for i in 0..3 {
            let turned = dot::<S>(&body.turned[i], &even, &evenly.turned[i], &rising);
            let turning = dot::<S>(&body.turning[i], &even, &evenly.turning[i], &rising);
            let tilted = dot::<S>(&body.tilted[i], &even, &evenly.tilted[i], &rising);
            let tilting = dot::<S>(&body.tilting[i], &even, &evenly.tilting[i], &rising);
            // A gyro turns the attitude back.
            out[0][i] = turning - (turning + tilting) * gyro;
            out[1][i] = turned - (turned + tilted) * gyro;
            out[2][i] = -(turned * gyro);
        }
        out
    }

    /// Noise through the fast part, the force being constant.
    #[inline(always)]
    fn noise<S: Simd>(&self, simd: S, model: &Model<N>, out: &mut Propagation<N>) {
        let nav = model.nav_len();
        let force = self.body.gained() / self.t;
        let fast = Fast::new(simd, force, self.down());
        let mut q = self.white_noise(simd, model, &fast);
        let along = self.noise_of_sources(simd, model, out);
        for run in self.runs.iter().map_while(Option::as_ref) {
            let mut spread = Padded::zero(simd);
            for s in (run.first..run.end).step_by(run.len) {
                spread.add_square(f64x4::simd_from(simd, [along[0][s], along[1][s], along[2][s], 0.0]));
            }
            self.spread_noise(&mut q, &fast, run.instrument, run.number, spread);
        }
        // Of a column on or above the diagonal, as it is the same as a row on or below.
        let mut rows = [[0.0; 12]; 9];
        q.rr.store(&mut rows[..3], 0);
        q.rv.store(&mut rows[3..6], 0);
        q.vv.store(&mut rows[3..6], 3);
        q.rp.store(&mut rows[6..], 0);
        q.vp.store(&mut rows[6..], 3);
        q.pp.store(&mut rows[6..], 6);
        for i in 1..9 {
            for j in 0..i {
                rows[j][i] = rows[i][j];
            }
        }
        if nav == 9 {
            for (out, row) in out.q_n.iter_mut().zip(&rows) {
                out[..9].copy_from_slice(&row[..9]);
            }
        } else {
            for (out, &i) in out.q_n.iter_mut().zip(model.full()) {
                for (out, &j) in out.iter_mut().zip(model.full()) {
                    *out = rows[i][j];
                }
            }
        }
    }

    /// Directions in t in which the coefficients of the source states enter, and their covariance with the navigation errors:
    /// the integrals z3, z2, z1 of a coefficient enter position, velocity and attitude. What came in the interval from noise is
    /// the larger the later: by it the directions are weighed where one integral lies between (C and f of time u by u), while
    /// two integrals bring their mean back to the middle.
    #[inline(always)]
    fn noise_of_sources<S: Simd>(
        &self,
        simd: S,
        model: &Model<N>,
        out: &mut Propagation<N>,
    ) -> [[f64; N]; 3] {
        let (t, nav) = (self.t, model.nav_len());
        let sources = model.len() - nav;
        let free = [1.0, 1.0, self.down()];
        let (per_t, per_square) = (1.0 / t, 2.0 / (t * t));
        let (mut along, mut late) = ([[0.0; N]; 3], [[0.0; N]; 3]);
        let lanes = S::f64s::LEN;
        for first in (0..sources).step_by(lanes) {
            let enters = three::<S, N>(simd, &self.enters, first);
            for i in 0..3 {
                let (mean, moment) = (&self.body.turned[i], &self.body.turning[i]);
                let d = enters[0] * mean[0] + enters[1] * mean[1] + enters[2] * mean[2];
                let m = enters[0] * moment[0] + enters[1] * moment[1] + enters[2] * moment[2];
                store::<S>(d * per_t, &mut along[i][first..]);
                store::<S>((d * t - m) * per_square, &mut late[i][first..]);
            }
        }
        if self.special {
            for (number, block) in model.blocks().enumerate().filter(|(_, b)| b.column.is_none()) {
                for s in block.states() {
                    for i in 0..3 {
                        along[i][s - nav] = self.way[number][i] * per_t;
                        late[i][s - nav] = self.way_by_time[number][i] * per_square;
                    }
                }
            }
        }
        // Three quarters of the way: from its mean and the mean of its integral.
        let force = self.body.gained() * (2.5 * per_t) - self.body.moved() * (1.5 * per_square);
        for first in (0..sources).step_by(lanes) {
            let (d, z) =
                (three::<S, N>(simd, &along, first), three::<S, N>(simd, &self.with_integrals, first));
            let late = three::<S, N>(simd, &late, first);
            let gyro = load::<S>(simd, &self.columns.gyro[first..]);
            let mut made = [[0.0; STEPS]; 9];
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                // -f × along of a gyro, along of an accelerometer.
                let turned = d[j] * force[k] - d[k] * force[j];
                let two = (d[i] + (turned - d[i]) * gyro) * free[i];
                let one = (late[i] + (turned - late[i]) * gyro) * free[i];
                store::<S>(two * z[0], &mut made[i]);
                store::<S>(one * z[1], &mut made[3 + i]);
                store::<S>(-(late[i] * gyro) * z[2], &mut made[6 + i]);
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

/// a v + b w of two rows, for as many v and w as there are lanes.
#[inline(always)]
fn dot<S: Simd>(a: &[f64; 4], v: &[S::f64s; 3], b: &[f64; 4], w: &[S::f64s; 3]) -> S::f64s {
    (v[0] * a[0] + w[0] * b[0]) + (v[1] * a[1] + w[1] * b[1]) + (v[2] * a[2] + w[2] * b[2])
}

/// Row `i` of a v, for as many v as there are lanes.
#[inline(always)]
fn times<S: Simd>(a: &Columns3, v: &[S::f64s; 3], i: usize) -> S::f64s {
    v[0] * a[0][i] + v[1] * a[1][i] + v[2] * a[2][i]
}
