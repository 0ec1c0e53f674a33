//! One bar a source, the largest on top, below all together.

use super::super::report::total;
use super::super::scene::Scene;
use super::super::source::Nine;
use super::super::subject::{interval, share, shown, words};
use super::super::{BELIEVED, Contribution, TOTAL, Way};
use super::{Look, look, size};
use crate::figure::{Axis, Colour, Panel, Series, Style};
use crate::scenario::Required;

/// Most bars of sources.
const BARS: usize = 16;

/// Part of the largest source below which a bar cannot be seen.
const SEEN: f64 = 2e-3;

/// A bar to be.
struct Bar {
    name: String,
    size: f64,
    colour: Colour,
    /// Ends of its confidence interval.
    interval: Option<[f64; 2]>,
}

/// The x axis and the rows: the total, what the filter believes of it, what runs find of it, the sources with their shares of
/// the variance, and those that are too small to be seen as one.
pub fn panel(of: Required, look: &Look, scene: &Scene, contributions: &[Contribution]) -> (Axis, Panel) {
    let bars = bars(of, look, scene, contributions);
    let largest = bars.iter().map(|bar| bar.interval.map_or(bar.size, |[_, high]| high)).fold(0.0, f64::max);
    let (symbol, per_si) = shown(of, largest);
    let mut panel = Panel::new(Axis::rows(bars.iter().map(|bar| bar.name.clone()).collect()));
    for (k, bar) in bars.iter().enumerate() {
        let (reach, at) = (bar.size * per_si, -(k as f64));
        let area = [[-reach, at - 0.4, at + 0.4], [reach, at - 0.4, at + 0.4]];
        panel = panel.with(Series::band("", area).colour(bar.colour).solid());
        for side in [-per_si, per_si] {
            if let Some([low, high]) = bar.interval {
                let whisker = [[side * low, at], [side * high, at]];
                panel = panel.with(Series::line("", whisker).colour(Colour::BLACK).style(Style::Line));
                for end in [low, high] {
                    let mark = [[side * end, at - 0.25], [side * end, at + 0.25]];
                    panel = panel.with(Series::line("", mark).colour(Colour::BLACK).style(Style::Line));
                }
            }
        }
    }
    let most = 1.05 * largest * per_si;
    (Axis::linear(format!("± 1 σ, {} ({symbol})", words(of))).from_to(-most, most), panel)
}

fn bars(of: Required, look: &Look, scene: &Scene, contributions: &[Contribution]) -> Vec<Bar> {
    let Some(whole) = total(contributions).last() else { return Vec::new() };
    let mut bars = Vec::new();
    let mut push =
        |name: String, size: f64, colour, interval| bars.push(Bar { name, size, colour, interval });
    push(TOTAL.into(), size(of, whole), Colour::BLACK, None);
    let of_all = |way| contributions.iter().filter(|c| c.name == TOTAL).find_map(|c| c.of(way)?.last());
    if let Some(p) = of_all(Way::Sigma) {
        push(BELIEVED.into(), size(of, p), look::BELIEF, None);
    }
    if let Some(p) = of_all(Way::MonteCarlo) {
        let runs = scene.study.runs;
        let name = format!("{TOTAL}, {runs} runs (99 %)");
        push(name, size(of, p), look::RUNS, Some(interval(of, p, runs)));
    }
    let order = look::sorted(contributions, |p| p.last().map_or(0.0, |p| size(of, p)));
    let ends: Vec<(&str, &Nine)> = order.iter().filter_map(|(name, p)| Some((*name, p.last()?))).collect();
    let first = ends.first().map_or(0.0, |(_, p)| size(of, p));
    let seen = ends.iter().take(BARS).filter(|(_, p)| size(of, p) > SEEN * first).count();
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    for (name, p) in &ends[..seen] {
        push(format!("{name}, {}", percent(share(of, p, whole))), size(of, p), look.colour(name), None);
    }
    let rest: Nine = ends[seen..].iter().map(|(_, p)| **p).sum();
    if seen < ends.len() {
        let name = format!("{} others, {}", ends.len() - seen, percent(share(of, &rest, whole)));
        push(name, size(of, &rest), Colour::GREY, None);
    }
    bars
}
