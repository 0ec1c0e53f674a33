//! Standard normals for many addresses at once, in the widest lanes that the machine has.
//!
//! Philox4x32-10 and the transform of Box and Muller, whose logarithm, sine and cosine are polynomials
//! of ours: only integer operations and additions, multiplications, divisions and square roots, which
//! IEEE 754 rounds correctly, and nothing is fused. So every machine and every width gives the same
//! bits.

use core::f64::consts::{LN_2, SQRT_2};

use fearless_simd::prelude::*;
use fearless_simd::{Level, Simd, dispatch};

/// A word of 32 bits.
const WORD: u64 = 0xffff_ffff;

/// Bits of 2^52: with an integer below 2^52 in the mantissa, the number is 2^52 plus that integer.
const MAGIC: u64 = 0x4330_0000_0000_0000;
const TWO_POW_52: f64 = 4_503_599_627_370_496.0;
const TWO_POW_MINUS_32: f64 = 1.0 / 4_294_967_296.0;

/// -4 artanh(s)/s in powers of s² for |s| <= (sqrt 2 - 1)/(sqrt 2 + 1), relative error 3e-14.
const LN: [f64; 6] = [
    -3.9999999999998943761,
    -1.3333333335915850423,
    -0.79999989783664765487,
    -0.57144332291751450139,
    -0.44348499820154979583,
    -0.39216191279506105493,
];

/// sin(pi t)/t in powers of t² for |t| <= 1/2, relative error 8e-14.
const SIN: [f64; 7] = [
    3.1415926535896350618,
    -5.1677127799879590018,
    2.550164035906744668,
    -0.59926443393572864576,
    0.082144794670648549212,
    -0.0073640054721157225265,
    0.00044749208490771010666,
];

/// cos(pi t) in powers of t² for |t| <= 1/2, absolute error 2e-15.
const COS: [f64; 8] = [
    0.99999999999999805987,
    -4.9348022005436858994,
    4.0587121263332948238,
    -1.3352627661817635356,
    0.23533058831317873049,
    -0.025806531975921562038,
    0.0019278700526981332897,
    -0.00010041646422053889957,
];

/// The widest lanes of this machine; those of the target where nothing can be found out.
pub fn best_level() -> Level {
    Level::try_detect().unwrap_or(Level::baseline())
}

/// Four standard normals for each address: `out[q][i]` belongs to `addresses[i]`.
///
/// The words of address `a` are those of Philox4x32-10 with counter `(block, a)`, low words first, and
/// key `key`; two of them make a pair of normals, the first the radius and the second the angle. The
/// radius has 32 random bits, so that no normal is beyond 6.76. `addresses` and each of `out` must be
/// of the same length, a multiple of 8; a rest is left alone.
pub fn fill_normals(level: Level, key: [u32; 2], block: u64, addresses: &[u64], out: [&mut [f64]; 4]) {
    dispatch!(level, simd => fill(simd, key, block, addresses, out));
}

#[inline(always)]
fn fill<S: Simd>(simd: S, key: [u32; 2], block: u64, addresses: &[u64], out: [&mut [f64]; 4]) {
    let n = S::f64s::LEN;
    let [out0, out1, out2, out3] = out.map(|o| o.chunks_exact_mut(n));
    let chunks = addresses.chunks_exact(n).zip(out0).zip(out1).zip(out2).zip(out3);
    for ((((address, out0), out1), out2), out3) in chunks {
        let address = S::u64s::from_slice(simd, address);
        let counter = [
            S::u64s::splat(simd, block & WORD),
            S::u64s::splat(simd, block >> 32),
            address & WORD,
            address >> 32,
        ];
        let [radius0, angle0, radius1, angle1] = philox(simd, counter, key);
        let [n0, n1] = pair(simd, radius0, angle0);
        let [n2, n3] = pair(simd, radius1, angle1);
        n0.store_slice(out0);
        n1.store_slice(out1);
        n2.store_slice(out2);
        n3.store_slice(out3);
    }
}

/// Philox4x32-10 on words that stand in the low halves of 64-bit lanes.
#[inline(always)]
fn philox<S: Simd>(simd: S, mut c: [S::u64s; 4], [mut k0, mut k1]: [u32; 2]) -> [S::u64s; 4] {
    let (m0, m1) = (S::u64s::splat(simd, 0xD251_1F53), S::u64s::splat(simd, 0xCD9E_8D57));
    for _ in 0..10 {
        let (p0, p1) = (c[0] * m0, c[2] * m1);
        c = [(p1 >> 32) ^ c[1] ^ u64::from(k0), p1 & WORD, (p0 >> 32) ^ c[3] ^ u64::from(k1), p0 & WORD];
        k0 = k0.wrapping_add(0x9E37_79B9);
        k1 = k1.wrapping_add(0xBB67_AE85);
    }
    c
}

#[inline(always)]
fn pair<S: Simd>(simd: S, radius: S::u64s, angle: S::u64s) -> [S::f64s; 2] {
    // Uniform in (0, 1): (radius + 1/2)/2^32.
    let u = ((radius | MAGIC).bitcast::<S::f64s>() - (TWO_POW_52 - 0.5)) * TWO_POW_MINUS_32;
    let r = minus_two_ln::<S>(simd, u).sqrt();
    // The lowest bit turns by half a turn, the others place the angle within a quarter of a turn to
    // either side.
    let r: S::f64s = (r.bitcast::<S::u64s>() ^ ((angle & 1) << 63)).bitcast();
    let t = ((angle | (MAGIC | 1)).bitcast::<S::f64s>() - (TWO_POW_52 + 2_147_483_648.0)) * TWO_POW_MINUS_32;
    let z = t * t;
    [r * polynomial(simd, z, &COS), r * (t * polynomial(simd, z, &SIN))]
}

/// -2 ln u for u in (0, 1).
#[inline(always)]
fn minus_two_ln<S: Simd>(simd: S, u: S::f64s) -> S::f64s {
    // u = m 2^e with m in [1/sqrt 2, sqrt 2), ln m = 2 artanh((m - 1)/(m + 1)).
    let root = SQRT_2.to_bits();
    let shifted = u.bitcast::<S::u64s>() - (root - (1023 << 52));
    let m: S::f64s = ((shifted & ((1 << 52) - 1)) + (root - (1 << 52))).bitcast();
    let e = ((shifted >> 52) | MAGIC).bitcast::<S::f64s>() - (TWO_POW_52 + 1022.0);
    let s = (m - 1.0) / (m + 1.0);
    e * (-2.0 * LN_2) + s * polynomial(simd, s * s, &LN)
}

#[inline(always)]
fn polynomial<S: Simd, const N: usize>(simd: S, z: S::f64s, c: &[f64; N]) -> S::f64s {
    let mut sum = S::f64s::splat(simd, c[N - 1]);
    for i in (0..N - 1).rev() {
        sum = sum * z + c[i];
    }
    sum
}
