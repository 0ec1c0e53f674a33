//! Tables and remarks of a budget.

use schuler_imu::{Component, Input, Instrument, Truth};
use schuler_strapdown::{Vertical, filter::chi_square};

use super::agreement::Agreement;
use super::radius::{horizontal, radius, space, spherical};
use super::scene::Scene;
use super::source::{self, Nine};
use super::subject::{share, size, unit, words, written};
use super::{BELIEVED, Contribution, TOTAL, Way};
use crate::record::{Cell, Table, columns};
use crate::scenario::Required;

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
                let shares = [Required::Horizontal, Required::Heading].map(|of| share(of, p, &total[row]));
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

/// A column of the summary and its number.
type Column = (&'static str, fn(&Nine, &Nine) -> f64);

/// Columns of the summary: one standard deviation of each source at the end, and its share of the variance of `total`. What leads
/// stands first.
fn columns_of(lead: Required, held: bool) -> Vec<Column> {
    let heading: [Column; 2] = [
        ("heading_arcmin", |p, _| size(Required::Heading, p) * unit(Required::Heading).per_si),
        ("heading_share_percent", |p, total| 100.0 * share(Required::Heading, p, total)),
    ];
    let position: [Column; 6] = [
        ("horizontal_m", |p, _| size(Required::Horizontal, p)),
        ("horizontal_share_percent", |p, total| 100.0 * share(Required::Horizontal, p, total)),
        ("north_m", |p, _| sigma(p, 0)),
        ("east_m", |p, _| sigma(p, 1)),
        ("cep_m", |p, _| radius(&horizontal(p), 0.5)),
        ("r95_m", |p, _| radius(&horizontal(p), 0.95)),
    ];
    let in_space: [Column; 3] = [
        ("down_m", |p, _| sigma(p, 2)),
        ("sep_m", |p, _| spherical(&space(p), 0.5)),
        ("spherical_r95_m", |p, _| spherical(&space(p), 0.95)),
    ];
    let in_space = if held { &in_space[..0] } else { &in_space[..] };
    let first: &[Column] = match lead {
        Required::Heading => return [&heading[..], &position, in_space].concat(),
        Required::Horizontal => &[],
        Required::Down => &[("down_share_percent", |p, total| 100.0 * share(Required::Down, p, total))],
        Required::Velocity => &[
            ("velocity_mps", |p, _| size(Required::Velocity, p)),
            ("velocity_share_percent", |p, total| 100.0 * share(Required::Velocity, p, total)),
        ],
        Required::Tilt => &[
            ("tilt_arcmin", |p, _| size(Required::Tilt, p) * unit(Required::Tilt).per_si),
            ("tilt_share_percent", |p, total| 100.0 * share(Required::Tilt, p, total)),
        ],
    };
    [first, &position, &heading, in_space].concat()
}

/// The end of the budget, the largest of what leads first, and what a filter believes of it.
pub fn summary(scene: &Scene, contributions: &[Contribution], lead: Required) -> Table {
    let columns = columns_of(lead, scene.vertical == Vertical::Held);
    let names: Vec<&str> = ["source"].into_iter().chain(columns.iter().map(|(name, _)| *name)).collect();
    let mut table = Table::new("summary", &names, &["source"]);
    let total = total(contributions);
    let Some(last) = total.last() else { return table };
    let end = |c: &Contribution, way| c.of(way).and_then(|p| p.last().copied());
    let mut order: Vec<(&str, Nine)> =
        contributions.iter().filter_map(|c| Some((c.name.as_str(), end(c, Way::Covariance)?))).collect();
    order.sort_by(|(_, a), (_, b)| size(lead, b).total_cmp(&size(lead, a)));
    order.extend(contributions.iter().filter_map(|c| Some((BELIEVED, end(c, Way::Sigma)?))));
    for (name, p) in order {
        let numbers = columns.iter().map(|(_, number)| Cell::from(number(&p, last)));
        let cells: Vec<Cell> = [Cell::from(name)].into_iter().chain(numbers).collect();
        table.push(&cells);
    }
    table
}

/// What a reader of the numbers must know.
pub fn notes(
    scene: &Scene,
    contributions: &[Contribution],
    agreement: Option<&Agreement>,
    subjects: &[Required],
) -> Vec<String> {
    let mut notes: Vec<String> = belief(scene, contributions, subjects).into_iter().collect();
    notes.extend([
        "Sources are independent of each other: variances sum to the total; a fixed value counts as one standard deviation of its size".into(),
        "cep_m and r95_m are the radii that hold 50 % and 95 % of plane normal errors of that covariance, sep_m and spherical_r95_m the same in space; horizontal_m is the root of the sum of both variances".into(),
    ]);
    if scene.study.alignment > 0 {
        notes.push(format!(
            "Tilt and heading at t = 0 are what each source did to an alignment at rest of {} s before (level by the specific force, north by the angular rate), so that they hang together with what it does after",
            scene.time(scene.study.alignment)
        ));
    }
    notes.extend(remarks(scene));
    notes.extend(agreement.map(Agreement::notes).unwrap_or_default());
    notes
}

/// What a filter believes at the end beside what is true and what runs find, the errors that lead first.
fn belief(scene: &Scene, contributions: &[Contribution], subjects: &[Required]) -> Option<String> {
    let end = |way| contributions.iter().filter(|c| c.name == TOTAL).find_map(|c| c.of(way)?.last());
    let (believed, truth, runs) = (end(Way::Sigma)?, end(Way::Covariance)?, end(Way::MonteCarlo));
    let lead = *subjects.first()?;
    let usual = [Required::Heading, Required::Horizontal];
    let rest = subjects[1..].iter().chain(usual.iter().filter(|of| !subjects.contains(of)));
    let said = |of: Required| {
        let found = runs.map_or(String::new(), |p| {
            format!(", {} by {} runs", written(of, size(of, p)), scene.study.runs)
        });
        format!(
            "to be {}, it is {} ({:.3} times as much){found}",
            written(of, size(of, believed)),
            written(of, size(of, truth)),
            size(of, truth) / size(of, believed),
        )
    };
    let others: String = rest.map(|of| format!("; {} {}", words(*of), said(*of))).collect();
    Some(format!("The filter takes its error of {} at the end {}{others} (1 σ)", words(lead), said(lead)))
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

/// Standard deviation of error `k`; rounding below zero is zero.
pub fn sigma(p: &Nine, k: usize) -> f64 {
    p[(k, k)].max(0.0).sqrt()
}
