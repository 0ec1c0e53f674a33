//! Pictures of a budget.

use super::radius::horizontal;
use super::report::{heading_share, share, total};
use super::scene::Scene;
use super::source::Nine;
use super::{BELIEVED, Contribution, TOTAL, Way};
use crate::figure::{Axis, Colour, Figure, Panel, Quantity, Series, Style};

/// Sources with a colour of their own; the rest is one band.
const NAMED: usize = 9;

/// Part of the largest error down to which curves are shown.
const DEPTH: f64 = 1e-4;

/// Most bars of the tornado.
const BARS: usize = 20;

/// The same sources at times closer together, up to the first row.
pub struct Beginning<'a> {
    pub scene: &'a Scene<'a>,
    pub contributions: &'a [Contribution],
}

/// Shares of the horizontal variance on top of each other, the horizontal errors over time, and a tornado chart of the end.
pub fn figures(
    title: &str,
    scene: &Scene,
    contributions: &[Contribution],
    beginning: &Beginning,
) -> Vec<(String, Figure)> {
    let conditions = format!(
        "{}, latitude {:.4}°, {} Hz",
        scene.study.motion.words(),
        scene.study.start.position.lat.to_degrees(),
        scene.study.imu.rate
    );
    let whole = total(contributions);
    let believed = contributions.iter().find_map(|c| c.of(Way::Sigma));
    let by_covariance = || {
        let sources = contributions.iter().filter(|c| c.name != TOTAL);
        sources.filter_map(|c| Some((c.name.as_str(), c.of(Way::Covariance)?)))
    };
    let ordered = |size: &dyn Fn(&[Nine]) -> f64| {
        let mut order: Vec<(&str, &[Nine])> = by_covariance().collect();
        order.sort_by(|a, b| size(b.1).total_cmp(&size(a.1)));
        order
    };
    let order = ordered(&|p| p.last().map_or(0.0, |p| horizontal(p).trace()));
    // Who is large for a while has a band of its own, also where it is small at the end.
    let largest = |share: Share| {
        ordered(&|p| p.iter().zip(whole).map(|(p, whole)| share(p, whole)).fold(0.0, f64::max))
    };
    let figure =
        |what: &str, x: Axis| Figure::new(format!("{title}: {what}"), x).subtitle(conditions.clone());
    vec![
        (
            "shares".into(),
            figure("shares of the horizontal variance", Axis::time("time")).panel(shares(
                scene,
                whole,
                &largest(share),
                beginning,
                share,
            )),
        ),
        (
            "heading_shares".into(),
            figure("shares of the heading variance", Axis::time("time")).panel(shares(
                scene,
                whole,
                &largest(heading_share),
                beginning,
                heading_share,
            )),
        ),
        (
            "horizontal".into(),
            figure("horizontal position, 1 σ", Axis::time("time"))
                .panel(sizes(scene, whole, believed, &order)),
        ),
        ("tornado".into(), tornado(figure, &order)),
    ]
}

/// What is shared: part of a source's covariance in the whole.
type Share = fn(&Nine, &Nine) -> f64;

