//! Tables and remarks of a Monte Carlo.

use rayon::prelude::*;
use schuler_imu::Component;

use super::bands::share_interval;
use super::prediction::Predicted;
use super::scene::Scene;
use super::statistics::{HORIZONTAL, QUANTITIES, Statistics, verdict};
use crate::{
    record::{Cell, Table, columns},
    scenario::RunFigure,
};

/// Columns of the summary: each error at the end, SI.
const SUMMARY: [&str; 12] = [
    "source",
    "mean",
    "sd",
    "low",
    "high",
    "predicted",
    "q50",
    "predicted_q50",
    "q95",
    "predicted_q95",
    "variance_ratio",
    "band",
];

/// Shares of the runs that `monte_carlo.csv` has quantiles of.
fn quantiles() -> impl Iterator<Item = f64> {
    RunFigure::ALL.into_iter().filter_map(|(_, figure)| match figure {
        RunFigure::Quantile(p) => Some(p),
        RunFigure::Deviation | RunFigure::Rms => None,
    })
}

/// Each error at the end beside its prediction.
pub fn summary(statistics: &Statistics, predicted: Option<&[Predicted]>) -> Table {
    let mut table = Table::new("summary", &SUMMARY, &["source", "band"]);
    let row = statistics.rows() - 1;
    let predicted = predicted.and_then(|rows| rows.last());
    for (k, name) in columns::MONTE_CARLO[3..].iter().enumerate() {
        let sd = statistics.figure(row, k, RunFigure::Deviation);
        let verdict = predicted.and_then(|p| verdict(statistics, row, k, p));
        let quantile = |p| Cell::from(statistics.figure(row, k, RunFigure::Quantile(p)).value);
        let expected = |share| Cell::from(predicted.map_or(f64::NAN, |p| p.quantile(k, share)));
        table.push(&[
            (*name).into(),
            statistics.mean(row, k).value.into(),
            sd.value.into(),
            sd.low.into(),
            sd.high.into(),
            predicted.map_or(f64::NAN, |p| p.sd(k)).into(),
            quantile(0.5),
            expected(0.5),
            quantile(0.95),
            expected(0.95),
            verdict.map_or(f64::NAN, |v| v.ratio).into(),
            verdict.map_or("-", |v| if v.holds() { "inside" } else { "outside" }).into(),
        ]);
    }
    table
}

/// `monte_carlo.csv`, `exceedance.csv`, `nees.csv`.
pub fn tables(scene: &Scene, statistics: &Statistics, predicted: Option<&[Predicted]>) -> Vec<Table> {
    let mut figures = Table::new("monte_carlo", &columns::MONTE_CARLO, &["source", "way"]);
    let mut exceedance = Table::new("exceedance", &columns::EXCEEDANCE, &["source"]);
    let mut nees = Table::new("nees", &columns::RUNS_NEES, &[]);
    // They take longer than all else here.
    let of_row = |p: &Predicted| -> Vec<[f64; QUANTITIES]> {
        quantiles().map(|share| std::array::from_fn(|k| p.quantile(k, share))).collect()
    };
    let expected: Option<Vec<_>> = predicted.map(|rows| rows.par_iter().map(of_row).collect());
    for (row, &sample) in scene.rows.iter().enumerate() {
        let t = scene.time(sample);
        let mut push = |source: &str, way: &str, value: &dyn Fn(usize) -> f64| {
            let mut cells: Vec<Cell> = vec![t.into(), source.into(), way.into()];
            cells.extend((0..QUANTITIES).map(|k| Cell::from(value(k))));
            figures.push(&cells);
        };
        let ways =
            std::iter::once(("mean", None)).chain(RunFigure::ALL.map(|(way, figure)| (way, Some(figure))));
        for (way, figure) in ways {
            let all: [_; QUANTITIES] = std::array::from_fn(|k| match figure {
                None => statistics.mean(row, k),
                Some(figure) => statistics.figure(row, k, figure),
            });
            push("estimate", way, &|k| all[k].value);
            push("low", way, &|k| all[k].low);
            push("high", way, &|k| all[k].high);
            if let Some(p) = predicted.map(|rows| &rows[row]) {
                match figure {
                    None => push("predicted", way, &|k| p.mean(k)),
                    Some(RunFigure::Deviation) => push("predicted", way, &|k| p.sd(k)),
                    Some(RunFigure::Rms) => push("predicted", way, &|k| p.rms(k)),
                    Some(RunFigure::Quantile(share)) => {
                        let place = quantiles().position(|known| known == share);
                        let of = place.and_then(|place| Some(&expected.as_ref()?[row][place]));
                        push("predicted", way, &|k| of.map_or(f64::NAN, |of| of[k]));
                    }
                }
            }
        }
        for (k, threshold) in scene.study.thresholds.iter().enumerate() {
            let (beyond, runs) = (statistics.beyond(row, k), statistics.runs);
            let [low, high] = share_interval(beyond, runs);
            let share = beyond as f64 / runs as f64;
            let predicted =
                predicted.map_or(f64::NAN, |rows| rows[row].beyond(threshold.quantity, threshold.limit));
            let cells: [Cell; 8] = [
                t.into(),
                threshold.name.as_str().into(),
                (beyond as f64).into(),
                (runs as f64).into(),
                share.into(),
                low.into(),
                high.into(),
                predicted.into(),
            ];
            exceedance.push(&cells);
        }
        if let Some((found, freedom)) = statistics.nees(row) {
            nees.push(&[t, found.value, found.low, found.high, freedom as f64].map(Cell::from));
        }
    }
    let mut tables = vec![figures];
    tables.extend([exceedance, nees].into_iter().filter(|table| !table.is_empty()));
    tables
}

