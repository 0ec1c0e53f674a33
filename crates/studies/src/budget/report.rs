//! Tables and remarks of a budget.

use schuler_imu::{Component, Input, Instrument, Truth};
use schuler_strapdown::{Vertical, filter::chi_square};

use super::agreement::Agreement;
use super::radius::{horizontal, radius, space, spherical};
use super::scene::Scene;
use super::source::{self, Nine};
use super::{BELIEVED, Contribution, TOTAL, Way};
use crate::record::{Cell, Table, columns};

/// Columns of the summary: one standard deviation of each source at the end.
const SUMMARY: [&str; 8] =
    ["source", "north_m", "east_m", "horizontal_m", "share_percent", "cep_m", "r95_m", "heading_arcmin"];

/// What it has besides where the vertical channel is not held.
const IN_SPACE: [&str; 3] = ["down_m", "sep_m", "spherical_r95_m"];

/// Everything that every way says.
pub fn table(scene: &Scene, contributions: &[Contribution]) -> Table {
    let mut table = Table::new("budget", &columns::BUDGET, &["source", "way"]);
    let total = total(contributions);
    for c in contributions {
        for said in &c.said {
            for (k, p) in said.p.iter().enumerate() {
                let row = said.first + k;
                let plane = horizontal(p);
                let mut cells: Vec<Cell> =
                    vec![scene.time(scene.rows[row]).into(), c.name.as_str().into(), said.way.name().into()];
                cells.extend((0..9).map(|k| Cell::from(sigma(p, k))));
                let size = plane.trace().max(0.0).sqrt();
                let shares = [share(p, &total[row]), heading_share(p, &total[row])];
                let radii = [0.5, 0.95].map(|p| radius(&plane, p));
                let in_space = if scene.vertical == Vertical::Held {
                    radii
                } else {
                    [0.5, 0.95].map(|probability| spherical(&space(p), probability))
                };
                cells.extend([size].map(Cell::from));
                cells.extend(radii.iter().chain(&in_space).chain(&shares).map(|x| Cell::from(*x)));
                table.push(&cells);
            }
        }
    }
    table
}

/// The end of the budget, the largest first, and what a filter believes of it.
pub fn summary(scene: &Scene, contributions: &[Contribution]) -> Table {
    let held = scene.vertical == Vertical::Held;
    let names = if held { SUMMARY.to_vec() } else { [&SUMMARY[..], &IN_SPACE].concat() };
    let mut table = Table::new("summary", &names, &["source"]);
    let total = total(contributions);
    let Some(last) = total.last() else { return table };
    let end = |c: &Contribution, way| c.of(way).and_then(|p| p.last().copied());
    let mut order: Vec<(&str, Nine)> =
        contributions.iter().filter_map(|c| Some((c.name.as_str(), end(c, Way::Covariance)?))).collect();
    order.sort_by(|(_, a), (_, b)| horizontal(b).trace().total_cmp(&horizontal(a).trace()));
    order.extend(contributions.iter().filter_map(|c| Some((BELIEVED, end(c, Way::Sigma)?))));
    for (name, p) in order {
        let plane = horizontal(&p);
        let mut cells: Vec<Cell> = vec![
            name.into(),
            sigma(&p, 0).into(),
            sigma(&p, 1).into(),
            plane.trace().max(0.0).sqrt().into(),
            (100.0 * share(&p, last)).into(),
            radius(&plane, 0.5).into(),
            radius(&plane, 0.95).into(),
            (sigma(&p, 8).to_degrees() * 60.0).into(),
        ];
        if !held {
            let in_space = [0.5, 0.95].map(|probability| spherical(&space(&p), probability));
            cells.extend([sigma(&p, 2), in_space[0], in_space[1]].map(Cell::from));
        }
        table.push(&cells);
    }
    table
}

