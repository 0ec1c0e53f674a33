//! What a reader sees of a budget: pictures, the order of the summary, the first remark.

use super::super::figures::{Beginning, figures};
use super::super::subject::subjects;
use super::*;
use crate::figure::{Colour, Data, Figure, Series};
use crate::record::Record;
use crate::scenario::Required;
use crate::{Context, Scenario};

fn shipped(text: &str) -> Record {
    let overrides = ["budget.runs=24".into()];
    let scenario = Scenario::load("a.yaml", text, &overrides).unwrap_or_else(|e| panic!("{e}"));
    crate::run(&scenario, &Context::silent()).unwrap_or_else(|e| panic!("{e}"))
}

fn wrong_filter() -> Record {
    shipped(include_str!("../../../../../configs/budget_wrong_filter.yaml"))
}

fn figure<'a>(record: &'a Record, name: &str) -> &'a Figure {
    let found = record.figures.iter().find(|(known, _)| known == name);
    &found.unwrap_or_else(|| panic!("no picture {name}")).1
}

fn end(series: &Series) -> f64 {
    match &series.data {
        Data::Points(points) => points[points.len() - 1][1],
        Data::Band(band) => band[band.len() - 1][2],
    }
}

/// The example's point is heading: 1.159 arcmin believed, 4.202 true (tests/data/budget/alignment.py, `wrong list`), and runs.
#[test]
fn an_alignment_is_about_heading() {
    let record = wrong_filter();
    let names: Vec<&str> = record.figures.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["shares_heading", "sigma_heading", "tornado_heading"]);
    let sigma = figure(&record, "sigma_heading");
    assert_eq!(sigma.panels[0].y.label, "heading (arcmin)");
    let ends = |label: &str| -> Vec<f64> {
        sigma.panels[0].series.iter().filter(|s| s.label == label).map(end).collect()
    };
    assert!((ends("total")[0] - 4.20234).abs() < 5e-3, "{:?}", ends("total"));
    assert!((ends("total, as the filter believes")[0] - 1.15954).abs() < 3e-3);
    let runs = ends("total, 24 runs (99 %)");
    // 24 runs: chi-square over 24, 99 %, its root within 41 %.
    assert!(runs.len() == 2 && (runs[1] / 4.20234 - 1.0).abs() < 0.41 && runs[0] > runs[1], "{runs:?}");
    let rows = &figure(&record, "tornado_heading").panels[0].y.names;
    assert_eq!(rows[..3], ["total", "total, as the filter believes", "total, 24 runs (99 %)"]);
    // 3.23108 and 2.65982 of 4.20234: 59.12 % and 40.06 % of the variance.
    assert!(rows[3].starts_with("gyro.bias.constant.y, 59.1"), "{rows:?}");
    assert!(rows[4].starts_with("gyro.bias.white.y, 40.0"), "{rows:?}");
    assert!(rows.last().unwrap().contains("others, "), "{rows:?}");
    let text = record.summary_text();
    let lines: Vec<&str> = text.lines().skip(3).take(4).collect();
    assert!(lines[0].starts_with("source") && lines[0].contains(" heading_arcmin  heading_share_percent"));
    assert!(lines[1].starts_with("total ") && lines[2].starts_with("gyro.bias.constant.y "), "{text}");
    let note = &record.notes[0];
    assert!(note.starts_with("The filter takes its error of heading at the end to be 1.15"), "{note}");
    assert!(note.contains("it is 4.20") && note.contains("by 24 runs"), "{note}");
}

/// A source has one colour wherever it is drawn, and no two of a picture have the same.
#[test]
fn a_source_has_one_colour() {
    let study = budget(45.0, 0.2, 3600.0, mixed(1.0), initial(1.0));
    let scene = Scene::new(&study, Some(300.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    let wanted = [Required::Horizontal, Required::Heading, Required::Tilt];
    let beginning = Beginning { scene: &scene, contributions: &all };
    let drawn = figures("t", &wanted, &scene, &all, &beginning);
    assert_eq!(drawn.len(), 9);
    let mut known: Vec<(String, Colour)> = Vec::new();
    for (name, figure) in &drawn {
        let mut here: Vec<(Colour, String)> = Vec::new();
        for s in figure.panels.iter().flat_map(|p| &p.series).filter(|s| !s.label.is_empty()) {
            let colour = s.colour.unwrap();
            match known.iter().find(|(label, _)| *label == s.label) {
                Some((_, before)) => assert_eq!(*before, colour, "{} in {name}", s.label),
                None => known.push((s.label.clone(), colour)),
            }
            let taken = here.iter().find(|(c, label)| *c == colour && *label != s.label);
            assert!(taken.is_none(), "{} and {taken:?} in {name}", s.label);
            here.push((colour, s.label.clone()));
        }
    }
    assert!(known.len() > 10);
}

/// At rest by its measurements an alignment is about heading; a requirement goes before; a position that moves is there by itself.
#[test]
fn what_a_budget_is_about() {
    let horizontal = budget(45.0, 0.2, 600.0, mixed(1.0), initial(1.0));
    let of = |study: &Budget| {
        let scene = Scene::new(study, Some(300.0));
        subjects(&scene, &[], &linear(&scene, &sources(study)).unwrap())
    };
    assert_eq!(of(&horizontal), [Required::Horizontal]);
    let limits = vec![(Required::Tilt, 1e-3), (Required::Down, 1.0), (Required::Horizontal, 1.0)];
    let requirement = Some(scenario::Requirement { at: 600.0, probability: 0.5, limits });
    // The height is held: there is nothing to draw.
    assert_eq!(of(&Budget { requirement, ..horizontal }), [Required::Tilt, Required::Horizontal]);
}

/// Two initial errors that do the same are drawn in other dashes.
#[test]
fn curves_upon_each_other_are_seen() {
    let study = budget(45.0, 0.2, 3600.0, Spec::new(), initial(1.0)[5..].to_vec());
    let scene = Scene::new(&study, Some(300.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    let beginning = Beginning { scene: &scene, contributions: &all };
    let drawn = figures("t", &[Required::Horizontal], &scene, &all, &beginning);
    let [total, n, e] = &drawn[1].1.panels[0].series[..] else { panic!() };
    assert_eq!(total.label, "total");
    assert_ne!(n.style, e.style);
}

/// Budgets that would have no end or no meaning say so.
#[test]
fn impossible_budgets_are_refused() {
    let text = include_str!("../../../../../configs/budget_static.yaml");
    let said = |set: &str| {
        let made = Scenario::load("a.yaml", text, &[set.into()]);
        made.and_then(|scenario| crate::run(&scenario, &Context::silent())).expect_err(set).to_string()
    };
    let pole = said("start.position.lat=90 deg");
    assert!(pole.contains("neither north nor heading at a pole"), "{pole}");
    let rows = said("duration=100000 h");
    assert!(rows.contains("more rows than a budget can keep"), "{rows}");
    let nothing = said("budget.requirement.probability=0 %");
    assert!(nothing.contains("a radius that holds nothing") && nothing.contains("95 %"), "{nothing}");
}
