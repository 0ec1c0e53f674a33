//! Pictures of a budget.

use super::radius::horizontal;
use super::report::{share, total};
use super::scene::Scene;
use super::source::Nine;
use super::{Contribution, TOTAL, Way};
use crate::figure::{Axis, Colour, Figure, Panel, Quantity, Series};

/// Sources with a colour of their own; the rest is one band.
const NAMED: usize = 9;

/// Shares of the horizontal variance on top of each other, the horizontal errors over time, and a tornado chart of the end.
pub fn figures(title: &str, scene: &Scene, contributions: &[Contribution]) -> Vec<(String, Figure)> {
    let conditions = format!(
        "{}, latitude {:.4}°, {} Hz",
        scene.study.motion.words(),
        scene.study.start.position.lat.to_degrees(),
        scene.study.imu.rate
    );
    let whole = total(contributions);
    let mut order: Vec<(&str, &[Nine])> = contributions
        .iter()
        .filter(|c| c.name != TOTAL)
        .filter_map(|c| Some((c.name.as_str(), c.of(Way::Covariance)?)))
        .collect();
    let end = |p: &[Nine]| p.last().map_or(0.0, |p| horizontal(p).trace());
    order.sort_by(|a, b| end(b.1).total_cmp(&end(a.1)));
    let figure =
        |what: &str, x: Axis| Figure::new(format!("{title}: {what}"), x).subtitle(conditions.clone());
    vec![
        (
            "shares".into(),
            figure("shares of the horizontal variance", Axis::time("time"))
                .panel(shares(scene, whole, &order)),
        ),
        (
            "horizontal".into(),
            figure("horizontal position, 1 σ", Axis::time("time")).panel(sizes(scene, whole, &order)),
        ),
        ("tornado".into(), tornado(figure, &order)),
    ]
}

fn shares(scene: &Scene, whole: &[Nine], order: &[(&str, &[Nine])]) -> Panel {
    let mut panel = Panel::new(Axis::linear("share (%)").from_to(0.0, 100.0));
    let mut floor = vec![0.0; whole.len()];
    for (k, (name, p)) in order.iter().take(NAMED).enumerate() {
        let mut band = Vec::with_capacity(whole.len());
        for (row, whole) in whole.iter().enumerate() {
            let top = floor[row] + 100.0 * share(&p[row], whole);
            band.push([scene.time(scene.rows[row]), floor[row], top]);
            floor[row] = top;
        }
        panel = panel.with(Series::band(*name, band).colour(Colour::palette(k)));
    }
    if order.len() > NAMED {
        let moving = whole.iter().map(|p| horizontal(p).trace() > 0.0);
        let rest = scene.rows.iter().zip(floor).zip(moving);
        let rest = rest.map(|((&k, low), moves)| [scene.time(k), low, if moves { 100.0 } else { low }]);
        panel = panel.with(Series::band("all others", rest).colour(Colour::GREY));
    }
    panel
}

fn sizes(scene: &Scene, whole: &[Nine], order: &[(&str, &[Nine])]) -> Panel {
    let size = |p: &Nine| horizontal(p).trace().max(0.0).sqrt();
    let largest = whole.iter().map(size).fold(0.0, f64::max);
    let shown = Quantity::Length.shown(largest);
    let mut panel = Panel::new(
        Axis::log(format!("root of both variances ({})", shown.symbol))
            .from_to(largest * shown.per_si * 1e-4, largest * shown.per_si * 2.0),
    );
    let line = |p: &[Nine]| -> Vec<[f64; 2]> {
        scene.rows.iter().zip(p).map(|(&k, p)| [scene.time(k), size(p) * shown.per_si]).collect()
    };
    panel = panel.with(Series::line(TOTAL, line(whole)).colour(Colour::GREY));
    for (k, (name, p)) in order.iter().take(NAMED).enumerate() {
        panel = panel.with(Series::line(*name, line(p)).colour(Colour::palette(k)));
    }
    panel
}

/// One bar a source, the largest on top.
fn tornado(figure: impl Fn(&str, Axis) -> Figure, order: &[(&str, &[Nine])]) -> Figure {
    let size = |p: &[Nine]| p.last().map_or(0.0, |p| horizontal(p).trace().max(0.0).sqrt());
    let largest = order.iter().map(|(_, p)| size(p)).fold(0.0, f64::max);
    let shown = Quantity::Length.shown(largest);
    let count = order.len().min(NAMED);
    let mut panel = Panel::new(Axis::linear("rank").from_to(-(count as f64) - 0.5, -0.5));
    for (k, (name, p)) in order.iter().take(NAMED).enumerate() {
        let reach = size(p) * shown.per_si;
        let at = -1.0 - k as f64;
        let bar = [[-reach, at - 0.4, at + 0.4], [reach, at - 0.4, at + 0.4]];
        panel = panel.with(Series::band(*name, bar).colour(Colour::palette(k)));
    }
    figure("sources at the end", Axis::linear(format!("± 1 σ, horizontal ({})", shown.symbol))).panel(panel)
}
