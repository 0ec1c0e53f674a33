//! Pictures of a drift study.

use schuler_strapdown::NavError;

use super::scene::Scene;
use super::{Curves, Way, summary};
use crate::figure::{Axis, Colour, Figure, Panel, Quantity, Series, Style};

/// One picture per quantity with all sources, and one picture of each source beside its closed form.
pub fn figures(title: &str, scene: &Scene, curves: &[Curves]) -> Vec<(String, Figure)> {
    let conditions = format!(
        "at rest, latitude {:.4}°, height {:.0} m, {:.0} Hz",
        scene.truth.position.lat.to_degrees(),
        scene.truth.position.h,
        1.0 / scene.dt
    );
    let mut figures = Vec::new();
    for (stem, what, quantity) in KINDS {
        figures.push((format!("all_{stem}"), overview(title, &conditions, scene, curves, what, quantity)));
    }
    for c in curves {
        figures.push((c.case.name.replace('#', "_"), beside(&conditions, scene, c)));
    }
    figures
}

const KINDS: [(&str, &str, Quantity); 3] = [
    ("position", "horizontal position error", Quantity::Length),
    ("velocity", "horizontal velocity error", Quantity::Velocity),
    ("attitude", "attitude error", Quantity::Angle),
];

/// Error of one kind as three components.
fn part(e: &NavError, quantity: Quantity) -> [f64; 3] {
    match quantity {
        Quantity::Velocity => e.dv.as_array(),
        Quantity::Angle => e.phi.as_array(),
        _ => e.dr.as_array(),
    }
}

/// Sizes of all sources on a logarithmic axis: they span decades.
fn overview(
    title: &str,
    conditions: &str,
    scene: &Scene,
    curves: &[Curves],
    what: &str,
    quantity: Quantity,
) -> Figure {
    let size = |e: &NavError| {
        let [n, east, d] = part(e, quantity);
        if quantity == Quantity::Angle { (n * n + east * east + d * d).sqrt() } else { n.hypot(east) }
    };
    let largest = |c: &Curves| c.of(Way::Nonlinear).unwrap_or_default().iter().map(size).fold(0.0, f64::max);
    let top = curves.iter().map(largest).fold(0.0, f64::max);
    let shown = quantity.shown(top);
    // The strongest first; what stays six decades below the top is rounding and would only stretch the axis.
    let mut order: Vec<&Curves> = curves.iter().filter(|c| largest(c) > 1e-6 * top).collect();
    order.sort_by(|a, b| largest(b).total_cmp(&largest(a)));
    let mut panel = Panel::new(
        Axis::log(format!("{what} ({})", shown.symbol))
            .from_to(top * shown.per_si * 1e-6, top * shown.per_si * 2.0),
    );
    for c in order {
        let rows = c.of(Way::Nonlinear).unwrap_or_default();
        let points = scene.rows.iter().zip(rows).map(|(&k, e)| [scene.time(k), size(e) * shown.per_si]);
        panel = panel.with(Series::line(&c.case.name, points));
    }
    Figure::new(format!("{title}: {what} of each source"), Axis::time("time"))
        .subtitle(format!("{conditions}; non-linear runs, largest effect first"))
        .panel(panel)
}

/// North and east position and the attitude of one source, all its ways.
fn beside(conditions: &str, scene: &Scene, c: &Curves) -> Figure {
    let nonlinear = c.of(Way::Nonlinear).unwrap_or_default();
    let remark = if summary::is_silent(nonlinear) { "; does nothing here, rounding only" } else { "" };
    let mut figure =
        Figure::new(c.case.name.clone(), Axis::time("time")).subtitle(format!("{conditions}{remark}"));
    let panels: [(&str, Quantity, usize); 5] = [
        ("north", Quantity::Length, 0),
        ("east", Quantity::Length, 1),
        ("φ north", Quantity::Angle, 0),
        ("φ east", Quantity::Angle, 1),
        ("φ down", Quantity::Angle, 2),
    ];
    for (name, quantity, axis) in panels {
        // Panels of one quantity share the unit, that of the largest component.
        let largest = nonlinear.iter().flat_map(|e| part(e, quantity)).fold(0.0, |m: f64, x| m.max(x.abs()));
        let shown = quantity.shown(largest);
        let mut panel = Panel::new(Axis::linear(format!("{name} ({})", shown.symbol)));
        let curve = |rows: &[NavError], sign: f64| -> Vec<[f64; 2]> {
            let y = |e: &NavError| sign * part(e, quantity)[axis] * shown.per_si;
            scene.rows.iter().zip(rows).map(|(&k, e)| [scene.time(k), y(e)]).collect()
        };
        let sigma = |rows: &[NavError]| -> Vec<[f64; 3]> {
            curve(rows, 1.0).into_iter().map(|[t, s]| [t, -s, s]).collect()
        };
        for (way, rows) in &c.ways {
            panel = match (way, c.sigma) {
                (Way::Nonlinear, false) => {
                    panel.with(Series::line("non-linear run", curve(rows, 1.0)).colour(Colour::palette(0)))
                }
                (Way::Nonlinear, true) => panel.with(
                    Series::line("one sample, non-linear", curve(rows, 1.0)).colour(Colour::palette(0)),
                ),
                (Way::Exact, false) => panel.with(
                    Series::line("exact closed form", curve(rows, 1.0))
                        .style(Style::Dashed)
                        .colour(Colour::palette(1)),
                ),
                (Way::Exact, true) => {
                    panel.with(Series::band("±1 σ, covariance", sigma(rows)).colour(Colour::palette(5)))
                }
                (Way::SingleAxis, false) => panel.with(
                    Series::line("single-axis formula", curve(rows, 1.0))
                        .style(Style::Dotted)
                        .colour(Colour::GREY),
                ),
                (Way::SingleAxis, true) => panel
                    .with(
                        Series::line("±1 σ, single-axis formula", curve(rows, 1.0))
                            .style(Style::Dotted)
                            .colour(Colour::GREY),
                    )
                    .with(Series::line("", curve(rows, -1.0)).style(Style::Dotted).colour(Colour::GREY)),
                (Way::HalfDifference | Way::Linear, _) => panel,
            };
        }
        figure = figure.panel(panel);
    }
    figure
}
