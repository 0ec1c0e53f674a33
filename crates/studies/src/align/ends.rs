//! Where the runs end: tilt about north and heading, beside what each method and its limit say of them.

use nalgebra::Matrix2;

use super::report::Results;
use crate::figure::{Axis, Colour, Figure, Panel, Quantity, Series, Style};

/// Points of an ellipse.
const ELLIPSE: usize = 90;

/// Radius of the ellipse that holds 95 % of a plane normal distribution, in standard deviations: √(-2 ln 0.05).
const IN_95: f64 = 2.447_746_830_680_816;

/// A method that is worse than the best by more than this would leave of the others a dot.
const APART: f64 = 30.0;

/// Ends of all runs with the ellipses that hold 95 % by the runs, by the method's own covariance and by its limit.
pub fn ends(title: &str, conditions: &str, results: &Results) -> Option<Figure> {
    let rms = |i: usize| results.shown(i, results.totals.sums[i][results.end].rms());
    let count = results.study.methods.len();
    let known: Vec<usize> = (0..count).filter(|&i| rms(i)[8].is_finite()).collect();
    let best = [6, 8].map(|axis| known.iter().map(|&i| rms(i)[axis]).fold(f64::INFINITY, f64::min));
    let apart = |i: usize| rms(i)[6] > APART * best[0] || rms(i)[8] > APART * best[1];
    let (outside, inside): (Vec<usize>, Vec<usize>) = known.into_iter().partition(|&i| apart(i));
    if inside.is_empty() {
        return None;
    }
    let shown = |axis: usize| Quantity::Angle.shown(inside.iter().map(|&i| rms(i)[axis]).fold(0.0, f64::max));
    let (x, y) = (shown(6), shown(8));
    let mut panel = Panel::new(Axis::linear(format!("φ down ({})", y.symbol)));
    for &i in &inside {
        let colour = Colour::palette(i);
        let name = &results.study.methods[i].name;
        let finals = &results.totals.finals[i];
        let points: Vec<[f64; 2]> =
            finals.iter().filter(|phi| phi.iter().all(|p| p.is_finite())).map(|p| [p[0], p[2]]).collect();
        let scaled = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
            points.iter().map(|p| [p[0] * x.per_si, p[1] * y.per_si]).collect()
        };
        let (mean, runs) = moments(&points);
        let sums = &results.totals.sums[i][results.end];
        let own = sums.sigma();
        let cross = sums.cross / sums.count as f64;
        let limit = &results.squares[i];
        let kinds = [
            (mean, runs, Style::Line),
            ([0.0; 2], Matrix2::new(own[0] * own[0], cross, cross, own[2] * own[2]), Style::Dashed),
            (
                [0.0; 2],
                Matrix2::new(limit[(0, 0)], limit[(0, 2)], limit[(0, 2)], limit[(2, 2)]),
                Style::Dotted,
            ),
        ];
        for (centre, covariance, style) in kinds {
            let line = scaled(&ellipse(centre, &covariance));
            panel = panel.with(Series::line("", line).style(style).colour(colour));
        }
        panel = panel.with(Series::line(name, scaled(&points)).style(Style::Points).colour(colour));
    }
    let far: Vec<&str> = outside.iter().map(|&i| results.study.methods[i].name.as_str()).collect();
    let far = if far.is_empty() { String::new() } else { format!("; far outside: {}", far.join(", ")) };
    Some(
        Figure::new(format!("{title}: end of each run"), Axis::linear(format!("φ north ({})", x.symbol)))
            .subtitle(format!(
                "{conditions}; 95 % ellipses: of the runs, dashed by the method's own σ, dotted by its limit{far}"
            ))
            .panel(panel),
    )
}

/// Mean and covariance of `points`.
fn moments(points: &[[f64; 2]]) -> ([f64; 2], Matrix2<f64>) {
    let n = points.len() as f64;
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let product = |a: usize, b: usize| {
        points.iter().map(|p| (p[a] - mean[a]) * (p[b] - mean[b])).sum::<f64>() / (n - 1.0)
    };
    (mean, Matrix2::from_fn(product))
}

/// The ellipse about `mean`; empty where the covariance is not there.
fn ellipse(mean: [f64; 2], covariance: &Matrix2<f64>) -> Vec<[f64; 2]> {
    if !covariance.iter().all(|x| x.is_finite()) {
        return Vec::new();
    }
    // Factor of Cholesky takes the circle to the ellipse.
    let l00 = covariance[(0, 0)].sqrt();
    let l10 = if l00 > 0.0 { covariance[(0, 1)] / l00 } else { 0.0 };
    let l11 = (covariance[(1, 1)] - l10 * l10).max(0.0).sqrt();
    (0..=ELLIPSE)
        .map(|k| {
            let (s, c) = (std::f64::consts::TAU * k as f64 / ELLIPSE as f64).sin_cos();
            [mean[0] + IN_95 * l00 * c, mean[1] + IN_95 * (l10 * c + l11 * s)]
        })
        .collect()
}