/// What a reader of the numbers must know.
pub fn notes(scene: &Scene, contributions: &[Contribution], agreement: Option<&Agreement>) -> Vec<String> {
    let mut notes = vec![
        "Sources are independent of each other: variances sum to the total; a fixed value counts as one standard deviation of its size".into(),
        "cep_m and r95_m are the radii that hold 50 % and 95 % of plane normal errors of that covariance, sep_m and spherical_r95_m the same in space; horizontal_m is the root of the sum of both variances".into(),
    ];
    if scene.study.alignment > 0 {
        notes.push(format!(
            "Tilt and heading at t = 0 are what each source did to an alignment at rest of {} s before (level by the specific force, north by the angular rate), so that they hang together with what it does after",
            scene.time(scene.study.alignment)
        ));
    }
    notes.extend(remarks(scene));
    let believed = contributions.iter().find_map(|c| c.of(Way::Sigma)).and_then(|p| p.last());
    if let (Some(believed), Some(truth)) = (believed, total(contributions).last()) {
        let size = |p: &Nine| horizontal(p).trace().max(0.0).sqrt();
        notes.push(format!(
            "The filter takes its horizontal error at the end to be {:.4} m, its true standard deviation is {:.4} m ({:.3} times as much); heading {:.4} and {:.4} arcmin",
            size(believed),
            size(truth),
            size(truth) / size(believed),
            sigma(believed, 8).to_degrees() * 60.0,
            sigma(truth, 8).to_degrees() * 60.0,
        ));
    }
    notes.extend(agreement.map(Agreement::note));
    notes
}

/// What a filter, or the covariance through it, does not know of.
fn remarks(scene: &Scene) -> Vec<String> {
    let Some(filter) = &scene.study.filter else { return Vec::new() };
    let mut remarks = Vec::new();
    let mut blind: Vec<String> =
        filter.spec.components().filter(blind).map(|c| c.source().name().to_string()).collect();
    blind.dedup();
    if !blind.is_empty() {
        remarks.push(format!(
            "The filter sees increments, neither temperature nor vibration nor angular acceleration: what it knows of {} does nothing",
            blind.join(", ")
        ));
    }
    let mut rounded: Vec<String> = filter
        .spec
        .components()
        .filter(|c| c.evolution().kind.name() == source::ROUNDING)
        .map(|c| c.source().name().to_string())
        .collect();
    rounded.dedup();
    if !rounded.is_empty() {
        remarks.push(format!(
            "The filter has no states for rounding: it takes {} to be nothing",
            rounded.join(", ")
        ));
    }
    let antenna = filter.aiding.velocity.as_ref().is_some_and(|aid| aid.lever_arm != [0.0; 3]);
    let white =
        |c: &Component| c.instrument() == Instrument::Gyro && c.evolution().linear_model().white > 0.0;
    if antenna && scene.study.imu.spec.components().any(|c| white(&c)) {
        remarks.push(
            "White noise of the gyros in the very rate by which the velocity is carried to the antenna is left out by covariance; runs have it"
                .into(),
        );
    }
    remarks
}

/// Whether a term asks for more than increments.
fn blind(component: &Component) -> bool {
    let seen = Truth::rates([0.1, -0.2, 0.3], [1.0, -2.0, -9.0]);
    let more = seen.with_temperature(250.0, 1.0).with_omega_dot([1.0, 2.0, 3.0]).with_vibration([1.0; 3]);
    let column = |seen: &Truth| {
        let input = Input::new(component.instrument(), seen, 1.0, Truth::TEMPERATURE);
        component.term().regressor(&input).columns()[component.coefficient()]
    };
    column(&seen) != column(&more)
}

/// 99 % band of the mean square of `runs` normals of variance one. Beyond a thousand by the cube-root approximation of
/// Wilson and Hilferty (Proc. Natl. Acad. Sci. 17, 1931), which is then right to 1e-5.
pub fn band(runs: u64) -> [f64; 2] {
    /// Normal quantile of 99.5 %.
    const Z: f64 = 2.575_829_303_548_901;
    if runs <= 1000 {
        return [0.995, 0.005].map(|p| chi_square::quantile(p, runs as usize) / runs as f64);
    }
    let v = 2.0 / (9.0 * runs as f64);
    [-Z, Z].map(|z| (1.0 - v + z * v.sqrt()).powi(3))
}

/// The total by covariance, which every budget has.
pub fn total(contributions: &[Contribution]) -> &[Nine] {
    let total = contributions.iter().find(|c| c.name == TOTAL);
    total.and_then(|c| c.of(Way::Covariance)).unwrap_or_default()
}

/// Part of the horizontal variance; zero at the start of a budget without initial position errors.
pub fn share(p: &Nine, total: &Nine) -> f64 {
    let whole = horizontal(total).trace();
    if whole > 0.0 { horizontal(p).trace().max(0.0) / whole } else { 0.0 }
}

/// Part of the heading variance; zero where there is none.
pub fn heading_share(p: &Nine, total: &Nine) -> f64 {
    let whole = total[(8, 8)];
    if whole > 0.0 { p[(8, 8)].max(0.0) / whole } else { 0.0 }
}

/// Standard deviation of error `k`; rounding below zero is zero.
pub fn sigma(p: &Nine, k: usize) -> f64 {
    p[(k, k)].max(0.0).sqrt()
}
