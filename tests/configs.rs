//! Each scenario of `configs/` runs, and its `expect` holds. A new case is a new file.

use std::{
    fs,
    path::{Path, PathBuf},
};

use crate::recorded;
use schuler::studies::{
    Context, Scenario, Silent, run,
    scenario::{Origin, Study},
};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn every_config_runs_and_its_expect_holds() {
    let mut files: Vec<PathBuf> = fs::read_dir(root().join("configs"))
        .expect("configs")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.sort();
    let data = recorded::folder(root());
    let mut failures = String::new();
    for file in files.iter().filter(|file| file.extension().is_some_and(|e| e == "yaml")) {
        let name = file.strip_prefix(root()).unwrap_or(file).display();
        let scenario = match Scenario::from_file(file, &[]) {
            Ok(scenario) => scenario,
            Err(error) => {
                failures += &format!("{error}\n");
                continue;
            }
        };
        if scenario.expect.is_empty() {
            failures += &format!("{name} expects nothing\n");
        }
        let log = match &scenario.study {
            Study::Navigate(navigate) => Some(&navigate.log.file),
            Study::Aided(aided) => Some(&aided.log.file),
            Study::Allan(log) => Some(&log.file),
            Study::Align(align) => match &align.origin {
                Origin::Log { log, .. } => Some(&log.file),
                Origin::Simulated { .. } => None,
            },
            Study::Imu(_)
            | Study::Drift(_)
            | Study::Simulate(_)
            | Study::Budget(_)
            | Study::MonteCarlo(_) => None,
        };
        if data.is_none() && log.is_some_and(|log| !file.with_file_name(log).is_file()) {
            recorded::skipped(&name.to_string());
            continue;
        }
        match run(&scenario, &Context { data: data.clone(), progress: &Silent }) {
            Err(error) => failures += &format!("{name}: {error}\n"),
            Ok(record) => {
                for verdict in record.verdicts.iter().filter(|v| !v.holds) {
                    failures += &format!("{name}: {verdict:?}\n");
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

/// The scenarios that the README shows run, and what they expect holds.
#[test]
fn the_readmes_scenarios_run() {
    let readme = fs::read_to_string(root().join("README.md")).expect("README.md");
    let blocks: Vec<&str> =
        readme.split("```yaml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(blocks.len(), 2);
    for text in blocks {
        let scenario =
            Scenario::load(root().join("README.md"), text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let record = run(&scenario, &Context::silent()).unwrap_or_else(|error| panic!("{error}"));
        assert!(!record.verdicts.is_empty() && record.holds(), "{:?}", record.verdicts);
        assert!(record.notes.iter().all(|note| !note.contains("NOT CONSISTENT")), "{:?}", record.notes);
    }
}
