//! Laws and oracles of the frames, one module a subject.

mod attitude;
mod dual;
mod field;
mod geodesy;
mod mistakes;
mod motion;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use schuler_frames::{Frame, Rot, Vec3};

/// A thousand cases, the same ones in every run; `PROPTEST_CASES` asks for more.
fn laws() -> ProptestConfig {
    let asked = ProptestConfig::default();
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { asked.cases } else { 1000 };
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..asked }
}

/// Vectors with components within ± `size`.
fn vectors<F: Frame>(size: f64) -> impl Strategy<Value = Vec3<F>> {
    prop::array::uniform3(-size..size).prop_map(Vec3::claim)
}

/// Rotations all over the group, and as often very near identity and half turns.
fn rotations<To: Frame, From: Frame>() -> impl Strategy<Value = Rot<To, From>> {
    let any = prop::array::uniform4(-1.0..1.0f64)
        .prop_filter("a direction needs a length", |q| q.iter().map(|c| c * c).sum::<f64>() > 1e-3)
        .prop_map(|q| Rot::claim(q).normalized());
    let near = |centre: [f64; 4]| {
        (vectors::<To>(1.0), -16..0i32).prop_map(move |(v, exponent)| {
            Rot::<To, To>::from_rotation_vector(v * 10f64.powi(exponent)) * Rot::<To, From>::claim(centre)
        })
    };
    prop_oneof![any, near([1.0, 0.0, 0.0, 0.0]), near([0.0, 1.0, 0.0, 0.0]), near([0.0, 0.0, 0.6, -0.8])]
}

/// Rows of a table in `tests/data`, as numbers; the header line is left out.
fn table(path: &str) -> Vec<Vec<f64>> {
    let path = format!("{}/../tests/data/{path}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    text.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}
