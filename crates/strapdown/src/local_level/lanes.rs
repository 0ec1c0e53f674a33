//! Eight local-level navigators side by side, in the machine's lanes.

use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch, f64x8};
use schuler_frames::{Gravity, Real, Vec3};
use schuler_imu::random::best_level;

use super::{ANCHOR_AGE, LocalLevel};
use crate::anchor::Anchor;
use crate::{BodyMotion, Increments, Pva, Vertical};

/// Navigators that go together.
pub const LANES: usize = 8;

/// One number of each.
pub type Eight = [f64; LANES];

/// Eight [`LocalLevel`] navigators that share steps, gravity and the treatment of the vertical channel, and nothing else: runs
/// of a Monte Carlo, or a run with each of eight errors.
///
/// Each gives the same bits as a [`LocalLevel`] by itself, on every machine: the operations are the same in the same
/// order, additions and products alone, and nothing is fused.
#[derive(Clone, Debug)]
pub struct LocalLevelLanes {
    level: Level,
    nav: LocalLevel<Eight>,
    /// The anchors by themselves: moving one takes trigonometry, a few times a second.
    anchors: [Anchor<f64>; LANES],
}

impl LocalLevelLanes {
    /// Navigators that start at `starts`, in the widest lanes of this machine.
    pub fn new(starts: &[Pva; LANES], gravity: Gravity, vertical: Vertical) -> Self {
        Self::at_level(best_level(), starts, gravity, vertical)
    }

    /// The same in lanes of a stated kind: for tests, and machines that may not all be asked.
    pub fn at_level(level: Level, starts: &[Pva; LANES], gravity: Gravity, vertical: Vertical) -> Self {
        let each = starts.each_ref().map(|start| LocalLevel::new(start, gravity, vertical));
        let anchors = each.each_ref().map(|nav| nav.anchor);
        let mut numbers = each.map(|nav| {
            Numbers::of(|f| {
                nav.map(&mut |x| f(x));
            })
        });
        let nav = each[0].map(&mut |_| numbers.each_mut().map(Numbers::next));
        LocalLevelLanes { level, nav, anchors }
    }

    /// One step each over `dt` (s) for every entry of `increments`: those of navigator i stand in lane i.
    ///
    /// Long slices are faster: what the navigators carry stays in registers from step to step.
    pub fn steps(&mut self, increments: &[Increments<Eight>], dt: f64) {
        let mut rest = increments;
        while !rest.is_empty() {
            // As far as the anchors last, counted as a navigator by itself counts.
            let mut count = 0;
            while count < rest.len() {
                let age = self.nav.age + dt;
                if age > ANCHOR_AGE {
                    if count > 0 {
                        break;
                    }
                    self.move_anchors();
                    self.nav.age = dt;
                } else {
                    self.nav.age = age;
                }
                count += 1;
            }
            let (now, later) = rest.split_at(count);
            dispatch!(self.level, simd => advance(simd, &mut self.nav, now, dt));
            rest = later;
        }
    }

    /// Position, velocity and attitude of navigator `lane` now. Panics from [`LANES`] on.
    pub fn pva(&self, lane: usize) -> Pva {
        self.nav.map(&mut |eight| eight[lane]).pva()
    }

    fn move_anchors(&mut self) {
        for (lane, anchor) in self.anchors.iter_mut().enumerate() {
            anchor.move_by(self.nav.way.map(|eight| eight[lane]), self.nav.gravity);
        }
        let mut numbers = self.anchors.map(|anchor| {
            Numbers::of(|f| {
                anchor.map(&mut |x| f(x));
            })
        });
        self.nav.anchor = self.anchors[0].map(&mut |_| numbers.each_mut().map(Numbers::next));
        self.nav.way = [[0.0; LANES]; 3];
    }
}

#[inline(always)]
fn advance<S: Simd>(simd: S, nav: &mut LocalLevel<Eight>, increments: &[Increments<Eight>], dt: f64) {
    let load = |eight: Eight| Lane(f64x8::from_slice(simd, &eight));
    let mut lanes = nav.map(&mut { load });
    for Increments { dtheta, dv } in increments {
        let increments = Increments {
            dtheta: Vec3::claim(dtheta.as_array().map(load)),
            dv: Vec3::claim(dv.as_array().map(load)),
        };
        lanes.advance_kernel(&BodyMotion::of(&increments), dt);
    }
    *nav = lanes.map(&mut |lane: Lane<S>| {
        let mut eight = [0.0; LANES];
        lane.0.store_slice(&mut eight);
        eight
    });
}

/// The numbers of a navigator one after the other.
struct Numbers {
    all: [f64; ROOM],
    at: usize,
}

/// More than a navigator has.
const ROOM: usize = 64;

impl Numbers {
    /// Those that a visit meets.
    fn of(visit: impl FnOnce(&mut dyn FnMut(f64) -> f64)) -> Numbers {
        let mut numbers = Numbers { all: [0.0; ROOM], at: 0 };
        visit(&mut |x| {
            numbers.all[numbers.at] = x;
            numbers.at += 1;
            x
        });
        numbers.at = 0;
        numbers
    }

    fn next(&mut self) -> f64 {
        self.at += 1;
        self.all[self.at - 1]
    }
}

/// Eight numbers in the machine's lanes.
struct Lane<S: Simd>(f64x8<S>);

impl<S: Simd> Clone for Lane<S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd> Copy for Lane<S> {}

macro_rules! operator {
    ($trait:ident, $method:ident, $symbol:tt) => {
        impl<S: Simd> $trait for Lane<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: Self) -> Self {
                Lane(self.0 $symbol o.0)
            }
        }

        impl<S: Simd> $trait<f64> for Lane<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, o: f64) -> Self {
                Lane(self.0 $symbol o)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);

impl<S: Simd> AddAssign for Lane<S> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<S: Simd> SubAssign for Lane<S> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<S: Simd> Neg for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Lane(-self.0)
    }
}

impl<S: Simd> Real for Lane<S> {
    #[inline(always)]
    fn lift(self, c: f64) -> Self {
        Lane(f64x8::splat(self.0.simd, c))
    }
}
