//! The size of an error over time: all together, as the filter believes, as runs find it, and by source.

use super::super::report::total;
use super::super::scene::Scene;
use super::super::source::Nine;
use super::super::subject::{interval, shown, words};
use super::super::{BELIEVED, Contribution, TOTAL, Way};
use super::{Look, look, size};
use crate::figure::{Axis, Colour, Panel, Series, Style};
use crate::scenario::Required;

/// Part of the last total down to which curves are shown, and within which parts of the largest that is kept.
const DEPTH: f64 = 3e-3;
const DEPTHS: [f64; 2] = [1e-4, 1e-2];

/// Curves that differ by less lie upon each other in a picture.
const ALIKE: f64 = 0.02;

/// Part of the rows above which curves that are alike count as one upon the other.
const UPON: f64 = 0.25;

/// Dots of runs, at most: more would be a line.
const DOTS: usize = 40;

/// The styles of curves upon each other: each leaves gaps through which those below are seen.
const STYLES: [Style; 4] = [Style::Line, Style::Dashed, Style::DashDot, Style::Dotted];

/// The panel.
pub fn panel(of: Required, look: &Look, scene: &Scene, contributions: &[Contribution]) -> Panel {
    let whole = total(contributions);
    let largest = whole.iter().map(|p| size(of, p)).fold(0.0, f64::max);
    let last = whole.last().map_or(0.0, |p| size(of, p));
    let least = (DEPTH * last).clamp(DEPTHS[0] * largest, DEPTHS[1] * largest);
    let (symbol, per_si) = shown(of, largest);
    let label = format!("{} ({symbol})", words(of));
    let mut panel = Panel::new(Axis::log(label).from_to(least * per_si, 2.0 * largest * per_si));
    let time = |row: usize| scene.time(scene.rows[row]);
    let line = |p: &[Nine]| -> Vec<[f64; 2]> {
        p.iter().enumerate().map(|(row, p)| [time(row), size(of, p) * per_si]).collect()
    };
    if let Some(found) = contributions.iter().find(|c| c.name == TOTAL).and_then(|c| c.of(Way::MonteCarlo)) {
        let runs = scene.study.runs;
        let name = format!("{TOTAL}, {runs} runs (99 %)");
        let band = found.iter().enumerate().map(|(row, p)| {
            let [low, high] = interval(of, p, runs);
            [time(row), low * per_si, high * per_si]
        });
        panel = panel.with(Series::band(name.as_str(), band).colour(look::RUNS));
        let dots = line(found).into_iter().step_by(found.len().div_ceil(DOTS));
        panel = panel.with(Series::line(name, dots).colour(look::RUNS).style(Style::Points));
    }
    let mut drawn: Vec<&[Nine]> = Vec::new();
    let add = |panel: Panel, name: &str, p: &[Nine], colour: Colour, below: usize| {
        let style = STYLES[below.min(STYLES.len() - 1)];
        panel.with(Series::line(name, line(p)).colour(colour).style(style))
    };
    panel = add(panel, TOTAL, whole, Colour::BLACK, 0);
    drawn.push(whole);
    let seen = |p: &&[Nine]| p.iter().any(|p| size(of, p) > least);
    for (name, p) in look::at_end(of, contributions).into_iter().filter(|(_, p)| seen(p)) {
        let below = drawn.iter().filter(|other| upon(of, p, other, least)).count();
        panel = add(panel, name, p, look.colour(name), below);
        drawn.push(p);
    }
    if let Some(believed) = contributions.iter().find_map(|c| c.of(Way::Sigma)) {
        panel = add(panel, BELIEVED, believed, look::BELIEF, 1);
    }
    panel
}

/// Whether two curves lie upon each other for a good part of what can be seen of them.
pub fn upon(of: Required, a: &[Nine], b: &[Nine], least: f64) -> bool {
    let both: Vec<[f64; 2]> = a
        .iter()
        .zip(b)
        .map(|(a, b)| [size(of, a), size(of, b)])
        .filter(|both| both.iter().any(|x| *x > least))
        .collect();
    let alike = both.iter().filter(|[a, b]| (a - b).abs() < ALIKE * a.max(*b)).count();
    alike as f64 > UPON * both.len() as f64
}
