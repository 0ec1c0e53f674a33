//! The table of a drift study: size of each source's effect, and how far the ways agree.

use schuler_strapdown::NavError;

use super::scene::Scene;
use super::{Curves, Way};
use crate::record::{Cell, Table, columns};

/// Below these (m, m/s, rad) a response is the rounding of a day's run and no effect of the source.
const ROUNDING: [f64; 3] = [1e-4, 1e-7, 1e-11];

/// Columns of the summary of a drift study. The last four are relative: `nonlinear_linear` is the
/// second-order residue, `half_linear` and `linear_exact` what is left between ways that should agree,
/// `single_axis_exact` by how much the textbook formula fails in horizontal position at the end.
/// For random sources `linear_exact` is empty and `in_sigmas` says how many standard deviations the
/// sample's horizontal position reaches at the end.
pub const COLUMNS: [&str; 12] = [
    "source",
    "final_n_m",
    "final_e_m",
    "final_d_m",
    "largest_position_m",
    "largest_velocity_mps",
    "largest_attitude_rad",
    "nonlinear_linear",
    "half_linear",
    "linear_exact",
    "single_axis_exact",
    "in_sigmas",
];

/// One row for each case.
pub fn table(curves: &[Curves]) -> Table {
    let mut table = Table::new("summary", &COLUMNS, &["source"]);
    for c in curves {
        let nonlinear = c.of(Way::Nonlinear).unwrap_or_default();
        let linear = c.of(Way::Linear).unwrap_or_default();
        let last = nonlinear.last().copied().unwrap_or_default();
        let pair = |way: Way, other: Option<&[NavError]>| match (c.of(way), other) {
            (Some(a), Some(b)) => disagreement(a, b),
            _ => f64::NAN,
        };
        let exact = c.of(Way::Exact);
        let (linear_exact, textbook, sigmas) = match (c.sigma, exact) {
            (false, Some(exact)) => {
                // With something random in it, the linear run is one sample and the closed form the known part.
                let known = if c.random { f64::NAN } else { disagreement(linear, exact) };
                (known, failure(c.of(Way::SingleAxis), exact), f64::NAN)
            }
            (true, Some(sigma)) => {
                (f64::NAN, failure(c.of(Way::SingleAxis), sigma), in_sigmas(nonlinear, sigma))
            }
            (_, None) => (f64::NAN, f64::NAN, f64::NAN),
        };
        table.push(&[
            c.case.name.as_str().into(),
            last.dr[0].into(),
            last.dr[1].into(),
            last.dr[2].into(),
            largest(nonlinear, 0).into(),
            largest(nonlinear, 1).into(),
            largest(nonlinear, 2).into(),
            pair(Way::Nonlinear, Some(linear)).into(),
            pair(Way::HalfDifference, Some(linear)).into(),
            linear_exact.into(),
            textbook.into(),
            sigmas.into(),
        ]);
    }
    table
}

/// Final and largest value of each of the nine errors of each source, non-linear run (`extremes.csv`).
pub fn extremes(curves: &[Curves]) -> Table {
    let names: Vec<String> = ["final", "largest"]
        .iter()
        .flat_map(|which| columns::ERRORS[3..].iter().map(move |column| format!("{which}_{column}")))
        .collect();
    let names: Vec<&str> = std::iter::once("source").chain(names.iter().map(String::as_str)).collect();
    let mut table = Table::new("extremes", &names, &["source"]);
    for c in curves {
        let rows: Vec<[f64; 9]> =
            c.of(Way::Nonlinear).unwrap_or_default().iter().map(NavError::as_array).collect();
        let last = rows.last().copied().unwrap_or_default();
        let largest = (0..9).map(|k| rows.iter().map(|e| e[k].abs()).fold(0.0, f64::max));
        let mut row = vec![c.case.name.as_str().into()];
        row.extend(last.into_iter().chain(largest).map(Cell::from));
        table.push(&row);
    }
    table
}

