//! Pictures of a Monte Carlo.

use super::prediction::Predicted;
use super::scene::Scene;
use super::statistics::{HORIZONTAL, Statistics};
use crate::figure::{Axis, Colour, Figure, Panel, Quantity, Series, Style};
use crate::scenario::RunFigure;

/// Single runs behind the bands.
const CLOUD: Colour = Colour(0xc4, 0xc4, 0xc4);

/// The cloud of runs with three standard deviations as predicted and as found, radii that hold shares of the runs, and NEES.
pub fn figures(
    title: &str,
    scene: &Scene,
    statistics: &Statistics,
    predicted: Option<&[Predicted]>,
) -> Vec<(String, Figure)> {
    let conditions = format!(
        "{} runs, {}, latitude {:.4}°, {} Hz",
        statistics.runs,
        scene.study.motion.words(),
        scene.study.start.position.lat.to_degrees(),
        scene.study.imu.rate
    );
    let figure =
        |what: &str| Figure::new(format!("{title}: {what}"), Axis::time("time")).subtitle(conditions.clone());
    let mut all = Vec::new();
    for (first, stem, what, quantity, names) in [
        (0, "position", "position error", Quantity::Length, ["north", "east", "down"]),
        (3, "velocity", "velocity error", Quantity::Velocity, ["north", "east", "down"]),
        (6, "attitude", "attitude error", Quantity::Angle, ["north tilt", "east tilt", "heading"]),
    ] {
        let mut figure = figure(what);
        for (k, name) in names.iter().enumerate() {
            if let Some(panel) = cloud(scene, statistics, predicted, first + k, name, quantity) {
                figure = figure.panel(panel);
            }
        }
        if !figure.panels.is_empty() {
            all.push((stem.to_string(), figure));
        }
    }
    all.push((
        "horizontal".into(),
        figure("horizontal position error").panel(radii(scene, statistics, predicted)),
    ));
    if let Some(panel) = nees(scene, statistics) {
        all.push(("nees".into(), figure("normalized error squared").panel(panel)));
    }
    all
}

/// One error; `None` where it does not move.
fn cloud(
    scene: &Scene,
    statistics: &Statistics,
    predicted: Option<&[Predicted]>,
    k: usize,
    name: &str,
    quantity: Quantity,
) -> Option<Panel> {
    let sd = |row: usize| statistics.figure(row, k, RunFigure::Deviation).value;
    let rows = 0..scene.rows.len();
    let largest =
        rows.clone().map(|row| 3.0 * sd(row) + statistics.mean(row, k).value.abs()).fold(0.0, f64::max);
    if largest == 0.0 {
        return None;
    }
    let shown = quantity.shown(largest);
    let time = |row: usize| scene.time(scene.rows[row]);
    let mut panel = Panel::new(Axis::linear(format!("{name} ({})", shown.symbol)));
    let some = format!("{} of the runs", statistics.shown.len());
    for (run, errors) in statistics.shown.iter().enumerate() {
        let line = rows.clone().map(|row| [time(row), errors[row][k] * shown.per_si]);
        panel = panel.with(
            Series::line(if run == 0 { some.as_str() } else { "" }, line).style(Style::Line).colour(CLOUD),
        );
    }
    for (sign, first) in [(3.0, true), (-3.0, false)] {
        let label = |text: &str| if first { text.to_string() } else { String::new() };
        let found = rows
            .clone()
            .map(|row| [time(row), (statistics.mean(row, k).value + sign * sd(row)) * shown.per_si]);
        panel = panel.with(
            Series::line(label("± 3 σ of the runs"), found).style(Style::Line).colour(Colour::palette(0)),
        );
        if let Some(p) = predicted {
            let line =
                rows.clone().map(|row| [time(row), (p[row].mean(k) + sign * p[row].sd(k)) * shown.per_si]);
            let line = Series::line(label("± 3 σ predicted"), line).style(Style::Dashed);
            panel = panel.with(line.colour(Colour::palette(1)));
        }
    }
    Some(panel)
}

fn radii(scene: &Scene, statistics: &Statistics, predicted: Option<&[Predicted]>) -> Panel {
    let rows = 0..scene.rows.len();
    let at = |row: usize, figure| statistics.figure(row, HORIZONTAL, figure);
    let q99 = RunFigure::Quantile(0.99);
    // Few runs have no upper end for the outer ones.
    let finite = |x: f64, or: f64| if x.is_finite() { x } else { or };
    let largest = rows.clone().map(|row| finite(at(row, q99).high, at(row, q99).value)).fold(0.0, f64::max);
    let shown = Quantity::Length.shown(largest);
    let mut panel = Panel::new(Axis::linear(format!("horizontal distance ({})", shown.symbol)));
    let time = |row: usize| scene.time(scene.rows[row]);
    let shares = [(0.5, "50 % of the runs"), (0.9, "90 %"), (0.95, "95 %"), (0.99, "99 %")];
    // First what the colours mean, then what the strokes do.
    for (k, (share, label)) in shares.into_iter().enumerate() {
        let line =
            rows.clone().map(|row| [time(row), at(row, RunFigure::Quantile(share)).value * shown.per_si]);
        panel = panel.with(Series::line(label, line).colour(Colour::palette(k)));
    }
    let mut named = false;
    for (k, (share, _)) in shares.into_iter().enumerate() {
        let all: Vec<_> = rows.clone().map(|row| (row, at(row, RunFigure::Quantile(share)))).collect();
        for end in [|e: &super::statistics::Estimate| e.low, |e: &super::statistics::Estimate| e.high] {
            if !all.iter().all(|(_, e)| end(e).is_finite()) {
                continue;
            }
            let line = all.iter().map(|(row, e)| [time(*row), end(e) * shown.per_si]);
            let label = if named { "" } else { "99 % confidence" };
            panel = panel.with(Series::line(label, line).style(Style::Dotted).colour(Colour::palette(k)));
            named = true;
        }
        if let Some(p) = predicted {
            let line = rows.clone().map(|row| [time(row), p[row].quantile(HORIZONTAL, share) * shown.per_si]);
            let label = if k == 0 { "predicted" } else { "" };
            panel = panel.with(Series::line(label, line).style(Style::Dashed).colour(Colour::palette(k)));
        }
    }
    panel
}

fn nees(scene: &Scene, statistics: &Statistics) -> Option<Panel> {
    let rows: Vec<_> = (0..scene.rows.len())
        .filter_map(|row| Some((scene.time(scene.rows[row]), statistics.nees(row)?.0)))
        .collect();
    if rows.is_empty() {
        return None;
    }
    let panel = Panel::new(Axis::linear("NEES a degree of freedom"))
        .with(Series::band("99 % band", rows.iter().map(|(t, e)| [*t, e.low, e.high])).colour(CLOUD))
        .with(Series::line("runs", rows.iter().map(|(t, e)| [*t, e.value])).colour(Colour::palette(0)));
    Some(panel)
}
