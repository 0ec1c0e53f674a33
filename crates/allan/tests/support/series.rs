//! Series that other programs can make to the last bit, and reference tables.
use std::path::Path;

/// n / (2^31 - 1) of the Lehmer generator n -> 16807 n mod (2^31 - 1), first the seed itself: the NBS/NIST
/// test suite (NIST SP 1065, section 12.4) for seed 1234567890 and 1000 numbers.
pub fn lehmer(seed: u64, count: usize) -> Vec<f64> {
    let mut n = seed;
    (0..count)
        .map(|_| {
            let y = n as f64 / 2_147_483_647.0;
            n = n * 16807 % 2_147_483_647;
            y
        })
        .collect()
}

/// The series of tests/data/allan/README.md.
pub fn allantools_series() -> Vec<f64> {
    let mut r = 0.0;
    lehmer(42, 5000)
        .iter()
        .map(|y| {
            let w = y - 0.5;
            r += w / 16.0;
            w + r
        })
        .collect()
}

/// Rows of a table under tests/data, header and comments left out.
pub fn table(name: &str) -> Vec<Vec<String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let rows = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    rows.map(|l| l.split(',').map(str::to_owned).collect()).collect()
}
