//! The transition of the navigation errors over an interval: the fast part as it was gathered, the slow part around it.

use fearless_simd::{Simd, SimdBase, SimdFrom, f64x4};
use nalgebra::Vector3;
use schuler_frames::{B, Geodetic, T, Vec3};

use super::gather::Sums;
use super::padded::{Columns3, Padded};
use super::{Accumulator, Model, Propagation};
use crate::{Pva, Vertical};

/// The slow dynamics over half an interval, by blocks; those that are not there are zero.
pub(super) struct Slow {
    pub rr: Columns3,
    pub vr: Columns3,
    pub vv: Columns3,
    pub pr: Columns3,
    pub pv: Columns3,
    pub pp: Columns3,
}

impl<const N: usize> Accumulator<N> {
    /// Dynamics without the fast part, in the middle of the interval, errors that were left out of the model being zero.
    pub(super) fn slow(&self, model: &Model<N>, force: Vector3<f64>) -> Slow {
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
    /// M the single integral of [f ×]; and the terms with one S made what they are,
    ///
    /// ```text
    /// ∫ F(T, t) S F(t, 0) dt   instead of   F X + X F
    /// ```
    ///
    /// for which the triple integral K of [f ×] is needed as well (those with S from position to attitude are left as they
    /// are: the change of the Earth's and the transport rate over what moves in T). Of terms with two S, the third term
    /// of the Schuler loops (velocity, level, velocity and position, velocity, position) counts in the long run.
    #[inline(always)]
    pub(super) fn transition<S: Simd>(
        &self,
        simd: S,
        model: &Model<N>,
        slow: &Slow,
        sums: &Sums<f64>,
        out: &mut Propagation<N>,
    ) {
        let (t, down) = (self.t, self.down());
        let free = f64x4::simd_from(simd, [1.0, 1.0, down, 0.0]);
        let Sums { gained, moved, third, .. } = *sums;
        let m = Padded::cross(simd, Vector3::from(gained)).rows(free);
        let j = Padded::cross(simd, Vector3::from(moved)).rows(free);
        let k = Padded::cross(simd, Vector3::from(third)).rows(free);
        let x = Lower {
            rr: Padded::new(simd, &slow.rr),
            vr: Padded::new(simd, &slow.vr),
            vv: Padded::new(simd, &slow.vv),
            pr: Padded::new(simd, &slow.pr),
            pv: Padded::new(simd, &slow.pv),
            pp: Padded::new(simd, &slow.pp),
        };
        // E - 1: to second order, a baro loop's to third.
        let square = x.times(&x);
        let mut d = x.plus(&square, 0.5);
        if matches!(self.dynamics.vertical, Vertical::Damped(_)) {
            d = d.plus(&square.times(&x), 1.0 / 6.0);
        }
        // T where position moves with velocity, from the left and from the right.
        let to = free * t;
        let from = [t, t, t * down];
        let id = Padded::diagonal(simd, [1.0; 3]);
        // F E by rows of blocks.
        let (vv, pp) = (d.vv + id, d.pp + id);
        let by_r = [d.rr + id + d.vr.rows(to) + j * d.pr, d.vr + m * d.pr, d.pr];
        let by_v = [vv.rows(to) + j * d.pv, vv + m * d.pv, d.pv];
        let by_p = [j * pp, m * pp, pp];
        let (mut by_r, mut by_v, mut by_p) = (d.after(by_r), d.after(by_v), d.after(by_p));
        // What the terms with one S lack.
        let late = m + j * (-2.0 / t);
        let twice = j + k * (-4.0 / t);
        let thrice = k * (2.0 / t) + j * -1.0;
        let round = x.pv * m;
        let loop_ = m * round;
        by_r[1] = by_r[1] + x.vr.rows(to) * x.vr * (-1.0 / 3.0);
        by_v[0] = by_v[0] + x.vr.rows(to).scaled(from) * (1.0 / 3.0) + twice * x.pv;
        by_v[1] = by_v[1] + late * x.pv;
        by_v[2] = by_v[2] + round * x.pv * (-1.0 / 3.0);
        by_p[0] = by_p[0]
            + x.rr * thrice
            + (x.vv * k).rows(to) * (2.0 / (t * t))
            + (x.vr * m).rows(to) * (t * (1.0 / 12.0))
            + twice * x.pp
            + loop_ * (t * (1.0 / 12.0));
        by_p[1] = by_p[1] + x.vr * thrice + x.vv * late * -1.0 + late * x.pp + loop_ * (1.0 / 3.0);
        by_p[2] = by_p[2] + x.pv * late * -1.0;
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
}

/// Blocks of the slow dynamics on and below the diagonal, the only ones.
struct Lower<S: Simd> {
    rr: Padded<S>,
    vr: Padded<S>,
    vv: Padded<S>,
    pr: Padded<S>,
    pv: Padded<S>,
    pp: Padded<S>,
}

impl<S: Simd> Lower<S> {
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Lower {
            rr: a.rr * b.rr,
            vr: a.vr * b.rr + a.vv * b.vr,
            vv: a.vv * b.vv,
            pr: a.pr * b.rr + a.pv * b.vr + a.pp * b.pr,
            pv: a.pv * b.vv + a.pp * b.pv,
            pp: a.pp * b.pp,
        }
    }

    #[inline(always)]
    fn plus(&self, other: &Self, factor: f64) -> Self {
        let (a, b) = (self, other);
        Lower {
            rr: a.rr + b.rr * factor,
            vr: a.vr + b.vr * factor,
            vv: a.vv + b.vv * factor,
            pr: a.pr + b.pr * factor,
            pv: a.pv + b.pv * factor,
            pp: a.pp + b.pp * factor,
        }
    }

    /// A column of blocks with this matrix times it added.
    #[inline(always)]
    fn after(&self, [r, v, p]: [Padded<S>; 3]) -> [Padded<S>; 3] {
        [r + self.rr * r, v + self.vr * r + self.vv * v, p + self.pr * r + self.pv * v + self.pp * p]
    }
}
