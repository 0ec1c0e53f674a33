//! What a study found: named columns with units, a summary, figures and verdicts, under one header.

mod csv;
mod folder;
mod lookup;
mod summary;
mod table;
#[cfg(test)]
mod tests;
mod verdict;

pub use folder::Folder;
pub(crate) use folder::MANIFEST;
pub(crate) use summary::number;
pub use table::{Cell, Column, Table, columns};

use serde::Serialize;

use crate::{Scenario, figure::Figure};

/// The result of a study, complete in memory; a [`Folder`] makes files of it.
#[derive(Clone, Debug)]
pub struct Record {
    /// From what and with what.
    pub header: Header,
    /// Curves and samples, one CSV file each (`errors`, `trajectory`, `imu`).
    pub tables: Vec<Table>,
    /// Pictures by the stem of their file.
    pub figures: Vec<(String, Figure)>,
    /// The table for the terminal and `summary.json`: few rows, one per source or axis.
    pub summary: Table,
    /// Remarks a reader of the numbers must know (a bound, a formula's limit), one sentence each.
    pub notes: Vec<String>,
    /// Other files, each with its name (`sources.yaml`).
    pub texts: Vec<(String, String)>,
    /// Each `expect` of the scenario with its verdict.
    pub verdicts: Vec<Verdict>,
}

/// From what, and with what, a record was made: enough to make it again.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Header {
    /// Version of Schuler.
    pub version: String,
    /// Title of the scenario.
    pub title: String,
    /// `imu`, `drift`, `navigate`, `allan` or `simulate`.
    pub study: String,
    /// BLAKE3 of the canonical form of the valid scenario, hexadecimal. Overrides are in it, comments are not.
    pub scenario_hash: String,
    /// Master seed of every random draw.
    pub seed: u64,
    /// Gravity model, where the study navigates or simulates.
    pub gravity: Option<String>,
    /// Vertical channel, where the study navigates.
    pub vertical: Option<String>,
    /// The command that was typed; empty when run as a library.
    pub command: String,
}

/// An `expect` of the scenario beside what the study found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// What was compared, in words: `dn_m of gyro.bias.constant.x, exact, at 24 h`.
    pub what: String,
    /// What the scenario expects, SI.
    pub expected: f64,
    /// How far the found value may be from it, SI.
    pub tolerance: f64,
    /// What the study found, SI; NaN where the record has no such row.
    pub found: f64,
    /// Why nothing was found, and what there is instead.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_found: Option<String>,
    /// Whether it holds.
    pub holds: bool,
}

impl Header {
    /// The header of a run of `scenario`; the command is added by whoever had one.
    pub fn of(scenario: &Scenario) -> Self {
        let mechanization = scenario.mechanization();
        Header {
            version: env!("CARGO_PKG_VERSION").into(),
            title: scenario.title.clone(),
            study: scenario.study.name().into(),
            scenario_hash: scenario.hash.clone(),
            seed: scenario.seed,
            gravity: scenario.gravity().map(|gravity| format!("{gravity:?}").to_lowercase()),
            vertical: mechanization.map(|m| m.vertical.name().into()),
            command: String::new(),
        }
    }
}

impl Record {
    /// A record of `scenario` without rows: the study adds its tables, [`crate::run`] the verdicts.
    pub fn new(scenario: &Scenario, summary: Table) -> Self {
        Record {
            header: Header::of(scenario),
            tables: Vec::new(),
            summary,
            notes: Vec::new(),
            figures: Vec::new(),
            texts: Vec::new(),
            verdicts: Vec::new(),
        }
    }
}
