//! Recorded logs that may not be distributed, for tests: where they are, and a word where they are not.

use std::{
    io::Write,
    path::{Path, PathBuf},
};

/// The folder that SCHULER_DATA names, else `../shared/data` beside the repository; `None` where there is neither.
pub fn folder(repository: &Path) -> Option<PathBuf> {
    let named = std::env::var_os("SCHULER_DATA").map(PathBuf::from);
    named.into_iter().chain([repository.join("../shared/data")]).find(|path| path.is_dir())
}

/// Says that a test was skipped. The harness shows what passing tests print only on request; what is written to the
/// stream itself it does not catch.
pub fn skipped(what: &str) {
    let line = format!("skipped {what}: set SCHULER_DATA to the folder of recorded logs\n");
    let _ = std::io::stderr().write_all(line.as_bytes());
}
