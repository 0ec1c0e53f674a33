//! Allan deviations of a measurement study: closed forms of each source and of their sum, and the estimate.

use schuler_allan::{Curve, Estimator, Grid, Phase};
use schuler_imu::{Component, Input, Instrument, Spec, Truth};

use crate::{
    figure::{Axis, Figure, Panel, Quantity, Series, Style},
    record::{Table, columns},
};

/// Averaging times in a decade.
const PER_DECADE: u32 = 20;

/// `source` of the sum of all sources.
pub const SUM: &str = "sum";

/// `source` of the estimate from the samples.
const SIMULATED: &str = "simulated";

/// An estimate at a longer averaging time than this part of the run says next to nothing.
const SHARE: f64 = 4.0;

/// Errors of each axis of each instrument, sample by sample.
#[derive(Default)]
pub struct Errors([[Vec<f64>; 3]; 2]);

impl Errors {
    /// One sample more.
    pub fn push(&mut self, errors: Axes) {
        for (all, error) in self.0.as_flattened_mut().iter_mut().zip(errors.as_flattened()) {
            all.push(*error);
        }
    }

    /// Overlapping Allan deviations at the averaging factors, of each axis; zero where an axis has no error and
    /// beyond [`SHARE`].
    fn deviations(&self, factors: &[usize], dt: f64) -> [[Vec<f64>; 3]; 2] {
        [0, 1].map(|i| [0, 1, 2].map(|j| deviations(&self.0[i][j], factors, dt)))
    }
}

fn deviations(errors: &[f64], factors: &[usize], dt: f64) -> Vec<f64> {
    let grid = Grid::Factors(factors.to_vec());
    let some = errors.iter().any(|error| *error != 0.0);
    let phase = some.then(|| Phase::from_rate(errors, dt).ok()).flatten();
    // Nothing but a run of a sample or two has no estimate at all.
    let curve = phase.and_then(|phase| Curve::estimate(&phase, Estimator::Overlapping, &grid).ok());
    let points = curve.map_or(Vec::new(), |curve| curve.up_to(SHARE).points);
    let at = |m: &usize| points.iter().find(|p| p.m == *m).map_or(0.0, |p| p.deviation());
    factors.iter().map(at).collect()
}

/// One number for each axis of each instrument.
type Axes = [[f64; 3]; 2];

/// What a source does to the errors of an instrument whose input does not change.
struct Contribution {
    name: String,
    components: Vec<Part>,
}

/// A component with its column of the regressor.
struct Part {
    component: Component,
    column: [f64; 3],
}

/// Allan variances of all sources.
pub struct Theory {
    contributions: Vec<Contribution>,
}

impl Theory {
    /// Of the sources of `spec` under `truth`, sampled every `dt` seconds.
    pub fn new(spec: &Spec, truth: &Truth, dt: f64) -> Self {
        let inputs = Instrument::ALL.map(|i| Input::new(i, truth, dt, spec.calibration_temperature));
        let part = |component: Component| {
            let input = &inputs[component.instrument() as usize];
            Part { component, column: component.term().regressor(input).columns()[component.coefficient()] }
        };
        let contributions = spec
            .sources()
            .map(|s| Contribution {
                name: s.name().to_string(),
                components: s.components().map(part).collect(),
            })
            .collect();
        Theory { contributions }
    }

    /// Allan deviations at `tau` by source, and of the sum: independent random parts add as variances, known ramps
    /// as they are.
    fn deviations(&self, tau: f64) -> (Vec<(&str, Axes)>, Axes) {
        let (mut all_variance, mut all_slope) = (Axes::default(), Axes::default());
        let mut of_sources = Vec::new();
        for contribution in &self.contributions {
            let (mut variance, mut slope) = (Axes::default(), Axes::default());
            for Part { component, column } in &contribution.components {
                let i = component.instrument() as usize;
                let evolution = component.evolution();
                match evolution.deterministic() {
                    Some(known) => (0..3).for_each(|j| slope[i][j] += column[j] * known.rate),
                    None => {
                        let v = evolution.allan_variance(tau);
                        (0..3).for_each(|j| variance[i][j] += column[j] * column[j] * v);
                    }
                }
            }
            of_sources.push((contribution.name.as_str(), deviation(&variance, &slope, tau)));
            for (i, j) in (0..6).map(|k| (k / 3, k % 3)) {
                all_variance[i][j] += variance[i][j];
                all_slope[i][j] += slope[i][j];
            }
        }
        (of_sources, deviation(&all_variance, &all_slope, tau))
    }

    /// `allan.csv`: at each averaging time, up to half of the run, a row for each source with an Allan deviation, for
    /// the sum and for the estimate.
    pub fn table(&self, errors: &Errors, samples: u64, dt: f64) -> Table {
        let mut table = Table::new("allan", &columns::ALLAN, &["source"]);
        let factors = Grid::PerDecade(PER_DECADE).factors(samples as usize / 2);
        let simulated = errors.deviations(&factors, dt);
        for (k, m) in factors.iter().enumerate() {
            let tau = *m as f64 * dt;
            let (of_sources, sum) = self.deviations(tau);
            let estimate = simulated.each_ref().map(|axes| axes.each_ref().map(|axis| axis[k]));
            for (name, axes) in of_sources.into_iter().chain([(SUM, sum), (SIMULATED, estimate)]) {
                if axes.as_flattened().iter().any(|deviation| *deviation > 0.0) || name == SUM {
                    push(&mut table, tau, name, &axes);
                }
            }
        }
        table
    }
}

