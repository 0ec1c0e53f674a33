//! Pictures of an align study.

use schuler_frames::{T, Vec3};

use super::ends::ends;
use super::report::{Results, band};
use super::run::Trace;
use crate::figure::{Axis, Colour, Figure, Panel, Quantity, Series, Style};
use crate::scenario::MethodKind;

/// Axes of phi.
const AXES: [&str; 3] = ["φ north", "φ east", "φ down"];

/// Rows that make a course over time: one or two are points in a table.
const COURSE: usize = 3;

/// Each method over time, all methods and the best estimator's laws, innovations, and where the runs end.
pub fn figures(title: &str, results: &Results) -> Vec<(String, Figure)> {
    let Results { study, scene, end, .. } = *results;
    let conditions = format!(
        "latitude {:.4}°, {:.0} Hz, {} {}",
        scene.position.lat.to_degrees(),
        1.0 / scene.dt,
        study.runs,
        if study.runs == 1 { "run" } else { "runs" }
    );
    let mut figures = Vec::new();
    if end + 1 >= COURSE {
        if results.withheld.heading.contains(&false) {
            figures.push(("heading".into(), heading(title, &conditions, results)));
        }
        for (i, method) in study.methods.iter().enumerate() {
            let stem: String =
                method.name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
            figures.push((stem, over_time(&conditions, results, i)));
        }
        if let Some(filter) = study.methods.iter().position(|m| matches!(m.kind, MethodKind::Filter(_))) {
            figures.push(("laws".into(), laws(title, &conditions, results, filter)));
            figures.push(("innovations".into(), innovations(title, &conditions, results, filter)));
        }
    }
    if study.navigate > 0 {
        figures.push(("drift".into(), drift(title, &conditions, results)));
    }
    if study.runs > 2 {
        figures.extend(ends(title, &conditions, results).map(|figure| ("ends".into(), figure)));
    }
    figures
}

/// Lines across a panel from `low` to `high` at the knock and at the first turn.
fn marked(mut panel: Panel, results: &Results, [low, high]: [f64; 2]) -> Panel {
    let end = results.scene.time(results.scene.samples);
    let turn = results.limit.turn.filter(|turn| *turn < end);
    for (label, at, colour) in
        [("knock", results.scene.knock(), Colour::palette(1)), ("turn", turn, Colour::palette(2))]
    {
        if let Some(t) = at {
            let line = Series::line(label, [[t, low], [t, high]]).style(Style::DashDot).colour(colour);
            panel = panel.with(line);
        }
    }
    panel
}

/// Smallest and largest positive number of all curves.
fn ends_of(curves: &[Vec<[f64; 2]>]) -> [f64; 2] {
    let positive = curves.iter().flatten().map(|p| p[1]).filter(|y| *y > 0.0 && y.is_finite());
    positive.fold([f64::INFINITY, 0.0], |[low, high], y| [low.min(y), high.max(y)])
}

/// Root mean square heading error of each method, its own standard deviation, and its limit.
fn heading(title: &str, conditions: &str, results: &Results) -> Figure {
    let Results { study, scene, end, .. } = *results;
    let per_si = Quantity::Angle.shown(1e-3);
    let mut panel = Panel::new(Axis::log(format!("heading ({})", per_si.symbol)));
    let mut curves = Vec::new();
    for (i, method) in study.methods.iter().enumerate().filter(|(i, _)| !results.withheld.heading[*i]) {
        let curve = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            let rows = scene.rows[..=end].iter().enumerate();
            rows.map(|(j, &k)| [scene.time(k), value(j) * per_si.per_si]).collect()
        };
        let rms = curve(&|j| results.totals.sums[i][j].rms()[8]);
        let sigma = curve(&|j| results.sigma(i, j)[2]);
        let limit = curve(&|j| results.limits[i][j][2]);
        for (label, line, style) in
            [(method.name.as_str(), rms, Style::Line), ("", sigma, Style::Dashed), ("", limit, Style::Dotted)]
        {
            // No line where there is nothing, and none at zero on a logarithmic axis.
            if line.iter().any(|p| p[1] > 0.0) {
                curves.push(line.clone());
                panel = panel.with(Series::line(label, line).style(style).colour(Colour::palette(i)));
            }
        }
    }
    let panel = marked(panel, results, ends_of(&curves));
    Figure::new(format!("{title}: heading"), Axis::time("time"))
        .subtitle(format!("{conditions}; rms of the runs, dashed the method's own σ, dotted its limit"))
        .panel(panel)
}

