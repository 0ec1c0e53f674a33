//! Standard normals by the transform of Box and Muller with arithmetic of our own.

use core::f64::consts::{FRAC_PI_2, LN_2, SQRT_2};

/// Four independent standard normals from four random words.
///
/// Only additions, multiplications, divisions and square roots are used, which IEEE 754 rounds
/// correctly, so that the bits are the same on every machine. Each radius has 32 random bits: the
/// largest normal is 6.76.
#[inline]
pub fn normals([a, b, c, d]: [u32; 4]) -> [f64; 4] {
    let ([n0, n1], [n2, n3]) = (pair(a, b), pair(c, d));
    [n0, n1, n2, n3]
}

#[inline]
fn pair(radius: u32, angle: u32) -> [f64; 2] {
    let r = libm::sqrt(-2.0 * ln((f64::from(radius) + 0.5) * TWO_POW_MINUS_32));
    let (sin, cos) = sin_cos_turn(angle);
    [r * cos, r * sin]
}

const TWO_POW_MINUS_32: f64 = 1.0 / 4_294_967_296.0;

/// Natural logarithm of a normal number in (0, 1].
#[inline]
fn ln(x: f64) -> f64 {
    // x = m 2^e with m in [1/sqrt 2, sqrt 2), ln m = 2 artanh((m - 1)/(m + 1)).
    let shifted = x.to_bits() - (SQRT_2.to_bits() - (1023 << 52));
    let m = f64::from_bits((shifted & ((1 << 52) - 1)) + (SQRT_2.to_bits() - (1 << 52)));
    let e = (shifted >> 52) as i64 - 1022;
    let s = (m - 1.0) / (m + 1.0);
    let z = s * s;
    let mut series = 0.0;
    let mut k = 21;
    while k > 0 {
        series = series * z + 2.0 / f64::from(k);
        k -= 2;
    }
    e as f64 * LN_2 + s * series
}

/// Sine and cosine of `turn`/2^32 full turns.
#[inline]
fn sin_cos_turn(turn: u32) -> (f64, f64) {
    // Nearest quarter turn, and what is left of it in [-1/8, 1/8) of a turn.
    let quarter = turn.wrapping_add(1 << 29) >> 30;
    let rest = turn.wrapping_sub(quarter << 30) as i32;
    let x = f64::from(rest) * (FRAC_PI_2 / f64::from(1_u32 << 30));
    let z = x * x;
    let s = x
        * (1.0
            + z * (-1.0 / 6.0
                + z * (1.0 / 120.0
                    + z * (-1.0 / 5040.0
                        + z * (1.0 / 362_880.0 + z * (-1.0 / 39_916_800.0 + z / 6_227_020_800.0))))));
    let c = 1.0
        + z * (-0.5
            + z * (1.0 / 24.0
                + z * (-1.0 / 720.0
                    + z * (1.0 / 40_320.0 + z * (-1.0 / 3_628_800.0 + z * (1.0 / 479_001_600.0))))));
    match quarter & 3 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}