fn push(table: &mut Table, tau: f64, name: &str, axes: &Axes) {
    let [[gx, gy, gz], [ax, ay, az]] = *axes;
    let numbers = [gx, gy, gz, ax, ay, az].map(crate::record::Cell::Number);
    let [gx, gy, gz, ax, ay, az] = numbers;
    table.push(&[tau.into(), name.into(), gx, gy, gz, ax, ay, az]);
}

/// Interval means of a ramp R differ by R tau from one to the next.
fn deviation(variance: &Axes, slope: &Axes, tau: f64) -> Axes {
    [0, 1].map(|i| [0, 1, 2].map(|j| (variance[i][j] + 0.5 * (slope[i][j] * tau).powi(2)).sqrt()))
}

/// A figure for each instrument that has Allan deviations: one panel where its axes are alike, else one for each.
pub fn figures(table: &Table, conditions: &str) -> Vec<(String, Figure)> {
    let instruments = [
        ("gyro_allan", "Allan deviation of the gyro errors", Quantity::AngularRate),
        ("accel_allan", "Allan deviation of the accelerometer errors", Quantity::Acceleration),
    ];
    let columns: Vec<&[f64]> =
        columns::ALLAN[2..].iter().map(|name| table.numbers(name).unwrap_or_default()).collect();
    let figure = |(i, (stem, title, quantity)): (usize, (&str, &str, Quantity))| {
        let axes = &columns[3 * i..3 * i + 3];
        let largest = axes.iter().copied().flatten().fold(0.0, |m: f64, x| m.max(*x));
        if largest == 0.0 {
            return None;
        }
        let shown = quantity.shown(largest);
        let all: Vec<_> = axes.iter().map(|axis| curves(table, axis)).collect();
        let alike = all.iter().all(|axis| theory(axis).eq(theory(&all[0])));
        let mut figure = Figure::new(title, Axis::log("averaging time (s)")).subtitle(conditions);
        let panels: &[(&str, &[usize])] =
            if alike { &[("x, y, z", &[0, 1, 2])] } else { &[("x", &[0]), ("y", &[1]), ("z", &[2])] };
        for (label, axes) in panels {
            let (low, high) = range(&all[axes[0]], shown.per_si);
            // A sinusoid falls to nothing at whole periods; the line then leaves the picture.
            let line = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
                points.iter().map(|[tau, y]| [*tau, (y * shown.per_si).max(0.1 * low)]).collect()
            };
            let mut panel = Panel::new(Axis::log(format!("{label} ({})", shown.symbol)).from_to(low, high));
            for (name, points) in theory(&all[axes[0]]) {
                let style = if name == SUM { Style::Line } else { Style::Dashed };
                panel = panel.with(Series::line(name, line(points)).style(style));
            }
            for &j in *axes {
                for (name, points) in all[j].iter().filter(|(name, _)| name == SIMULATED) {
                    let name = if alike { format!("{name}, {}", ["x", "y", "z"][j]) } else { name.clone() };
                    panel = panel.with(Series::line(name, line(points)).style(Style::Points));
                }
            }
            figure = figure.panel(panel);
        }
        Some((stem.to_string(), figure))
    };
    instruments.into_iter().enumerate().filter_map(figure).collect()
}

/// A curve by the name of its source.
type Named = (String, Vec<[f64; 2]>);

/// The closed forms among curves.
fn theory(curves: &[Named]) -> impl Iterator<Item = &Named> {
    curves.iter().filter(|(name, _)| name != SIMULATED)
}

/// Decades around the sum, with room for the sources below it.
fn range(curves: &[Named], per_si: f64) -> (f64, f64) {
    let sum = curves.iter().filter(|(name, _)| name == SUM).flat_map(|(_, points)| points);
    let (low, high) = sum
        .map(|[_, y]| y * per_si)
        .fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), y| (low.min(y), high.max(y)));
    let decade = |y: f64, round: fn(f64) -> f64| 10f64.powf(round(y.log10()));
    (decade(0.1 * low, f64::floor), decade(high, f64::ceil))
}

/// The curve of each source in a column, without those that are zero.
fn curves(table: &Table, column: &[f64]) -> Vec<Named> {
    let times = table.numbers("t_s").unwrap_or_default();
    let Some(crate::record::Column::Word { words, codes, .. }) = table.column("source") else {
        return Vec::new();
    };
    let curve = |(code, name): (usize, &String)| {
        let points: Vec<[f64; 2]> = codes
            .iter()
            .zip(times.iter().zip(column))
            .filter(|(c, (_, y))| **c as usize == code && **y > 0.0)
            .map(|(_, (tau, y))| [*tau, *y])
            .collect();
        (!points.is_empty()).then(|| (name.clone(), points))
    };
    words.iter().enumerate().filter_map(curve).collect()
}
