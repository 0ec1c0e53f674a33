//! The record of an Allan study.

use schuler_allan::{Fit, Parameter, Term, Verdict, to_yaml, unit};
use schuler_imu::Instrument;

use super::axis::Axis;
use super::figures;
use super::notes::notes;
use crate::Scenario;
use crate::record::{Record, Table};

pub fn record(scenario: &Scenario, axes: &[Axis]) -> Record {
    let mut record = Record::new(scenario, summary(axes));
    for instrument in Instrument::ALL.into_iter().filter(|i| axes.iter().any(|a| a.instrument == *i)) {
        record.tables.push(estimates(axes, instrument));
    }
    record.tables.push(parameters(axes));
    record.notes = axes.iter().flat_map(notes).collect();
    record.texts.push(("sources.yaml".into(), sources(axes)));
    if scenario.output.formats.png || scenario.output.formats.svg {
        let figure = |axis: &Axis| {
            let found = axis.found.as_ref().ok()?;
            Some((axis.name.replace('.', "_"), figures::figure(&scenario.title, axis, found)))
        };
        record.figures = axes.iter().filter_map(figure).collect();
    }
    record
}

fn fits(axes: &[Axis]) -> impl Iterator<Item = (&Axis, &Fit)> {
    axes.iter().filter_map(|axis| Some((axis, axis.found.as_ref().ok()?.fit.as_ref().ok()?)))
}

fn verdict(p: &Parameter) -> &'static str {
    match p.verdict {
        Verdict::Seen => "seen",
        Verdict::NotObservable => "not observable",
        Verdict::Bounded => "bounded",
    }
}

/// In the units of the field, as text.
fn summary(axes: &[Axis]) -> Table {
    let names = ["axis", "term", "value", "standard_error", "interval_95", "bound_percent", "verdict"];
    let words: Vec<&str> = names.iter().copied().filter(|n| *n != "bound_percent").collect();
    let mut table = Table::new("summary", &names, &words);
    for (axis, fit) in fits(axes) {
        for p in &fit.parameters {
            let (unit, size) = unit(axis.instrument, p.term);
            let digits =
                |v: f64| if v.is_finite() { format!("{}", Short(v / size)) } else { "no limit".into() };
            let (low, high) = p.interval;
            let shape = match (p.term, p.shape_error) {
                (Term::Markov { tau }, Some(e)) => format!(", tau {} ± {} s", Short(tau), Short(e)),
                (Term::Sinusoid { f0 }, Some(e)) => format!(", {} ± {} Hz", Short(f0), Short(e)),
                _ => String::new(),
            };
            let bounded = p.verdict == Verdict::Bounded;
            let value = if bounded { "-".into() } else { format!("{} {unit}{shape}", digits(p.value)) };
            let error = if bounded { "-".into() } else { digits(p.standard_error) };
            let interval = if bounded {
                format!("< {} {unit}", digits(high))
            } else {
                format!("{} .. {}", digits(low), digits(high))
            };
            let bound = if p.bound.is_finite() { 100.0 * p.bound } else { f64::NAN };
            table.push(&[
                axis.name.as_str().into(),
                p.term.name().into(),
                value.as_str().into(),
                error.as_str().into(),
                interval.as_str().into(),
                bound.into(),
                verdict(p).into(),
            ]);
        }
    }
    table
}

/// Four digits, with an exponent where they would be lost among zeros.
pub struct Short(pub f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let size = self.0.abs();
        if size == 0.0 {
            f.write_str("0")
        } else if (1e-4..1e5).contains(&size) {
            let digits = (3 - size.log10().floor() as i32).max(0) as usize;
            write!(f, "{:.digits$}", self.0)
        } else {
            write!(f, "{:.3e}", self.0)
        }
    }
}

