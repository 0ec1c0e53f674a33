//! Shares of the variance on top of each other.

use super::super::report::total;
use super::super::scene::Scene;
use super::super::source::Nine;
use super::super::subject::share;
use super::super::{Contribution, Way};
use super::{Beginning, Look, look};
use crate::figure::{Axis, Colour, Panel, Series};
use crate::scenario::Required;

/// Bands from t = 0 on: where there is no such error yet, those after the first sample.
pub fn panel(
    of: Required,
    look: &Look,
    scene: &Scene,
    contributions: &[Contribution],
    beginning: &Beginning,
) -> Panel {
    let whole = total(contributions);
    let early = total(beginning.contributions);
    let none = |p: &Nine| share(of, p, p) <= 0.0;
    let times: Vec<f64> = [0]
        .iter()
        .chain(&beginning.scene.rows[1..])
        .chain(&scene.rows[1..])
        .map(|&k| scene.time(k))
        .collect();
    let at = |name: &str, p: &[Nine]| -> Vec<f64> {
        let source = beginning.contributions.iter().find(|c| c.name == name);
        let source = source.and_then(|c| c.of(Way::Covariance)).unwrap_or_default();
        let mut early: Vec<f64> = source.iter().zip(early).map(|(p, whole)| share(of, p, whole)).collect();
        if whole.first().is_some_and(none) && early.len() > 1 {
            early[0] = early[1];
        }
        early.extend(p.iter().zip(whole).skip(1).map(|(p, whole)| share(of, p, whole)));
        early
    };
    let mut panel = Panel::new(Axis::linear("share (%)").from_to(0.0, 100.0));
    let mut floor = vec![0.0; times.len()];
    let named = look::ever(of, contributions);
    for (name, p) in &named {
        let mut band = Vec::with_capacity(times.len());
        for ((t, floor), share) in times.iter().zip(&mut floor).zip(at(name, p)) {
            let top = *floor + 100.0 * share;
            band.push([*t, *floor, top]);
            *floor = top;
        }
        panel = panel.with(Series::band(*name, band).colour(look.colour(name)).solid());
    }
    if named.len() + 1 < contributions.len() {
        let rest = times.iter().zip(floor).map(|(&t, low)| [t, low, 100.0]);
        panel = panel.with(Series::band("all others", rest).colour(Colour::GREY).solid());
    }
    panel
}