/// What a reader of the table must know.
pub fn notes(scene: &Scene, curves: &[Curves]) -> Vec<String> {
    let mut notes = Vec::new();
    let alone: Vec<&Curves> = curves.iter().filter(|c| c.case.name != "all").collect();
    if let Some(all) = curves.iter().find(|c| c.case.name == "all").and_then(|c| c.of(Way::Nonlinear)) {
        let mut worst = 0.0f64;
        for (k, together) in all.iter().enumerate() {
            let mut rest = together.dr;
            for c in &alone {
                rest -= c.of(Way::Nonlinear).unwrap_or_default()[k].dr;
            }
            worst = worst.max(rest.norm());
        }
        notes.push(format!(
            "All together differ from the sum of each alone by at most {worst:.3} m in position: what is left is of second order in the errors"
        ));
    }
    let silent = alone.iter().filter(|c| is_silent(c.of(Way::Nonlinear).unwrap_or_default())).count();
    if silent > 0 {
        notes.push(format!(
            "{silent} sources do nothing at this attitude with this vertical channel: what their runs show is the rounding of the mechanization"
        ));
    }
    if curves.iter().any(|c| c.random) {
        notes.push(
            "Random sources: one sample of this seed; their `exact` and `single_axis` are standard deviations, those of all together the known part"
                .into(),
        );
    }
    if scene.vertical != schuler_strapdown::Vertical::Held {
        notes.push("The closed form holds for a held vertical channel only and is left out here".into());
    }
    notes
}

/// Size of the error of one kind (position, velocity, attitude).
fn size(e: &NavError, kind: usize) -> f64 {
    [e.dr.norm(), e.dv.norm(), e.phi.norm()][kind]
}

fn largest(rows: &[NavError], kind: usize) -> f64 {
    rows.iter().map(|e| size(e, kind)).fold(0.0, f64::max)
}

/// Whether a run stays within rounding: its source does nothing here.
pub fn is_silent(rows: &[NavError]) -> bool {
    (0..3).all(|kind| largest(rows, kind) < ROUNDING[kind])
}

/// Largest difference of two ways over the largest value of the second, the worst of position, velocity and
/// attitude; NaN where nothing moves beyond rounding.
fn disagreement(a: &[NavError], b: &[NavError]) -> f64 {
    let difference =
        |x: &NavError, y: &NavError| NavError { dr: x.dr - y.dr, dv: x.dv - y.dv, phi: x.phi - y.phi };
    let apart: Vec<NavError> = a.iter().zip(b).map(|(x, y)| difference(x, y)).collect();
    let relative = |kind: usize| {
        let (top, bottom) = (largest(&apart, kind), largest(b, kind));
        if bottom > ROUNDING[kind] || top > ROUNDING[kind] { top / bottom } else { f64::NAN }
    };
    (0..3).map(relative).fold(f64::NAN, f64::max)
}

/// |formula - exact| of the horizontal position at the end, over the largest exact one.
fn failure(formula: Option<&[NavError]>, exact: &[NavError]) -> f64 {
    let (Some(f), Some(e)) = (formula.and_then(<[_]>::last), exact.last()) else { return f64::NAN };
    let radius = |e: &NavError| e.dr[0].hypot(e.dr[1]);
    let scale = exact.iter().map(radius).fold(0.0, f64::max);
    let apart = (f.dr[0] - e.dr[0]).hypot(f.dr[1] - e.dr[1]);
    if scale > ROUNDING[0] || apart > ROUNDING[0] { apart / scale } else { f64::NAN }
}

fn in_sigmas(sample: &[NavError], sigma: &[NavError]) -> f64 {
    match (sample.last(), sigma.last()) {
        (Some(x), Some(s)) => (x.dr[0] / s.dr[0]).hypot(x.dr[1] / s.dr[1]),
        _ => f64::NAN,
    }
}