fn parameters(axes: &[Axis]) -> Table {
    let names = [
        "axis",
        "term",
        "value_si",
        "standard_error_si",
        "low_si",
        "high_si",
        "shape_si",
        "shape_error_si",
        "bound",
        "verdict",
    ];
    let mut table = Table::new("parameters", &names, &["axis", "term", "verdict"]);
    for (axis, fit) in fits(axes) {
        for p in &fit.parameters {
            table.push(&[
                axis.name.as_str().into(),
                p.term.name().into(),
                p.value.into(),
                p.standard_error.into(),
                p.interval.0.into(),
                p.interval.1.into(),
                p.term.shape().unwrap_or(f64::NAN).into(),
                p.shape_error.unwrap_or(f64::NAN).into(),
                p.bound.into(),
                verdict(p).into(),
            ]);
        }
    }
    table
}

fn estimates(axes: &[Axis], instrument: Instrument) -> Table {
    let (unit, name) = match instrument {
        Instrument::Gyro => ("radps", "allan_gyro"),
        Instrument::Accel => ("mps2", "allan_accel"),
    };
    let columns = ["deviation", "low", "high", "model"].map(|c| format!("{c}_{unit}"));
    let names = ["axis", "estimator", "tau_s", &columns[0], &columns[1], &columns[2], "edf", &columns[3]];
    let mut table = Table::new(name, &names, &["axis", "estimator"]);
    for axis in axes.iter().filter(|a| a.instrument == instrument) {
        let Ok(found) = &axis.found else { continue };
        for e in found.curves.iter().flatten() {
            // The model is one of the Allan variance, not of its relatives.
            let model = match (&found.fit, e.estimator) {
                (Ok(fit), schuler_allan::Estimator::Overlapping) => fit.allan_variance(e.point.tau).sqrt(),
                _ => f64::NAN,
            };
            table.push(&[
                axis.name.as_str().into(),
                format!("{:?}", e.estimator).to_lowercase().as_str().into(),
                e.point.tau.into(),
                e.point.deviation().into(),
                e.low.into(),
                e.high.into(),
                e.edf.into(),
                model.into(),
            ]);
        }
    }
    table
}

/// Error sources of both instruments, as `imu` of a scenario has them.
fn sources(axes: &[Axis]) -> String {
    let mut text = String::from("# Error sources found by `study: allan`; a list holds the axes x, y, z.\n");
    for instrument in Instrument::ALL {
        let there: Vec<&Axis> = axes.iter().filter(|a| a.instrument == instrument).collect();
        let fit = |axis: &&Axis| axis.found.as_ref().ok().and_then(|found| found.fit.as_ref().ok()).cloned();
        let mut fits: Vec<Option<Fit>> = there.iter().map(fit).collect();
        text.push_str(instrument.name());
        if fits.iter().all(Option::is_none) {
            let why = if there.is_empty() { "not in this log" } else { "no axis could be fitted" };
            text += &format!(": []      # {why}\n");
            continue;
        }
        text.push_str(":\n");
        if fits.len() == 1 {
            text += "  # One axis in this log: taken for all three.\n";
        } else {
            fits.resize(3, None);
            for (axis, _) in ["x", "y", "z"].iter().zip(&fits).filter(|(_, fit)| fit.is_none()) {
                text += &format!("  # {axis}: not in this log, or without a fit; without errors here.\n");
            }
        }
        let fits: Vec<Fit> = fits.into_iter().map(|fit| fit.unwrap_or(NOTHING)).collect();
        let list = to_yaml(&fits, instrument);
        text.extend(list.lines().map(|line| format!("  {line}\n")));
        if !list.lines().any(|l| l.starts_with('-')) {
            text.push_str("  []\n");
        }
    }
    text
}

/// Of an axis that is not known.
const NOTHING: Fit = Fit {
    parameters: Vec::new(),
    chi2: 0.0,
    freedom: 0,
    misfit: false,
    model_error: 0.0,
    tau0: f64::INFINITY,
    duration: 0.0,
};