/// What a reader of the numbers must know.
pub fn notes(
    scene: &Scene,
    statistics: &Statistics,
    predicted: &Result<Vec<Predicted>, String>,
) -> Vec<String> {
    let mut notes = vec![format!(
        "{} runs; low and high are the ends of 99 % confidence intervals, q50 and q95 the magnitudes that half and 95 % of the runs do not exceed; all in SI",
        statistics.runs
    )];
    match predicted {
        Err(why) => notes.push(why.clone()),
        Ok(predicted) => {
            let (mut all, mut outside) = (0, 0);
            for (row, p) in predicted.iter().enumerate() {
                for k in 0..HORIZONTAL {
                    if let Some(verdict) = verdict(statistics, row, k, p) {
                        all += 1;
                        outside += usize::from(!verdict.holds());
                    }
                }
            }
            notes.push(format!(
                "Over all rows {outside} of {all} sampled variances are outside their 99 % chi-square band about the predicted covariance; rows of one run hang together"
            ));
            let end = statistics.rows() - 1;
            let (mut all, mut outside, mut few) = (0, 0, 0);
            for k in (0..QUANTITIES).filter(|&k| predicted[end].sd(k) > 0.0) {
                for share in quantiles() {
                    let found = statistics.figure(end, k, RunFigure::Quantile(share));
                    if !found.high.is_finite() {
                        few += 1;
                        continue;
                    }
                    all += 1;
                    outside +=
                        usize::from(!(found.low..=found.high).contains(&predicted[end].quantile(k, share)));
                }
            }
            notes.push(format!(
                "At the end {outside} of {all} predicted quantiles are outside the 99 % confidence interval of those of the runs{}",
                if few == 0 {
                    String::new()
                } else {
                    format!("; {few} more have no such interval, the runs being too few")
                }
            ));
        }
    }
    if let Some((nees, freedom)) = statistics.nees(statistics.rows() - 1) {
        let inside = (nees.low..=nees.high).contains(&nees.value);
        notes.push(format!(
            "At the end NEES is {:.4} a degree of freedom, {} its 99 % band [{:.4}, {:.4}] ({freedom} degrees of freedom a run)",
            nees.value,
            if inside { "inside" } else { "outside" },
            nees.low,
            nees.high
        ));
    }
    if scene.study.imu.spec.readout.is_some() && predicted.is_ok() {
        notes.push("The prediction knows nothing of the readout".into());
    }
    let rounds = |c: &Component| c.evolution().kind.name() == "quantization";
    if predicted.is_ok() && scene.study.imu.spec.components().any(|c| rounds(&c)) {
        notes.push("The prediction knows nothing of rounding by `quantization`; `study: budget` does".into());
    }
    notes
}
