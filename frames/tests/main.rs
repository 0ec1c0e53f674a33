//! Laws and oracles of the frames, one module a subject.

mod field;
mod geodesy;

/// Rows of a table in `tests/data`, as numbers; the header line is left out.
fn table(path: &str) -> Vec<Vec<f64>> {
    let path = format!("{}/../tests/data/{path}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    text.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}
