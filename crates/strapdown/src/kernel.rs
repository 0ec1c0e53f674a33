//! Arithmetic of the hot loop: only products and sums, so that lanes and dual numbers can run it.

use schuler_frames::{Frame, Rot};
use schuler_frames::{Real, Vec3};

/// A sum that keeps what rounding drops (Dekker's fast two-sum with the rest carried over).
///
/// Millions of additions of small increments to a large value would otherwise round the same way
/// each time and drift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sum<S> {
    pub hi: S,
    lo: S,
}

impl<S> Sum<S> {
    /// Every number in it in another kind of number.
    #[inline(always)]
    pub fn map<R>(self, f: &mut impl FnMut(S) -> R) -> Sum<R> {
        Sum { hi: f(self.hi), lo: f(self.lo) }
    }
}

impl<S: Real> Sum<S> {
    #[inline(always)]
    pub fn new(value: S) -> Self {
        Sum { hi: value, lo: value.lift(0.0) }
    }

    #[inline(always)]
    pub fn add(&mut self, x: S) {
        let y = x + self.lo;
        let sum = self.hi + y;
        self.lo = y - (sum - self.hi);
        self.hi = sum;
    }

    #[inline(always)]
    pub fn value(&self) -> S {
        self.hi + self.lo
    }
}

/// Quaternion of the rotation vector `sigma` (rad) less the identity: `[cos(|sigma|/2) - 1, sin(|sigma|/2) sigma/|sigma|]`.
///
/// By series in |sigma|², exact to 1e-16 for |sigma| up to 1 rad. The identity is left out so that
/// the rounding is relative to the small turn and not to 1.
#[inline(always)]
pub(crate) fn turn<F: Frame, S: Real>(sigma: Vec3<F, S>) -> [S; 4] {
    let x = sigma.norm_squared() * 0.25;
    // (cos √x - 1)/x and sin √x / √x
    let c = ((((x * (-1.0 / 87_178_291_200.0) + 1.0 / 479_001_600.0) * x - 1.0 / 3_628_800.0) * x
        + 1.0 / 40_320.0)
        * x
        - 1.0 / 720.0)
        * x;
    let c = (c + 1.0 / 24.0) * x - 0.5;
    let s = ((((x * (1.0 / 6_227_020_800.0) - 1.0 / 39_916_800.0) * x + 1.0 / 362_880.0) * x
        - 1.0 / 5_040.0)
        * x
        + 1.0 / 120.0)
        * x;
    let s = ((s - 1.0 / 6.0) * x + 1.0) * 0.5;
    let [a, b, d] = sigma.as_array();
    [c * x, a * s, b * s, d * s]
}

/// [`turn`] for the slow turn of the local level frame: exact to 1e-16 for |sigma| < 0.003 rad.
#[inline(always)]
pub(crate) fn small_turn<F: Frame, S: Real>(sigma: Vec3<F, S>) -> [S; 4] {
    let x = sigma.norm_squared() * 0.25;
    let c = (x * (1.0 / 24.0) - 0.5) * x;
    let s = x * (-1.0 / 12.0) + 0.5;
    let [a, b, d] = sigma.as_array();
    [c, a * s, b * s, d * s]
}

/// A unit quaternion that takes small turns on either side without accumulating rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Quaternion<S> {
    parts: [Sum<S>; 4],
    /// What holds |q| at 1: half of the first-order correction, from the step before, so that nothing waits for
    /// it. (The whole one, so late, would swing for ever.)
    pull: S,
}

impl<S> Quaternion<S> {
    /// Every number in it in another kind of number.
    #[inline(always)]
    pub fn map<R>(self, f: &mut impl FnMut(S) -> R) -> Quaternion<R> {
        Quaternion { parts: self.parts.map(|part| part.map(f)), pull: f(self.pull) }
    }
}

impl<S: Real> Quaternion<S> {
    #[inline(always)]
    pub fn new(wxyz: [S; 4]) -> Self {
        Quaternion { parts: wxyz.map(Sum::new), pull: wxyz[0].lift(0.0) }
    }

    #[inline(always)]
    pub fn rot<To: Frame, From: Frame>(&self) -> Rot<To, From, S> {
        Rot::claim(self.parts.map(|part| part.hi))
    }

    /// `(1 + left) ⊗ q ⊗ (1 + right)`, where both turns are given less the identity. The change of q
    /// is formed by itself and added with its rounding kept; a first-order pull holds |q| at 1.
    #[inline(always)]
    pub fn turn(&mut self, left: [S; 4], right: [S; 4]) {
        let q = self.parts();
        let r = product(q, right);
        let l = product(left, [q[0] + r[0], q[1] + r[1], q[2] + r[2], q[3] + r[3]]);
        self.add(q, [r[0] + l[0], r[1] + l[1], r[2] + l[2], r[3] + l[3]]);
    }

    /// [`Quaternion::turn`] with a left turn by the constant angle `angle` (rad, below 0.003) about z.
    #[inline(always)]
    pub fn turn_about_z(&mut self, angle: f64, right: [S; 4]) {
        let q = self.parts();
        let r = product(q, right);
        let [w, x, y, z] = [q[0] + r[0], q[1] + r[1], q[2] + r[2], q[3] + r[3]];
        let square = 0.25 * angle * angle;
        let (c, s) = ((square * (1.0 / 24.0) - 0.5) * square, (0.5 - square * (1.0 / 12.0)) * angle);
        self.add(
            q,
            [r[0] + (w * c - z * s), r[1] + (x * c - y * s), r[2] + (y * c + x * s), r[3] + (z * c + w * s)],
        );
    }

    /// [`Quaternion::turn`] without a left turn.
    #[inline(always)]
    pub fn turn_right(&mut self, right: [S; 4]) {
        let q = self.parts();
        self.add(q, product(q, right));
    }

    #[inline(always)]
    fn parts(&self) -> [S; 4] {
        [self.parts[0].hi, self.parts[1].hi, self.parts[2].hi, self.parts[3].hi]
    }

    #[inline(always)]
    fn add(&mut self, q: [S; 4], change: [S; 4]) {
        let pull = self.pull;
        self.parts[0].add(change[0] + pull * q[0]);
        self.parts[1].add(change[1] + pull * q[1]);
        self.parts[2].add(change[2] + pull * q[2]);
        self.parts[3].add(change[3] + pull * q[3]);
        self.pull = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0) * -0.25;
    }
}

/// Hamilton product.
#[inline(always)]
fn product<S: Real>([a, b, c, d]: [S; 4], [w, x, y, z]: [S; 4]) -> [S; 4] {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}
