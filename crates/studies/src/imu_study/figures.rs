//! The two figures of a measurement study: gyro errors and accelerometer errors, three axes each.

use super::theory::Theory;
use crate::{
    Scenario,
    figure::{Axis, Figure, Panel, Quantity, Series, Style},
    record::Table,
    scenario::ImuStudy,
};

const INSTRUMENTS: [(&str, &str, Quantity); 2] = [
    ("gyro_errors", "Gyro errors", Quantity::AngularRate),
    ("accel_errors", "Accelerometer errors", Quantity::Acceleration),
];

/// Errors of each axis over the samples, with the mean that theory expects.
pub fn figures(
    scenario: &Scenario,
    study: &ImuStudy,
    errors: &Table,
    theory: &Theory,
) -> Vec<(String, Figure)> {
    let times = errors.numbers("t_s").unwrap_or_default();
    let samples: Vec<f64> = times.iter().map(|t| (t * study.imu.rate).round()).collect();
    let figure = |(i, (stem, title, quantity)): (usize, (&str, &str, Quantity))| {
        let columns: Vec<&[f64]> = errors.columns[1 + 3 * i..4 + 3 * i]
            .iter()
            .map(|column| errors.numbers(column.name()).unwrap_or_default())
            .collect();
        let largest = columns.iter().copied().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        let shown = quantity.shown(largest);
        let mut figure = Figure::new(title, Axis::linear("sample")).subtitle(conditions(scenario, study));
        for (j, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let points = samples.iter().zip(columns[j]).map(|(k, e)| [*k, e * shown.per_si]);
            let mut panel = Panel::new(Axis::linear(format!("{axis} ({})", shown.symbol)))
                .with(Series::line("error", points));
            if let (Some(first), Some(last)) = (samples.first(), samples.last()) {
                let mean = theory.expected(i, j).mean[0] * shown.per_si;
                let line = [[*first, mean], [*last, mean]];
                panel = panel.with(Series::line("mean by theory", line).style(Style::Dashed));
            }
            figure = figure.panel(panel);
        }
        (stem.to_string(), figure)
    };
    INSTRUMENTS.into_iter().enumerate().map(figure).collect()
}

/// Title, motion, rate and seed in a line.
pub fn conditions(scenario: &Scenario, study: &ImuStudy) -> String {
    let motion = study.motion.words();
    format!("{}: {motion}, {} Hz, seed {}", scenario.title, study.imu.rate, scenario.seed)
}
