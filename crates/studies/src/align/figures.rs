//! Pictures of an align study.

use schuler_frames::{T, Vec3};

use super::limit::Limit;
use super::run::Trace;
use super::scene::Scene;
use super::statistics::Totals;
use crate::figure::{Axis, Colour, Figure, Panel, Quantity, Series, Style};
use crate::scenario::{AlignStudy, MethodKind};

/// Points of an ellipse.
const ELLIPSE: usize = 90;

/// Radius of the ellipse that holds 95 % of a plane normal distribution, in standard deviations: √(-2 ln 0.05).
const IN_95: f64 = 2.447_746_830_680_816;

/// Axes of phi.
const AXES: [&str; 3] = ["φ north", "φ east", "φ down"];

/// Each method over time, all methods beside the laws, and where the runs end.
pub fn figures(
    title: &str,
    study: &AlignStudy,
    scene: &Scene,
    limit: &Limit,
    first: &[Trace],
    totals: &Totals,
    end: usize,
) -> Vec<(String, Figure)> {
    let conditions = format!(
        "latitude {:.4}°, {:.0} Hz, {} {}",
        scene.position.lat.to_degrees(),
        1.0 / scene.dt,
        study.runs,
        if study.runs == 1 { "run" } else { "runs" }
    );
    let mut figures = vec![("heading".into(), laws(title, &conditions, study, scene, limit, totals, end))];
    for (i, method) in study.methods.iter().enumerate() {
        let stem: String = method.name.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
        figures.push((stem, over_time(&method.name, &conditions, scene, limit, &first[i], end)));
    }
    if study.navigate > 0 {
        figures.push(("drift".into(), drift(title, &conditions, study, scene, first, end)));
    }
    if study.runs > 2 {
        figures.push(("ends".into(), ends(title, &conditions, study, totals)));
    }
    figures
}

/// Root mean square heading error of each method, its own standard deviation, and the limit.
fn laws(
    title: &str,
    conditions: &str,
    study: &AlignStudy,
    scene: &Scene,
    limit: &Limit,
    totals: &Totals,
    end: usize,
) -> Figure {
    let per_si = Quantity::Angle.shown(1e-3);
    let mut panel = Panel::new(Axis::log(format!("heading ({})", per_si.symbol)));
    let rows = &scene.rows[..=end];
    for (i, method) in study.methods.iter().enumerate() {
        let colour = Colour::palette(i);
        let curve = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            rows.iter().enumerate().map(|(j, &k)| [scene.time(k), value(j) * per_si.per_si]).collect()
        };
        let rms = |j: usize| totals.sums[i][j].rms()[8];
        panel = panel.with(Series::line(&method.name, curve(&rms)).colour(colour));
        if matches!(method.kind, MethodKind::Filter(_) | MethodKind::AnyHeading(_)) {
            let sigma = |j: usize| totals.sums[i][j].sigma()[2];
            panel = panel.with(Series::line("", curve(&sigma)).style(Style::Dashed).colour(colour));
        }
    }
    let law = rows.iter().map(|&k| [scene.time(k), limit.total(scene.time(k))[2] * per_si.per_si]);
    panel = panel.with(Series::line("analytic limit", law).style(Style::Dotted).colour(Colour::GREY));
    Figure::new(format!("{title}: heading"), Axis::time("time"))
        .subtitle(format!("{conditions}; rms of the runs, dashed the filter's own σ"))
        .panel(panel)
}

/// The first run of one method with three of its own standard deviations and the limit.
fn over_time(
    name: &str,
    conditions: &str,
    scene: &Scene,
    limit: &Limit,
    trace: &Trace,
    end: usize,
) -> Figure {
    let mut figure = Figure::new(name, Axis::time("time")).subtitle(format!("{conditions}; the first run"));
    for (axis, label) in AXES.iter().enumerate() {
        let rows = || scene.rows[..=end].iter().zip(&trace.rows);
        // The size of the second half: at the beginning anything is.
        let half = rows().skip(end / 2).map(|(_, row)| row.error.phi[axis].abs());
        let largest =
            half.filter(|x| x.is_finite()).fold(limit.total(scene.time(scene.samples))[axis], f64::max);
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
            scene.rows[..=end]
                .iter()
                .map(move |&k| [scene.time(k), sign * limit.total(scene.time(k))[axis] * shown.per_si])
        };
        let curve = rows().map(|(&k, row)| [scene.time(k), row.error.phi[axis] * shown.per_si]);
        panel = panel
            .with(Series::line("error", curve).colour(Colour::palette(0)))
            .with(Series::line("± analytic limit", law(1.0)).style(Style::Dotted).colour(Colour::GREY))
            .with(Series::line("", law(-1.0)).style(Style::Dotted).colour(Colour::GREY));
        figure = figure.panel(panel);
    }
    figure
}

/// Where navigation leads that begins with what each method has found; the first run.
fn drift(
    title: &str,
    conditions: &str,
    study: &AlignStudy,
    scene: &Scene,
    first: &[Trace],
    end: usize,
) -> Figure {
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

/// Tilt about north and heading of all runs at the end, with the ellipse that holds 95 % of each method.
fn ends(title: &str, conditions: &str, study: &AlignStudy, totals: &Totals) -> Figure {
    let size = |axis: usize| {
        let all = totals.finals.iter().flatten().map(|phi| phi[axis].abs()).filter(|x| x.is_finite());
        Quantity::Angle.shown(all.fold(0.0, f64::max))
    };
    let (x, y) = (size(0), size(2));
    let mut panel = Panel::new(Axis::linear(format!("φ down ({})", y.symbol)));
    for (i, (method, finals)) in study.methods.iter().zip(&totals.finals).enumerate() {
        let points: Vec<[f64; 2]> = finals
            .iter()
            .filter(|phi| phi.iter().all(|p| p.is_finite()))
            .map(|phi| [phi[0] * x.per_si, phi[2] * y.per_si])
            .collect();
        let colour = Colour::palette(i);
        panel = panel
            .with(Series::line("", ellipse(&points)).colour(colour))
            .with(Series::line(&method.name, points).style(Style::Points).colour(colour));
    }
    Figure::new(format!("{title}: end of each run"), Axis::linear(format!("φ north ({})", x.symbol)))
        .subtitle(format!("{conditions}; ellipses hold 95 % of a normal distribution"))
        .panel(panel)
}

/// The ellipse of mean and covariance of `points`.
fn ellipse(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n = points.len() as f64;
    if points.len() < 3 {
        return Vec::new();
    }
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let product = |a: usize, b: usize| {
        points.iter().map(|p| (p[a] - mean[a]) * (p[b] - mean[b])).sum::<f64>() / (n - 1.0)
    };
    // Factor of Cholesky takes the circle to the ellipse.
    let l00 = product(0, 0).sqrt();
    let l10 = if l00 > 0.0 { product(0, 1) / l00 } else { 0.0 };
    let l11 = (product(1, 1) - l10 * l10).max(0.0).sqrt();
    (0..=ELLIPSE)
        .map(|k| {
            let (s, c) = (std::f64::consts::TAU * k as f64 / ELLIPSE as f64).sin_cos();
            [mean[0] + IN_95 * l00 * c, mean[1] + IN_95 * (l10 * c + l11 * s)]
        })
        .collect()
}
