//! The generator against its published known answers.

use schuler_imu::random::{normals, philox4x32_10};

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

/// The transform against the platform's logarithm, sine and cosine.
#[test]
fn normals_are_those_of_box_and_muller() {
    let mut words = [7, 11, 13, 17];
    for _ in 0..20_000 {
        words = philox4x32_10(words, [1, 2]);
        let n = normals(words);
        for (pair, w) in n.chunks(2).zip(words.chunks(2)) {
            let u = (f64::from(w[0]) + 0.5) / 2f64.powi(32);
            let (sin, cos) = (f64::from(w[1]) / 2f64.powi(32) * core::f64::consts::TAU).sin_cos();
            let r = (-2.0 * u.ln()).sqrt();
            assert!((pair[0] - r * cos).abs() < 1e-10 && (pair[1] - r * sin).abs() < 1e-10, "{words:x?}");
        }
    }
    for edge in [0, u32::MAX] {
        assert!(normals([edge; 4]).iter().all(|n| n.abs() < 6.77));
    }
}
