//! Pictures of a navigate study.

use schuler_strapdown::{NavError, Pva};

use super::pass::Plan;
use crate::figure::{Axis, Figure, Panel, Quantity, Series, Style};
use crate::scenario::Navigate;

/// Way from the start over time, velocity, attitude, and the track from above.
pub fn figures(
    title: &str,
    navigate: &Navigate,
    plan: &Plan,
    rows: &[(f64, Pva)],
    apart: &[(f64, NavError)],
) -> Vec<(String, Figure)> {
    let conditions = format!(
        "aligned over {} s to {} s, latitude {:.4}°, {:.0} Hz, free inertial",
        navigate.align.window[0],
        navigate.align.window[1],
        plan.position.lat.to_degrees(),
        navigate.log.rate
    );
    let error = if navigate.log.stationary { " error" } else { "" };
    let figure =
        |what: &str| Figure::new(format!("{title}: {what}"), Axis::time("time")).subtitle(&*conditions);

    let drift = horizontal(figure("drift"), apart, error);
    let attitude = rows.iter().map(|(t, pva)| {
        let a = pva.c_tb.as_euler();
        (*t, [a.roll, a.pitch, a.yaw].map(f64::to_degrees))
    });
    let attitude =
        components(figure("attitude"), &["roll (deg)", "pitch (deg)", "heading (deg)"], &unwrapped(attitude));
    let named = |name: &str, figure: Figure| (name.to_string(), figure);
    vec![named("drift", drift), named("attitude", attitude), named("track", track(title, &conditions, apart))]
}

/// North and east position and velocity over time.
fn horizontal(mut figure: Figure, apart: &[(f64, NavError)], error: &str) -> Figure {
    for (what, quantity) in [("position", Quantity::Length), ("velocity", Quantity::Velocity)] {
        let part = |e: &NavError| match quantity {
            Quantity::Length => [e.dr[0], e.dr[1]],
            _ => [e.dv[0], e.dv[1]],
        };
        let largest = apart.iter().flat_map(|(_, e)| part(e)).fold(0.0, |m: f64, x| m.max(x.abs()));
        let shown = quantity.shown(largest);
        let curve = |axis: usize| apart.iter().map(move |(t, e)| [*t, part(e)[axis] * shown.per_si]);
        figure = figure.panel(
            Panel::new(Axis::linear(format!("{what}{error} ({})", shown.symbol)))
                .with(Series::line("north", curve(0)))
                .with(Series::line("east", curve(1))),
        );
    }
    figure.size = Some((800, 560));
    figure
}

fn components(mut figure: Figure, labels: &[&str; 3], rows: &[(f64, [f64; 3])]) -> Figure {
    for (axis, label) in labels.iter().enumerate() {
        let curve = rows.iter().map(|(t, v)| [*t, v[axis]]);
        figure = figure.panel(Panel::new(Axis::linear(*label)).with(Series::line("", curve)));
    }
    figure
}

/// Heading without its jump at ±180 deg.
fn unwrapped(rows: impl Iterator<Item = (f64, [f64; 3])>) -> Vec<(f64, [f64; 3])> {
    let mut last: Option<f64> = None;
    rows.map(|(t, [roll, pitch, yaw])| {
        let near = last.map_or(yaw.rem_euclid(360.0), |last| yaw + 360.0 * ((last - yaw) / 360.0).round());
        last = Some(near);
        (t, [roll, pitch, near])
    })
    .collect()
}

/// The way from above.
fn track(title: &str, conditions: &str, apart: &[(f64, NavError)]) -> Figure {
    let largest = apart.iter().flat_map(|(_, e)| [e.dr[0], e.dr[1]]).fold(0.0, |m: f64, x| m.max(x.abs()));
    let shown = Quantity::Length.shown(largest);
    let way = apart.iter().map(|(_, e)| [e.dr[1] * shown.per_si, e.dr[0] * shown.per_si]);
    let panel = Panel::new(Axis::linear(format!("north of the start ({})", shown.symbol)))
        .with(Series::line("navigated", way))
        .with(Series::line("start", [[0.0, 0.0]]).style(Style::Points));
    Figure::new(format!("{title}: track"), Axis::linear(format!("east of the start ({})", shown.symbol)))
        .subtitle(conditions)
        .equal_aspect()
        .panel(panel)
}
