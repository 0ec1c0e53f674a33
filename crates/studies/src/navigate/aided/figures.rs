//! Pictures of a navigation with a filter.

use schuler_frames::{T, Vec3, position_error};

use super::measured::{Event, Taken};
use super::report::parts;
use super::{Found, Row};
use crate::figure::{Axis, Figure, Panel, Quantity, Series, Style};
use crate::scenario::Aided;

/// The way from above; errors against the reference, or standard deviations; innovations with their band; estimated
/// errors of the sensors.
pub fn figures(title: &str, aided: &Aided, events: &[Event], found: &Found) -> Vec<(String, Figure)> {
    let sources: Vec<&str> = aided
        .measured
        .iter()
        .map(|m| m.kind.name())
        .chain(aided.conditions.iter().map(|c| c.kind.name()))
        .map(|name| name.trim_end_matches('_'))
        .collect();
    let conditions = format!("{:.0} Hz, aided by {}", aided.log.rate, sources.join(", ").replace('_', " "));
    let figure =
        |what: &str| Figure::new(format!("{title}: {what}"), Axis::time("time")).subtitle(&*conditions);
    let compared = found.rows.iter().any(|row| row.error.is_some());
    let mut figures = vec![("track".to_string(), track(title, &conditions, events, found))];
    let what = if compared { "errors and three standard deviations" } else { "three standard deviations" };
    figures.push(("errors".into(), errors(figure(what), &found.rows)));
    for source in 0..sources.len() {
        if found.updates.iter().any(|update| update.source == source) {
            let what = format!("innovations of {}", sources[source].replace('_', " "));
            figures.push((
                format!("innovations_{}", sources[source]),
                innovations(figure(&what), aided, source, found),
            ));
        }
    }
    figures.push(("sensors".into(), sensors(figure("estimated sensor errors"), &found.rows)));
    figures
}

fn errors(mut figure: Figure, rows: &[Row]) -> Figure {
    const PANELS: [(&str, Quantity, [usize; 3]); 3] = [
        ("position", Quantity::Length, [0, 1, 2]),
        ("velocity", Quantity::Velocity, [3, 4, 5]),
        ("attitude", Quantity::Angle, [6, 7, 8]),
    ];
    for (what, quantity, states) in PANELS {
        for (state, axis) in states.into_iter().zip(["north", "east", "down"]) {
            let largest = rows.iter().map(|row| 3.0 * row.sigma[state]).fold(0.0, f64::max);
            let shown = quantity.shown(largest);
            let band = rows.iter().map(|row| {
                let sigma = 3.0 * row.sigma[state] * shown.per_si;
                [row.t, -sigma, sigma]
            });
            let mut panel = Panel::new(Axis::linear(format!("{what} {axis} ({})", shown.symbol)))
                .with(Series::band("three standard deviations", band));
            let curve: Vec<[f64; 2]> = rows
                .iter()
                .filter_map(|row| Some([row.t, row.error.as_ref()?.0.as_array()[state] * shown.per_si]))
                .collect();
            if !curve.is_empty() {
                panel = panel.with(Series::line("error", curve));
            }
            figure = figure.panel(panel);
        }
    }
    figure
}

fn innovations(mut figure: Figure, aided: &Aided, source: usize, found: &Found) -> Figure {
    let quantity = match parts(aided, source)[0].split('.').next() {
        Some("position" | "height") => Quantity::Length,
        Some("heading") => Quantity::Angle,
        Some("zero_rate") => Quantity::AngularRate,
        _ => Quantity::Velocity,
    };
    let updates: Vec<_> = found.updates.iter().filter(|update| update.source == source).collect();
    for (i, part) in parts(aided, source).iter().enumerate() {
        if updates.iter().any(|update| i >= update.outcome.len) {
            continue;
        }
        let sigma = |update: &&&super::Update| update.outcome.s[i][i].sqrt();
        let largest = updates.iter().map(|update| 3.0 * sigma(&update)).fold(0.0, f64::max);
        let shown = quantity.shown(largest);
        let of = |accepted: bool| {
            let points = updates.iter().filter(move |update| update.outcome.accepted[i] == accepted);
            points
                .map(move |update| [update.t, update.outcome.innovation[i] * shown.per_si])
                .collect::<Vec<_>>()
        };
        let band = updates.iter().map(|update| {
            let sigma = 3.0 * sigma(&update) * shown.per_si;
            [update.t, -sigma, sigma]
        });
        let axis = part.rsplit('.').next().unwrap_or(part).replace('_', " ");
        let mut panel = Panel::new(Axis::linear(format!("{axis} ({})", shown.symbol)))
            .with(Series::band("three standard deviations", band))
            .with(Series::line("innovation", of(true)).style(Style::Points));
        let refused = of(false);
        if !refused.is_empty() {
            panel = panel.with(Series::line("refused", refused).style(Style::Points));
        }
        figure = figure.panel(panel);
    }
    figure
}

fn sensors(mut figure: Figure, rows: &[Row]) -> Figure {
    for (i, (what, quantity)) in
        [("gyro error", Quantity::AngularRate), ("accelerometer error", Quantity::Acceleration)]
            .into_iter()
            .enumerate()
    {
        let largest = rows.iter().flat_map(|row| row.sensors[i]).fold(0.0, |m: f64, x| m.max(x.abs()));
        let shown = quantity.shown(largest);
        let mut panel = Panel::new(Axis::linear(format!("{what} ({})", shown.symbol)));
        for (axis, label) in ["x", "y", "z"].into_iter().enumerate() {
            let curve = rows.iter().map(|row| [row.t, row.sensors[i][axis] * shown.per_si]);
            panel = panel.with(Series::line(label, curve));
        }
        figure = figure.panel(panel);
    }
    figure
}

/// The way from above, with the positions measured.
fn track(title: &str, conditions: &str, events: &[Event], found: &Found) -> Figure {
    let Some(first) = found.rows.first() else { return Figure::new(title, Axis::linear("")) };
    let origin = first.pva.position;
    let from = |position| {
        let way: Vec3<T> = position_error(position, origin);
        [way[1], way[0]]
    };
    let way: Vec<[f64; 2]> = found.rows.iter().map(|row| from(row.pva.position)).collect();
    let largest = way.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let shown = Quantity::Length.shown(largest);
    let scaled = |points: Vec<[f64; 2]>| points.into_iter().map(move |p| p.map(|x| x * shown.per_si));
    let measured: Vec<[f64; 2]> = events
        .iter()
        .filter_map(|event| match event.taken {
            Taken::Position(position) => Some(from(position.position)),
            _ => None,
        })
        .collect();
    let mut panel = Panel::new(Axis::linear(format!("north of the start ({})", shown.symbol)));
    if !measured.is_empty() {
        panel = panel.with(Series::line("measured", scaled(measured)).style(Style::Points));
    }
    panel = panel.with(Series::line("navigated", scaled(way)));
    Figure::new(format!("{title}: track"), Axis::linear(format!("east of the start ({})", shown.symbol)))
        .subtitle(conditions)
        .equal_aspect()
        .panel(panel)
}
