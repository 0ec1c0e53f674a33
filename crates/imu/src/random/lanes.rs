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

/// -4 artanh(s)/s in powers of s² for |s| <= (sqrt 2 - 1)/(sqrt 2 + 1), relative error 5e-12. The 32 bits of
/// the uniform numbers resolve less than that.
const LN: [f64; 5] = [
    -4.000000000016848094,
    -1.3333333048090467044,
    -0.80000771738271300829,
    -0.57069971851503897297,
    -0.47234931663659792924,
];

/// sin(pi t)/t in powers of t² for |t| <= 1/2, relative error 3e-11.
const SIN: [f64; 6] = [
    3.1415926535233456298,
    -5.1677127621157990789,
    2.5501632403178496034,
    -0.59925133010864397756,
    0.082046478838150895115,
    -0.0070221635351414481567,
];

/// cos(pi t) in powers of t² for |t| <= 1/2, absolute error 8e-13.
const COS: [f64; 7] = [
    0.99999999999925183371,
    -4.9348022002509625208,
    4.0587121075893689817,
    -1.3352623161477628363,
    0.23532544342332018582,
    -0.025776340729332618837,
    0.0018400218371692892988,
];

/// The widest lanes of this machine; those of the target where nothing can be found out.
pub fn best_level() -> Level {
    Level::try_detect().unwrap_or(Level::baseline())
}

/// Steps whose normals are made together.
pub const STEPS: usize = 8;

/// The standard normals of steps `8 octet` to `8 octet + 7` for each address: `out[i][k]` is that of step
/// `8 octet + k` for `addresses[i]`.
///
/// The words of address `a` are those of Philox4x32-10 with counter `(block, a)`, low words first, and
/// key `key`; two of them make a pair of normals, the first the radius and the second the angle, so that
/// one block serves four steps. The radius has 32 random bits, so that no normal is beyond 6.76. The
/// number of addresses must be a multiple of 4 and not above that of `out`; a rest is left alone.
pub fn fill_normals(level: Level, key: [u32; 2], octet: u64, addresses: &[u64], out: &mut [[f64; STEPS]]) {
    let out = out[..addresses.len()].as_flattened_mut();
    dispatch!(level, simd => fill::<_, 2>(simd, key, 2 * octet, addresses, out));
}

/// Eights of steps whose normals are made together: two addresses then fill the widest lanes.
pub(crate) const OCTETS: usize = 2;

/// The normals of an address in them.
pub(crate) type Drawn = [[f64; STEPS]; OCTETS];

/// The same for [`OCTETS`] eights of steps, from that of number `octet` on. The number of addresses must be even.
pub(crate) fn fill_drawn(level: Level, key: [u32; 2], octet: u64, addresses: &[u64], out: &mut [Drawn]) {
    let out = out[..addresses.len()].as_flattened_mut().as_flattened_mut();
    dispatch!(level, simd => fill::<_, { 2 * OCTETS }>(simd, key, 2 * octet, addresses, out));
}

/// First the words of all addresses, then their normals in the same place: each loop alone keeps the
/// processor busier than both in one. In neighbouring lanes stand the blocks of an address, `BLOCKS` from `first` on.
#[inline(always)]
fn fill<S: Simd, const BLOCKS: usize>(
    simd: S,
    key: [u32; 2],
    first: u64,
    addresses: &[u64],
    out: &mut [f64],
) {
    let n = S::f64s::LEN;
    for (v, out) in out.chunks_exact_mut(4 * n).enumerate() {
        let block = S::u64s::from_fn(simd, |i| first + ((v * n + i) % BLOCKS) as u64);
        let address = S::u64s::from_fn(simd, |i| addresses[(v * n + i) / BLOCKS]);
        let words = philox(simd, [block & WORD, block >> 32, address & WORD, address >> 32], key);
        for (word, out) in words.iter().zip(out.chunks_exact_mut(n)) {
            word.bitcast::<S::f64s>().store_slice(out);
        }
    }
    for out in out.chunks_exact_mut(4 * n) {
        let [n0, n1] = pair(simd, word(simd, out, 0), word(simd, out, 1));
        let [n2, n3] = pair(simd, word(simd, out, 2), word(simd, out, 3));
        let (even, odd) = ([n0.zip_low(n2), n0.zip_high(n2)], [n1.zip_low(n3), n1.zip_high(n3)]);
        for (half, out) in out.chunks_exact_mut(2 * n).enumerate() {
            even[half].zip_low(odd[half]).store_slice(&mut out[..n]);
            even[half].zip_high(odd[half]).store_slice(&mut out[n..]);
        }
    }
}

/// Word `i` of all lanes.
#[inline(always)]
fn word<S: Simd>(simd: S, words: &[f64], i: usize) -> S::u64s {
    S::f64s::from_slice(simd, &words[i * S::f64s::LEN..(i + 1) * S::f64s::LEN]).bitcast()
}

/// Philox4x32-10 on words that stand in the low halves of 64-bit lanes. What comes into the high halves on the way stays
/// there: a multiplication of two low halves is one instruction that does not look at them.
#[inline(always)]
fn philox<S: Simd>(simd: S, mut c: [S::u64s; 4], [mut k0, mut k1]: [u32; 2]) -> [S::u64s; 4] {
    let (m0, m1) = (S::u64s::splat(simd, 0xD251_1F53), S::u64s::splat(simd, 0xCD9E_8D57));
    for _ in 0..10 {
        let (p0, p1) = ((c[0] & WORD) * m0, (c[2] & WORD) * m1);
        c = [(p1 >> 32) ^ c[1] ^ u64::from(k0), p1, (p0 >> 32) ^ c[3] ^ u64::from(k1), p0];
        k0 = k0.wrapping_add(0x9E37_79B9);
        k1 = k1.wrapping_add(0xBB67_AE85);
    }
    [c[0] & WORD, c[1] & WORD, c[2] & WORD, c[3] & WORD]
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
