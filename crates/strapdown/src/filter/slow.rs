//! The transition of the navigation errors over an interval: the fast part as it was gathered, the slow part around it.

use fearless_simd::{Simd, SimdBase, SimdFrom, f64x4};
use nalgebra::Vector3;
use schuler_frames::{Geodetic, Rot, Vec3, earth};

use super::padded::{Columns3, Padded};
use super::{Accumulator, Form, Model, Propagation};
use crate::Pva;

/// The slow dynamics over half an interval, by blocks; those that are not there are zero.
pub(super) struct Slow {
    pub rr: Columns3,
    pub vr: Columns3,
    pub vv: Columns3,
    pub pr: Columns3,
    pub pv: Columns3,
    pub pp: Columns3,
    /// Change of the velocity over the interval, and of the transport rate with it.
    gained: Vector3<f64>,
    turned: Vector3<f64>,
}

impl<const N: usize> Accumulator<N> {
    /// Dynamics without the fast part, in the middle of the interval, errors that were left out of the model being zero.
    pub(super) fn slow(&self, model: &Model<N>, force: Vector3<f64>) -> Slow {
        let (a, b) = (&self.start, &self.end);
        // Mean of what the force has made of the velocity, and gravity and the like evenly with it.
        let gained = (b.v_t - a.v_t).as_nalgebra();
        let mut mean = self.body.moved() / self.t + (gained - self.body.gained()) * 0.5;
        mean[2] *= self.down();
        let middle = Pva {
            position: Geodetic::new(
                0.5 * (a.position.lat + b.position.lat),
                b.position.lon,
                0.5 * (a.position.h + b.position.h),
            ),
            v_t: a.v_t + Vec3::new(mean[0], mean[1], mean[2]),
            // Of the attitude nothing but the force in t matters.
            c_tb: Rot::IDENTITY,
        };
        let force = Vec3::new(force[0], force[1], force[2]);
        let mut system = model.form().system(&self.dynamics, &middle, force);
        let s = &mut system.f;
        let rho_by_v = s.fixed_view::<3, 3>(6, 3).into_owned();
        for (axis, free) in [1.0, 1.0, self.down()].into_iter().enumerate() {
            s[(axis, 3 + axis)] -= free;
        }
        if model.nav_len() < 9 {
            for k in (0..9).filter(|k| !model.full().contains(k)) {
                s.row_mut(k).fill(0.0);
                s.column_mut(k).fill(0.0);
            }
        }
        let turned = match model.form() {
            Form::Phi => rho_by_v * gained,
            Form::Psi => earth::omega_et_t(b.v_t - a.v_t, middle.position).as_vec3().as_nalgebra(),
        };
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
            gained,
            turned,
        }
    }

    /// Phi_nn by blocks: the fast part F = [I, T, J; 0, I, M; 0, 0, I], with M, J and K the single, double and triple integral
    /// of [f ×], and around it the slow part S in orders,
    ///
    /// ```text
    /// Phi = F(T, 0) + ∫ F(T, t) S F(t, 0) dt + ∫∫ F(T, t) S F(t, u) S F(u, 0) dt du + …
    /// ```
    ///
    /// The terms with one S are exact where two integrals of the force at most are asked for; of those with three, which the
    /// Schuler loops make, and of all with two S, the force is taken as constant. Every product of two S is there, and with the
    /// fast part once between or beside them: so what is left out has three slow rates, or is of a single interval and does
    /// not add up. X = S T/2, whence the factors.
    ///
    /// S changes with the velocity. Where F stands on one side only, the mean of S over the interval is all that enters; where
    /// r follows v, or the force turns phi into v, what S does early and late differs, and its slope S' makes
    ///
    /// ```text
    /// dr by v: (S_rr' - S_vv') T³/12,   dv by phi: (S_vv' [f ×] - [f ×] S_pp') T³/12
    /// ```
    ///
    /// In a turn of 1.3 g at 250 m/s S' is 2e-6 1/s², the terms 3e-9 and 3e-8 in 0.2 s, and grow as the intervals do; in all
    /// other blocks they come with one more T.
    #[inline(always)]
    pub(super) fn transition<S: Simd>(
        &self,
        simd: S,
        model: &Model<N>,
        slow: &Slow,
        out: &mut Propagation<N>,
    ) {
        let (t, down) = (self.t, self.down());
        let free = f64x4::simd_from(simd, [1.0, 1.0, down, 0.0]);
        let (gained, moved) = (self.body.gained(), self.body.moved());
        // As of a force that changes evenly.
        let third = moved * (0.5 * t) - gained * (t * t / 12.0);
        let m = Padded::cross(simd, gained).rows(free);
        let j = Padded::cross(simd, moved).rows(free);
        let k = Padded::cross(simd, third).rows(free);
        let x = Lower {
            rr: Padded::new(simd, &slow.rr),
            vr: Padded::new(simd, &slow.vr),
            vv: Padded::new(simd, &slow.vv),
            pr: Padded::new(simd, &slow.pr),
            pv: Padded::new(simd, &slow.pv),
            pp: Padded::new(simd, &slow.pp),
        };
        let square = x.times(slow);
        let (rr, vr, vv) = (x.rr.held(down), x.vr.held(down), x.vv.held(down));
        let (pr, pv) = (x.pr.held(down), x.pv.held(down));
        // T where position moves with velocity, from the left and from the right.
        let to = free * t;
        let from = [t, t, t * down];
        let id = Padded::diagonal(simd, [1.0; 3]);
        // Integrals of force after t, twice and once, over all t.
        let after_twice = j * 2.0 + k * (-4.0 / t);
        let after = m * 2.0 + j * (-2.0 / t);
        let (moved_on, third_on) = (moved * (2.0 / t), third * (2.0 / t));
        let sunk = x.vr.rows(to);
        let round = pv.times_cross(gained);
        let loop_ = m * round;
        let turned = vv.times_cross(gained);
        // With D = S_pv, which the psi form has not: S_rr = -[rho ×] - [v ×] D, S_vv = -[rho ×] + [v ×] D, S_pp = -[rho ×],
        // and what does not depend on velocity.
        let bent = (Padded::cross(simd, slow.gained) * x.pv).rows(free);
        let rho = Padded::cross(simd, slow.turned);
        let bent_force = (bent * (2.0 / t) + rho * -1.0).held(down).times_cross(gained).rows(free) + m * rho;
        let by_r = [
            id + (x.rr + square.rr) * 2.0 + sunk + after_twice.times_stored(&slow.pr),
            (x.vr + square.vr) * 2.0
                + after.times_stored(&slow.pr)
                + x.vr.scaled(from).times_stored(&slow.vr) * (2.0 / 3.0),
            (x.pr + square.pr) * 2.0,
        ];
        let twice = square.rr + rr.times_stored(&slow.vv) + square.vv;
        let by_v = [
            Padded::diagonal(simd, from)
                + (x.rr + twice * (2.0 / 3.0)).scaled(from)
                + x.vv.rows(to)
                + sunk.scaled(from) * (1.0 / 3.0)
                + bent * (t * (-1.0 / 3.0))
                + after_twice.times_stored(&slow.pv),
            id + (x.vv + square.vv) * 2.0 + x.vr.scaled(from) + after.times_stored(&slow.pv),
            (x.pv + square.pv) * 2.0 + x.pr.scaled(from) + round.times_stored(&slow.pv) * (2.0 / 3.0),
        ];
        let slow_of_force =
            square.vv.held(down).times_cross(gained) + turned.times_stored(&slow.pp) + m * square.pp;
        let by_p = [
            j + (rr + vv.rows(free)).times_cross(third_on)
                + vr.times_cross(gained).rows(to) * (t * (1.0 / 12.0))
                + after_twice.times_stored(&slow.pp)
                + loop_ * (t * (1.0 / 12.0)),
            m + vr.times_cross(third_on)
                + vv.times_cross(moved_on)
                + after.times_stored(&slow.pp)
                + loop_ * (1.0 / 3.0)
                + bent_force * (t * (1.0 / 12.0))
                + slow_of_force * (2.0 / 3.0),
            id + (x.pp + square.pp) * 2.0 + pr.times_cross(third_on) + pv.times_cross(moved_on),
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
    fn times(&self, b: &Slow) -> Self {
        let a = self;
        Lower {
            rr: a.rr.times_stored(&b.rr),
            vr: a.vr.times_stored(&b.rr) + a.vv.times_stored(&b.vr),
            vv: a.vv.times_stored(&b.vv),
            pr: a.pr.times_stored(&b.rr) + a.pv.times_stored(&b.vr) + a.pp.times_stored(&b.pr),
            pv: a.pv.times_stored(&b.vv) + a.pp.times_stored(&b.pv),
            pp: a.pp.times_stored(&b.pp),
        }
    }
}
