//! What a body does over an interval: the sums that all transitions over it are made of.

use fearless_simd::{Simd, SimdBase, f64x4};
use nalgebra::Vector3;

use super::waiting::{STEPS, Waiting};

/// Three rows, one an axis of t, of four.
pub(crate) type Rows = [[f64; 4]; 3];

/// Integrals of attitude and specific force over an interval.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Body {
    /// ∫ C, and behind it ∫ f.
    pub turned: Rows,
    /// The integrals of these.
    pub turning: Rows,
    /// ∫ f × (∫ C).
    pub tilted: Rows,
    /// Its integral.
    pub tilting: Rows,
}

impl Body {
    pub const NONE: Self =
        Body { turned: [[0.0; 4]; 3], turning: [[0.0; 4]; 3], tilted: [[0.0; 4]; 3], tilting: [[0.0; 4]; 3] };

    /// ∫ f.
    pub fn gained(&self) -> Vector3<f64> {
        last(&self.turned)
    }

    /// ∫∫ f.
    pub fn moved(&self) -> Vector3<f64> {
        last(&self.turning)
    }

    /// Adds the steps that wait, whose middles are known: to the middle of each and from there to its end.
    #[inline(always)]
    pub fn add<S: Simd>(&mut self, simd: S, steps: &Waiting) {
        let load = |x: &[f64; 4]| f64x4::<S>::from_slice(simd, x);
        let of = |x: &Rows| [load(&x[0]), load(&x[1]), load(&x[2])];
        let (mut turned, mut turning) = (of(&self.turned), of(&self.turning));
        let (mut tilted, mut tilting) = (of(&self.tilted), of(&self.tilting));
        for k in 0..steps.count.min(STEPS) {
            let dt = steps.dt(k);
            let mut middle = turned;
            for i in 0..3 {
                let half = load(&steps.half[i][k]);
                middle[i] = turned[i] + half;
                turned[i] = middle[i] + half;
                turning[i] += middle[i] * dt;
            }
            for i in 0..3 {
                let (j, l) = ((i + 1) % 3, (i + 2) % 3);
                let half = middle[l] * steps.half[j][k][3] - middle[j] * steps.half[l][k][3];
                let halfway = tilted[i] + half;
                tilting[i] += halfway * dt;
                tilted[i] = halfway + half;
            }
        }
        for i in 0..3 {
            turned[i].store_slice(&mut self.turned[i]);
            turning[i].store_slice(&mut self.turning[i]);
            tilted[i].store_slice(&mut self.tilted[i]);
            tilting[i].store_slice(&mut self.tilting[i]);
        }
    }
}

fn last(rows: &Rows) -> Vector3<f64> {
    Vector3::new(rows[0][3], rows[1][3], rows[2][3])
}
