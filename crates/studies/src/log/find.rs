//! Where a log lies.

use std::path::{Path, PathBuf};

use super::LogSpec;
use crate::{Diagnostic, Error};

/// The file of a log: in the data folder (`--data` or `SCHULER_DATA`), then beside the scenario, unless its path is
/// absolute.
///
/// # Errors
/// [`Error::Input`] that names the places looked at, where the data come from and how to give their folder.
pub fn find(spec: &LogSpec, data: Option<&Path>, scenario: &Path) -> Result<PathBuf, Error> {
    find_named(&spec.file, "log.file", &spec.source, data, scenario)
}

/// The file `name` of the scenario's key `key`, looked up as that of a log; `source` says where it comes from.
///
/// # Errors
/// As [`find`].
pub fn find_named(
    name: &str,
    key: &str,
    source: &str,
    data: Option<&Path>,
    scenario: &Path,
) -> Result<PathBuf, Error> {
    let beside = scenario.parent().unwrap_or(Path::new(""));
    let mut places: Vec<PathBuf> = data.into_iter().map(|folder| folder.join(name)).collect();
    places.push(beside.join(name));
    // An absolute path replaces the folder it is joined to.
    places.dedup();
    if let Some(found) = places.iter().find(|place| place.is_file()) {
        return Ok(found.clone());
    }
    let looked: Vec<String> = places.iter().map(|place| place.display().to_string()).collect();
    let mut help = String::new();
    if !source.is_empty() {
        help = format!("where it comes from: {}; then ", source.trim());
    }
    help += "give its folder with `--data DIR` or the environment variable SCHULER_DATA";
    Err(Diagnostic::new(scenario, format!("the log {name} is not there"))
        .path(key)
        .found(format!("no such file: {}", looked.join(", ")))
        .help(help)
        .into())
}