/// Bands from t = 0 on: where there is no such error yet, those after the first sample.
fn shares(
    scene: &Scene,
    whole: &[Nine],
    order: &[(&str, &[Nine])],
    beginning: &Beginning,
    share: Share,
) -> Panel {
    let none = |p: &Nine| share(p, p) <= 0.0;
    let early = total(beginning.contributions);
    let times: Vec<f64> = [0]
        .iter()
        .chain(&beginning.scene.rows[1..])
        .chain(&scene.rows[1..])
        .map(|&k| scene.time(k))
        .collect();
    let at = |name: &str, p: &[Nine]| -> Vec<f64> {
        let source = beginning.contributions.iter().find(|c| c.name == name);
        let source = source.and_then(|c| c.of(Way::Covariance)).unwrap_or_default();
        let mut early: Vec<f64> = source.iter().zip(early).map(|(p, whole)| share(p, whole)).collect();
        if whole.first().is_some_and(none) && early.len() > 1 {
            early[0] = early[1];
        }
        early.extend(p.iter().zip(whole).skip(1).map(|(p, whole)| share(p, whole)));
        early
    };
    let mut panel = Panel::new(Axis::linear("share (%)").from_to(0.0, 100.0));
    let mut floor = vec![0.0; times.len()];
    for (k, (name, p)) in order.iter().take(NAMED).enumerate() {
        let mut band = Vec::with_capacity(times.len());
        for ((t, floor), share) in times.iter().zip(&mut floor).zip(at(name, p)) {
            let top = *floor + 100.0 * share;
            band.push([*t, *floor, top]);
            *floor = top;
        }
        panel = panel.with(Series::band(*name, band).colour(colour(k)));
    }
    if order.len() > NAMED {
        let rest = times.iter().zip(floor).map(|(&t, low)| [t, low, 100.0]);
        panel = panel.with(Series::band("all others", rest).colour(Colour::GREY));
    }
    panel
}

/// Colour of source number `k`: the palette without its black, which is for the total.
fn colour(k: usize) -> Colour {
    const BLACK: usize = 6;
    Colour::palette(if k < BLACK { k } else { k + 1 })
}

fn sizes(scene: &Scene, whole: &[Nine], believed: Option<&[Nine]>, order: &[(&str, &[Nine])]) -> Panel {
    let size = |p: &Nine| horizontal(p).trace().max(0.0).sqrt();
    let largest = whole.iter().map(size).fold(0.0, f64::max);
    let shown = Quantity::Length.shown(largest);
    let mut panel = Panel::new(
        Axis::log(format!("root of both variances ({})", shown.symbol))
            .from_to(largest * shown.per_si * DEPTH, largest * shown.per_si * 2.0),
    );
    let line = |p: &[Nine]| -> Vec<[f64; 2]> {
        scene.rows.iter().zip(p).map(|(&k, p)| [scene.time(k), size(p) * shown.per_si]).collect()
    };
    panel = panel.with(Series::line(TOTAL, line(whole)).colour(Colour::BLACK));
    if let Some(believed) = believed {
        let believed = Series::line(BELIEVED, line(believed)).colour(Colour::BLACK);
        panel = panel.with(believed.style(Style::Dashed));
    }
    let seen = |p: &[Nine]| p.iter().any(|p| size(p) > DEPTH * largest);
    for (k, (name, p)) in order.iter().take(NAMED).enumerate().filter(|(_, (_, p))| seen(p)) {
        panel = panel.with(Series::line(*name, line(p)).colour(colour(k)).style(Style::Line));
    }
    panel
}

/// One bar a source, the largest on top.
fn tornado(figure: impl Fn(&str, Axis) -> Figure, order: &[(&str, &[Nine])]) -> Figure {
    let size = |p: &[Nine]| p.last().map_or(0.0, |p| horizontal(p).trace().max(0.0).sqrt());
    let largest = order.iter().map(|(_, p)| size(p)).fold(0.0, f64::max);
    let shown = Quantity::Length.shown(largest);
    let named = &order[..order.len().min(BARS)];
    let mut panel = Panel::new(Axis::rows(named.iter().map(|(name, _)| name.to_string()).collect()));
    for (k, (_, p)) in named.iter().enumerate() {
        let (reach, at) = (size(p) * shown.per_si, -(k as f64));
        let bar = [[-reach, at - 0.4, at + 0.4], [reach, at - 0.4, at + 0.4]];
        panel = panel.with(Series::band("", bar).colour(Colour::palette(0)));
    }
    let most = 1.05 * largest * shown.per_si;
    let x = Axis::linear(format!("± 1 σ, horizontal ({})", shown.symbol)).from_to(-most, most);
    figure("sources at the end", x).panel(panel)
}