/// One filter against the laws one by one: tilts and heading.
fn laws(title: &str, conditions: &str, results: &Results, filter: usize) -> Figure {
    let Results { study, scene, limit, end, .. } = *results;
    let method = &study.methods[filter];
    let measured = matches!(&method.kind, MethodKind::Filter(settings) if !settings.position);
    let name = &method.name;
    let mut figure = Figure::new(format!("{title}: {name} against the laws"), Axis::time("time")).subtitle(
        format!("{conditions}; laws of the best estimator that knows nothing before, each noise alone"),
    );
    for (axis, label) in
        AXES.iter().enumerate().filter(|(axis, _)| *axis < 2 || !results.withheld.heading[filter])
    {
        let rms = |j: usize| results.totals.sums[filter][j].rms()[6 + axis];
        let shown = Quantity::Angle.shown(rms(end));
        let curve = |value: &dyn Fn(usize, f64) -> f64| -> Vec<[f64; 2]> {
            let rows = scene.rows[..=end].iter().enumerate();
            rows.map(|(j, &k)| [scene.time(k), value(j, scene.time(k)) * shown.per_si]).collect()
        };
        let before = |t: f64, law: f64| if limit.turned(t) { f64::NAN } else { law };
        let law = |k: usize| curve(&|_, t| before(t, limit.separate(t, measured)[axis][k]));
        let stays = |t: f64| limit.left(&method.kind, &limit.means(t, |_| true))[axis];
        let lines = [
            ("rms of the runs", curve(&|j, _| rms(j)), Style::Line, Colour::palette(0)),
            ("own σ", curve(&|j, _| results.sigma(filter, j)[axis]), Style::Dashed, Colour::palette(0)),
            ("bias limit", curve(&|_, t| before(t, stays(t))), Style::Dotted, Colour::BLACK),
            ("angle random walk", law(0), Style::Dotted, Colour::palette(1)),
            ("velocity random walk", law(1), Style::Dotted, Colour::palette(2)),
            ("velocity noise", law(2), Style::Dotted, Colour::palette(3)),
        ];
        // What is far below the result is cut off.
        let [low, high] = ends_of(&[lines[0].1.clone(), lines[1].1.clone()]);
        let (low, high) = (0.03 * low, 1.5 * high);
        let mut panel = Panel::new(Axis::log(format!("{label} ({})", shown.symbol)));
        if low.is_finite() && low > 0.0 {
            panel.y = panel.y.from_to(low, high);
        }
        for (label, line, style, colour) in lines {
            if line.iter().any(|p| p[1] > 0.0) {
                panel = panel.with(Series::line(label, line).style(style).colour(colour));
            }
        }
        figure = figure.panel(marked(panel, results, [low, high]));
    }
    figure
}

/// Innovations of the first run of one filter, and the mean NIS of all filters over the runs.
fn innovations(title: &str, conditions: &str, results: &Results, filter: usize) -> Figure {
    let Results { study, scene, first, totals, end, .. } = *results;
    let position = matches!(&study.methods[filter].kind, MethodKind::Filter(settings) if settings.position);
    let unit = if position { "m" } else { "m/s" };
    let name = &study.methods[filter].name;
    let mut figure = Figure::new(format!("{title}: innovations"), Axis::time("time"))
        .subtitle(format!("{conditions}; above: the first run of `{name}`; below: mean of the runs over the updates between rows"));
    for (axis, label) in ["north", "east"].iter().enumerate() {
        let rows = || scene.rows[..=end].iter().zip(&first[filter].rows);
        let band = rows().map(|(&k, row)| {
            let three = 3.0 * row.innovation[1][axis];
            [scene.time(k), -three, three]
        });
        let curve = rows().map(|(&k, row)| [scene.time(k), row.innovation[0][axis]]);
        let largest = |part: usize| {
            let sizes = rows().map(|(_, row)| row.innovation[part][axis].abs());
            sizes.filter(|x| x.is_finite()).fold(0.0, f64::max)
        };
        let half = 1.1 * largest(0).max(3.0 * largest(1));
        let panel = Panel::new(Axis::linear(format!("{label} ({unit})")))
            .with(Series::band("±3 σ predicted", band).colour(Colour::palette(5)))
            .with(Series::line("innovation", curve).colour(Colour::palette(0)));
        figure = figure.panel(marked(panel, results, [-half, half]));
    }
    let mut panel = Panel::new(Axis::linear("NIS a degree of freedom"));
    let (mut widest, mut largest) = (Vec::new(), 0f64);
    for (i, method) in
        study.methods.iter().enumerate().filter(|(_, m)| matches!(m.kind, MethodKind::Filter(_)))
    {
        let rows = &totals.sums[i];
        let of = |j: usize| rows[j].nis_since(j.checked_sub(1).map(|before| &rows[before]));
        let times = || scene.rows[..=end].iter().enumerate().map(|(j, &k)| (j, scene.time(k)));
        widest = times()
            .map(|(j, t)| {
                let [low, high] = band(of(j).1);
                [t, low, high]
            })
            .collect();
        let line: Vec<[f64; 2]> = times().map(|(j, t)| [t, of(j).0]).collect();
        largest = line.iter().map(|p| p[1]).filter(|y| y.is_finite()).fold(largest, f64::max);
        panel = panel.with(Series::line(&method.name, line).colour(Colour::palette(i)));
    }
    panel = panel.with(Series::band("99 % band", widest).colour(Colour::GREY));
    figure.panel(marked(panel, results, [0.0, largest]))
}

