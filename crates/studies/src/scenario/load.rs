//! The way into a valid scenario.

use std::path::Path;

use super::{Scenario, de, document::Document, written};
use crate::Error;

impl Scenario {
    /// From YAML text. `file` is what messages call it, `overrides` are `key.path=value` in order.
    ///
    /// # Errors
    /// [`Error::Input`] with place, path, what was expected and an example.
    pub fn load(file: impl AsRef<Path>, text: &str, overrides: &[String]) -> Result<Self, Error> {
        let mut document = Document::parse(file.as_ref(), text)?;
        for setting in overrides {
            document.set(setting)?;
        }
        Scenario::try_from(&document)
    }

    /// From a file.
    ///
    /// # Errors
    /// As [`Scenario::load`]; [`Error::Read`] where the file cannot be read.
    pub fn from_file(file: impl AsRef<Path>, overrides: &[String]) -> Result<Self, Error> {
        let path = file.as_ref();
        let bytes = std::fs::read(path).map_err(|source| Error::Read { path: path.into(), source })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let line = 1 + error.as_bytes()[..error.utf8_error().valid_up_to()]
                .iter()
                .filter(|b| **b == b'\n')
                .count();
            crate::Diagnostic::new(path, "the file is no UTF-8 text").at(line as u64, 0)
        })?;
        Scenario::load(path, &text, overrides)
    }
}

impl TryFrom<&Document> for Scenario {
    type Error = Error;

    fn try_from(document: &Document) -> Result<Self, Error> {
        let written: written::Scenario = de::read(document)?;
        Ok(document.scenario(&written)?)
    }
}
