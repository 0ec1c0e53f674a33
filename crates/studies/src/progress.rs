//! What a study tells and asks the one who started it.

use std::path::PathBuf;

/// Told how far a study is. Called from any thread, a few times a second at most.
pub trait Progress: Sync {
    /// A stretch of work begins: what it is and how many units it has.
    fn begin(&self, what: &str, units: u64);
    /// So many units more are done.
    fn advance(&self, units: u64);
}

/// Tells nobody.
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _what: &str, _units: u64) {}
    fn advance(&self, _units: u64) {}
}

/// What a run needs beside the scenario. Nothing here changes a number.
pub struct Context<'a> {
    /// Folder that recorded logs are looked up in (`--data` or `SCHULER_DATA`), if one was given.
    pub data: Option<PathBuf>,
    /// Who wants to know how far the study is.
    pub progress: &'a dyn Progress,
}

impl Context<'_> {
    /// No data folder, silent: for tests and for studies without recorded logs.
    pub const fn silent() -> Context<'static> {
        Context { data: None, progress: &Silent }
    }
}
