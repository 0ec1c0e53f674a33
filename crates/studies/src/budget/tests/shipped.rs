//! The budgets that are shipped.

use super::super::agreement::Agreement;
use super::*;
use crate::{Scenario, scenario::Study};

/// Two ways that share nothing but the transition of the nine errors: the transitions that the covariance gathers and the
/// answers of the columns. A body that turns by degrees in a sample is no exception: turned in 20 s at 10 Hz, the north
/// accelerometer's part of the heading was off by a tenth of itself.
#[test]
fn columns_are_the_covariance_in_every_shipped_budget() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../configs");
    let mut judged = Vec::new();
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if !name.starts_with("budget_") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let scenario = Scenario::load("a.yaml", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
        let asked = scenario.expect.iter().find(|e| e.quantity == "columns_off_ratio");
        let Study::Budget(mut study) = scenario.study else { panic!("{name}") };
        study.runs = 0;
        let scene = Scene::new(&study, scenario.output.every);
        let sources = sources(&study);
        let all = linear(&scene, &sources).unwrap();
        let off = Agreement::new(&scene, &sources, &all, 0.0).unwrap().off();
        judged.push((name, off, asked.map(|e| e.tolerance)));
    }
    println!("{judged:?}");
    assert!(judged.len() >= 9);
    for (name, off, asked) in &judged {
        match asked {
            Some(tolerance) => assert!(*tolerance <= 3.2e-5 && off <= tolerance, "{name}: {off:e}"),
            // Noise alone has no columns.
            None => assert!(off.is_nan(), "{name}: {off:e}"),
        }
    }
}