/// The first run of one method with three of its own standard deviations and its limit.
fn over_time(conditions: &str, results: &Results, method: usize) -> Figure {
    let Results { study, scene, first, end, .. } = *results;
    let (name, trace, limits) = (&study.methods[method].name, &first[method], &results.limits[method]);
    let mut figure = Figure::new(name, Axis::time("time")).subtitle(format!("{conditions}; the first run"));
    let axes = if results.withheld.heading[method] { &AXES[..2] } else { &AXES[..] };
    for (axis, label) in axes.iter().enumerate() {
        let rows = || scene.rows[..=end].iter().zip(&trace.rows);
        // The size of the second half: at the beginning anything is.
        let half = rows().skip(end / 2).map(|(_, row)| row.error.phi[axis].abs());
        let sizes = half.chain(limits[end / 2..].iter().map(|limit| limit[axis]));
        let largest = sizes.filter(|x| x.is_finite()).fold(0.0, f64::max);
        let shown = Quantity::Angle.shown(largest);
        let window = 5.0 * largest * shown.per_si;
        let mut panel =
            Panel::new(Axis::linear(format!("{label} ({})", shown.symbol)).from_to(-window, window));
        if rows().any(|(_, row)| row.sigma[axis].is_finite()) {
            let band = rows().map(|(&k, row)| {
                let three = 3.0 * row.sigma[axis] * shown.per_si;
                [scene.time(k), -three, three]
            });
            panel = panel.with(Series::band("±3 σ of the method", band).colour(Colour::palette(5)));
        }
        let law = |sign: f64| {
            let rows = scene.rows[..=end].iter().zip(limits);
            rows.map(move |(&k, limit)| [scene.time(k), sign * limit[axis] * shown.per_si])
        };
        let curve = rows().map(|(&k, row)| [scene.time(k), row.error.phi[axis] * shown.per_si]);
        panel = panel.with(Series::line("error", curve).colour(Colour::palette(0)));
        if limits.iter().any(|limit| limit[axis].is_finite()) {
            panel = panel
                .with(Series::line("± limit", law(1.0)).style(Style::Dotted).colour(Colour::GREY))
                .with(Series::line("", law(-1.0)).style(Style::Dotted).colour(Colour::GREY));
        }
        figure = figure.panel(marked(panel, results, [-window, window]));
    }
    figure
}

/// Where navigation leads that begins with what each method has found; the first run.
fn drift(title: &str, conditions: &str, results: &Results) -> Figure {
    let Results { study, scene, first, end, .. } = *results;
    let mut figure = Figure::new(format!("{title}: position afterwards"), Axis::time("time"))
        .subtitle(format!("{conditions}; free inertial, the first run"));
    let rows = |trace: &'_ Trace| -> Vec<(f64, Vec3<T>)> {
        let from = |k: u64| scene.time(k - scene.samples);
        scene.rows[end..].iter().zip(&trace.rows[end..]).map(|(&k, row)| (from(k), row.error.dr)).collect()
    };
    let sizes = first.iter().flat_map(rows).flat_map(|(_, dr)| [dr[0].abs(), dr[1].abs()]);
    let shown = Quantity::Length.shown(sizes.filter(|x| x.is_finite()).fold(0.0, f64::max));
    for (axis, label) in ["north", "east"].iter().enumerate() {
        let mut panel = Panel::new(Axis::linear(format!("{label} ({})", shown.symbol)));
        for (i, (method, trace)) in study.methods.iter().zip(first).enumerate() {
            let curve = rows(trace).into_iter().map(|(t, dr)| [t, dr[axis] * shown.per_si]);
            panel = panel.with(Series::line(&method.name, curve).colour(Colour::palette(i)));
        }
        figure = figure.panel(panel);
    }
    figure
}
