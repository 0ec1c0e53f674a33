//! The generator against its published known answers.

use schuler_imu::random::{Level, STEPS, best_level, fill_normals, philox4x32_10};

/// Vectors `philox4x32 10` of the file `kat_vectors` of Random123, version 1.09.
#[test]
fn known_answers() {
    let vectors = [
        ([0; 4], [0; 2], [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]),
        ([u32::MAX; 4], [u32::MAX; 2], [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]),
        (
            [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344],
            [0xa409_3822, 0x299f_31d0],
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1],
        ),
    ];
    for (counter, key, expected) in vectors {
        assert_eq!(philox4x32_10(counter, key), expected);
    }
}

/// The lanes against the scalar generator and the platform's logarithm, sine and cosine: the stated errors of
/// the polynomials, 3e-11 at most, of numbers up to 6.76.
#[test]
fn normals_are_those_of_box_and_muller() {
    let key = [0x1234_5678, 0x9abc_def0];
    let addresses: Vec<u64> = (0..64_u64).map(|i| i.wrapping_mul(0x9e37_79b9_7f4a_7c15)).collect();
    for block in (0..200).chain([u64::MAX / 3]) {
        let normals = fill(best_level(), key, block / 2, &addresses);
        let at = 4 * (block % 2) as usize;
        for (i, a) in addresses.iter().enumerate() {
            let w = philox4x32_10([block as u32, (block >> 32) as u32, *a as u32, (a >> 32) as u32], key);
            for q in 0..2 {
                let u = (f64::from(w[2 * q]) + 0.5) / 2f64.powi(32);
                let turn = f64::from((w[2 * q + 1] | 1).wrapping_add(1 << 31) as i32) / 2f64.powi(32);
                let sign = if w[2 * q + 1] & 1 == 1 { -1.0 } else { 1.0 };
                let (sin, cos) = (turn * std::f64::consts::PI).sin_cos();
                let r = sign * (-2.0 * u.ln()).sqrt();
                for (found, expected) in
                    [(normals[i][at + 2 * q], r * cos), (normals[i][at + 2 * q + 1], r * sin)]
                {
                    assert!((found - expected).abs() < 1.5e-10, "{found} {expected}");
                }
            }
        }
    }
}

fn fill(level: Level, key: [u32; 2], octet: u64, addresses: &[u64]) -> Vec<[f64; STEPS]> {
    let mut out = vec![[0.0; STEPS]; addresses.len()];
    fill_normals(level, key, octet, addresses, &mut out);
    out
}

/// Every level that this machine has.
pub fn levels() -> Vec<Level> {
    let best = best_level();
    let mut levels = vec![Level::baseline(), best];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(best.as_sse2().map(Level::Sse2));
        levels.extend(best.as_sse4_2().map(Level::Sse4_2));
        levels.extend(best.as_avx2().map(Level::Avx2));
    }
    levels
}

/// Every width of lanes gives the same bits.
#[test]
fn all_lanes_agree_bit_for_bit() {
    let addresses: Vec<u64> = (0..1024_u64).map(|i| i.wrapping_mul(0xdead_beef_cafe_f00d)).collect();
    let best = best_level();
    let expected = fill(best, [3, 4], 77, &addresses);
    for level in levels() {
        assert!(fill(level, [3, 4], 77, &addresses) == expected, "{level:?}");
    }
}

/// Against an independent implementation, word for word.
#[test]
fn words_are_those_of_an_independent_implementation() {
    let (mut counter, mut key) = ([1, 2, 3, 4], [5, 6]);
    for _ in 0..10_000 {
        let words = philox4x32_10(counter, key);
        assert_eq!(words, rand_philox::philox4x32_10(counter, key));
        (counter, key) = (words, [words[3] ^ key[1], words[0]]);
    }
}
