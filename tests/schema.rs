//! The committed schema is that of the code.

use std::{fs, path::Path};

/// Written anew by `schuler schema > schema/scenario.json`.
#[test]
fn the_committed_schema_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("schema/scenario.json");
    let committed = fs::read_to_string(path).expect("schema/scenario.json");
    assert!(
        committed == schuler::studies::scenario::json_schema(),
        "write it anew: cargo run -- schema > schema/scenario.json"
    );
}
