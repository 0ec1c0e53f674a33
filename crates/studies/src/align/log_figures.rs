//! Pictures of the windows of a log.

use schuler_strapdown::filter::chi_square;

use super::log::{Found, spread};
use crate::figure::{Axis, Colour, Figure, Panel, Quantity, Series, Style};
use crate::scenario::{AlignStudy, MethodKind};

/// A method whose spread is larger than the best by more than this would make of the others a line.
const APART: f64 = 30.0;

/// Attitude of each window, repeatability, and heading of the first filter within the windows.
pub fn figures(title: &str, study: &AlignStudy, found: &Found) -> Vec<(String, Figure)> {
    let count = found.windows.iter().map(Vec::len).max().unwrap_or(0);
    let conditions = format!("latitude {:.4}°, {count} windows", study.start.position.lat.to_degrees());
    let mut figures = Vec::new();
    if count > 1 {
        figures.push(("windows".into(), windows(title, &conditions, study, found)));
        if found.withheld.contains(&false) {
            figures.push(("repeatability".into(), repeatability(title, &conditions, study, found)));
        }
    }
    let filter = study.methods.iter().position(|m| matches!(m.kind, MethodKind::Filter(_)));
    if let Some(i) = filter.filter(|&i| !found.withheld[i] && found.courses.iter().any(|c| c.len() > 2)) {
        figures.push(("filter_heading".into(), course(title, &conditions, study, found, i)));
    }
    figures
}

/// Standard deviation over the windows of one angle of each method, and the methods that are not far from the best.
fn spreads(found: &Found, axis: usize) -> (Vec<f64>, Vec<usize>) {
    let all = 0..found.windows.len();
    let known = |i: usize| !found.windows[i].is_empty() && (axis < 2 || !found.withheld[i]);
    let sd: Vec<f64> = all
        .clone()
        .map(|i| if known(i) { spread(&found.about_first(i, axis).1).1 } else { f64::NAN })
        .collect();
    let best = sd.iter().copied().filter(|s| s.is_finite()).fold(f64::INFINITY, f64::min);
    let near = all.filter(|&i| sd[i] <= APART * best).collect();
    (sd, near)
}

/// Each angle of each method in each window, less its mean.
fn windows(title: &str, conditions: &str, study: &AlignStudy, found: &Found) -> Figure {
    let mut figure = Figure::new(format!("{title}: attitude less its mean"), Axis::time("end of the window"))
        .subtitle(format!(
            "{conditions}; methods whose spread is {APART} times that of the best are left out"
        ));
    for (axis, label) in [(2, "yaw"), (0, "roll"), (1, "pitch")] {
        let (sd, near) = spreads(found, axis);
        let shown = Quantity::Angle.shown(near.iter().map(|&i| sd[i]).fold(0.0, f64::max));
        let mut panel = Panel::new(Axis::linear(format!("{label} ({})", shown.symbol)));
        for &i in &near {
            let (_, values) = found.about_first(i, axis);
            let (mean, _) = spread(&values);
            let points: Vec<[f64; 2]> = found.windows[i]
                .iter()
                .zip(&values)
                .map(|(w, value)| [w.t, (value - mean) * shown.per_si])
                .collect();
            let colour = Colour::palette(i);
            panel = panel
                .with(Series::line(&study.methods[i].name, points.clone()).colour(colour))
                .with(Series::line("", points).style(Style::Points).colour(colour));
        }
        figure = figure.panel(panel);
    }
    figure
}

/// Standard deviation of heading over the windows with the band in which the true one is with 90 %, and the method's own.
fn repeatability(title: &str, conditions: &str, study: &AlignStudy, found: &Found) -> Figure {
    let (sd, _) = spreads(found, 2);
    let known: Vec<usize> = (0..sd.len()).filter(|&i| sd[i] > 0.0).collect();
    let names = known.iter().map(|&i| study.methods[i].name.clone()).collect();
    let smallest = known.iter().map(|&i| sd[i]).fold(f64::INFINITY, f64::min);
    let shown = Quantity::Angle.shown(smallest);
    let (mut bars, mut dots, mut own) = (Vec::new(), Vec::new(), Vec::new());
    for (row, &i) in known.iter().enumerate() {
        let freedom = found.windows[i].len() - 1;
        let y = -(row as f64);
        // (n - 1) s²/sigma² is chi-square.
        let [low, high] = [0.05, 0.95]
            .map(|p| sd[i] * shown.per_si * (freedom as f64 / chi_square::quantile(p, freedom)).sqrt());
        bars.extend([[low, y], [high, y], [f64::NAN, y]]);
        dots.push([sd[i] * shown.per_si, y]);
        let sigma = found.windows[i][0].sigma[2] * shown.per_si;
        if sigma.is_finite() {
            own.push([sigma, y]);
        }
    }
    let panel = Panel::new(Axis::rows(names))
        .with(Series::line("90 % band", bars).colour(Colour::palette(0)))
        .with(Series::line("sd over the windows", dots).style(Style::Points).colour(Colour::palette(0)))
        .with(Series::line("own σ of a window", own).style(Style::Points).colour(Colour::palette(1)));
    let x = Axis::log(format!("heading ({})", shown.symbol));
    Figure::new(format!("{title}: repeatability of heading"), x).subtitle(conditions).panel(panel)
}

/// Heading of a filter within each window, less its mean at their ends, with three of its own standard deviations.
fn course(title: &str, conditions: &str, study: &AlignStudy, found: &Found, filter: usize) -> Figure {
    let (about, values) = found.about_first(filter, 2);
    let (mean, sd) = spread(&values);
    let last = found.courses.iter().filter_map(|c| c.last()).map(|c| c[2]).fold(0.0, f64::max);
    let largest = if sd.is_finite() { sd.max(last) } else { last };
    let shown = Quantity::Angle.shown(largest);
    let turn = |x: f64| x - std::f64::consts::TAU * (x / std::f64::consts::TAU).round();
    let window = 8.0 * largest * shown.per_si;
    let mut panel = Panel::new(
        Axis::linear(format!("heading less its mean ({})", shown.symbol)).from_to(-window, window),
    );
    if let Some(course) = found.courses.first() {
        let band =
            course.iter().map(|&[t, _, sigma]| [t, -3.0 * sigma * shown.per_si, 3.0 * sigma * shown.per_si]);
        panel = panel.with(Series::band("±3 σ of the filter", band).colour(Colour::palette(5)));
    }
    for (k, course) in found.courses.iter().enumerate() {
        let curve = course.iter().map(|&[t, yaw, _]| [t, turn(yaw - about - mean) * shown.per_si]);
        panel = panel.with(Series::line(format!("window {}", k + 1), curve).colour(Colour::palette(k)));
    }
    let name = &study.methods[filter].name;
    Figure::new(format!("{title}: `{name}` within the windows"), Axis::time("time in the window"))
        .subtitle(conditions)
        .panel(panel)
}
