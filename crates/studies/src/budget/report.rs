//! Tables and remarks of a budget.

use schuler_strapdown::filter::chi_square;

use super::radius::{derivative, horizontal, may_grow, radius};
use super::scene::Scene;
use super::source::Nine;
use super::{Contribution, TOTAL, Way};
use crate::{
    record::{Cell, Table, columns},
    scenario::Requirement,
};

/// Columns of the summary: one standard deviation of each source at the end.
const SUMMARY: [&str; 8] =
    ["source", "north_m", "east_m", "horizontal_m", "share_percent", "cep_m", "r95_m", "heading_arcmin"];

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
                let share = share(p, &total[row]);
                cells.extend([size, radius(&plane, 0.5), radius(&plane, 0.95), share].map(Cell::from));
                table.push(&cells);
            }
        }
    }
    table
}

/// What binds: the radius of the required probability and how it answers to each source.
pub fn requirement(scene: &Scene, contributions: &[Contribution], r: &Requirement) -> Table {
    let mut table = Table::new("requirement", &columns::REQUIREMENT, &["source"]);
    let row = scene
        .rows
        .iter()
        .position(|&k| (scene.time(k) - r.at).abs() < 0.5 * scene.dt)
        .expect("invariant: the time of a valid requirement is that of a row");
    let whole = horizontal(&total(contributions)[row]);
    let reached = radius(&whole, r.probability);
    for c in contributions {
        let part = horizontal(&c.of(Way::Covariance).unwrap_or_default()[row]);
        let slope = derivative(&whole, &part, reached);
        let cells: [Cell; 6] = [
            r.at.into(),
            c.name.as_str().into(),
            radius(&part, r.probability).into(),
            slope.into(),
            (slope / reached).into(),
            may_grow(&whole, &part, r.probability, r.horizontal).into(),
        ];
        table.push(&cells);
    }
    table
}

/// The end of the budget, the largest first.
pub fn summary(contributions: &[Contribution]) -> Table {
    let mut table = Table::new("summary", &SUMMARY, &["source"]);
    let total = total(contributions);
    let Some(last) = total.last() else { return table };
    let mut order: Vec<(&Contribution, Nine)> =
        contributions.iter().filter_map(|c| Some((c, *c.of(Way::Covariance)?.last()?))).collect();
    order.sort_by(|(_, a), (_, b)| horizontal(b).trace().total_cmp(&horizontal(a).trace()));
    for (c, p) in order {
        let plane = horizontal(&p);
        table.push(&[
            c.name.as_str().into(),
            sigma(&p, 0).into(),
            sigma(&p, 1).into(),
            plane.trace().max(0.0).sqrt().into(),
            (100.0 * share(&p, last)).into(),
            radius(&plane, 0.5).into(),
            radius(&plane, 0.95).into(),
            (sigma(&p, 8).to_degrees() * 60.0).into(),
        ]);
    }
    table
}

/// What a reader of the numbers must know.
pub fn notes(scene: &Scene, contributions: &[Contribution]) -> Vec<String> {
    let mut notes = vec![
        "Sources are independent of each other: variances sum to the total; a fixed value counts as one standard deviation of its size".into(),
        "cep_m and r95_m are the radii that hold 50 % and 95 % of plane normal errors of that covariance; horizontal_m is the root of the sum of both variances".into(),
    ];
    let runs = scene.study.runs;
    if runs > 0 {
        let (mut all, mut outside) = (0, 0);
        let [low, high] = band(runs);
        for c in contributions {
            let (Some(theory), Some(found)) = (c.of(Way::Covariance), c.of(Way::MonteCarlo)) else {
                continue;
            };
            let (Some(p), Some(q)) = (theory.last(), found.last()) else { continue };
            for k in [0, 1, 3, 4, 6, 7, 8] {
                let ratio = q[(k, k)] / p[(k, k)];
                all += 1;
                outside += usize::from(!(low..=high).contains(&ratio));
            }
        }
        notes.push(format!(
            "Monte Carlo of {runs} runs: {outside} of {all} variances of the last row are outside their 99 % chi-square band [{low:.4}, {high:.4}] about the covariance"
        ));
    }
    if let Some(r) = &scene.study.requirement {
        let row = scene.rows.iter().position(|&k| (scene.time(k) - r.at).abs() < 0.5 * scene.dt);
        let reached = row.map(|row| radius(&horizontal(&total(contributions)[row]), r.probability));
        let reached = reached.unwrap_or(f64::NAN);
        notes.push(format!(
            "{:.4} % of the horizontal errors are within {reached:.1} m at {} s; required are {:.1} m: {}",
            100.0 * r.probability,
            r.at,
            r.horizontal,
            if reached <= r.horizontal { "met" } else { "not met" }
        ));
    }
    notes
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
    if whole > 0.0 { horizontal(p).trace() / whole } else { 0.0 }
}

/// Standard deviation of error `k`; rounding below zero is zero.
pub fn sigma(p: &Nine, k: usize) -> f64 {
    p[(k, k)].max(0.0).sqrt()
}
