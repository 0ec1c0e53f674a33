//! Draws beside the sensors.

use schuler_imu::{Stream, random::Draws};

/// Mean, variance and correlation of neighbours, names and runs within five sigmas of the estimate.
#[test]
fn draws_are_standard_and_independent() {
    const N: usize = 20_000;
    let series = |seed, run, name: &str| -> Vec<f64> {
        let draws = Draws::new(Stream { seed, run }, &name);
        (0..N as u64 / 4).flat_map(|k| draws.normals(k)).collect()
    };
    let bound = 5.0 / (N as f64).sqrt();
    let mean = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>() / a.len() as f64;
    let all = [
        series(1, 0, "velocity"),
        series(1, 0, "velocity/1"),
        series(1, 1, "velocity"),
        series(2, 0, "velocity"),
    ];
    for (i, a) in all.iter().enumerate() {
        assert!(mean(a, &vec![1.0; N]).abs() < bound);
        assert!((mean(a, a) - 1.0).abs() < bound * 2f64.sqrt());
        assert!(mean(&a[1..], a).abs() < bound);
        for b in &all[..i] {
            assert!(mean(a, b).abs() < bound);
        }
    }
}
