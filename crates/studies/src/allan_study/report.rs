//! The record of an Allan study.

use schuler_allan::{Fit, Parameter, Term, Verdict, to_yaml, unit};
use schuler_imu::Instrument;

use super::axis::{Axis, Found};
use super::figures;
use crate::Scenario;
use crate::record::{Record, Table};

pub fn record(scenario: &Scenario, axes: &[Axis]) -> Record {
    let mut record = Record::new(scenario, summary(axes));
    for instrument in Instrument::ALL {
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
struct Short(f64);

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

fn notes(axis: &Axis) -> Vec<String> {
    let name = &axis.name;
    let found = match &axis.found {
        Ok(found) => found,
        Err(error) => return vec![format!("{name}: {error}")],
    };
    let mut notes = Vec::new();
    if found.streamed {
        notes.push(format!("{name}: too long to keep; octaves only, other estimators and a fine search for a sinusoid are left out"));
    }
    match &found.fit {
        Err(error) => notes.push(format!("{name}: no fit: {error}")),
        Ok(fit) => notes.extend(of_fit(name, fit)),
    }
    notes.extend(of_sun(name, found));
    notes
}

fn of_fit(name: &str, fit: &Fit) -> Vec<String> {
    let mut notes = Vec::new();
    if fit.misfit {
        notes.push(format!(
            "{name}: no sum of these terms is the curve within chance; the log holds something else (motion, temperature, an \
             outlier). The fit allows for {:.0} % of error in the model's variance",
            100.0 * fit.model_error
        ));
    }
    if let Some(q) = fit.parameter(Term::Quantization).filter(|q| q.value > 0.0) {
        let share = |tau: f64| q.value * q.value * q.term.allan_variance(tau) / fit.allan_variance(tau);
        let until = (0..).map(|k| fit.tau0 * f64::from(k).exp2()).take_while(|t| share(*t) > 0.5).last();
        if let Some(tau) = until {
            notes.push(format!("{name}: quantization is more than half of the variance up to {tau:.4} s"));
        }
    }
    let hidden = |v| -> Vec<&str> {
        fit.parameters.iter().filter(|p| p.verdict == v).map(|p| p.term.name()).collect()
    };
    let unsure = hidden(Verdict::NotObservable);
    if !unsure.is_empty() {
        notes.push(format!("{name}: not observable from this log (bound above 30 %): {}", unsure.join(", ")));
    }
    notes
}

/// The paper's own method on the same points.
fn of_sun(name: &str, found: &Found) -> Option<String> {
    let sun = found.sun.as_ref()?;
    let negative: Vec<&str> =
        (0..5).filter(|k| sun.coefficients[*k] < 0.0).map(|k| Term::POWER_LAWS[k].name()).collect();
    (!negative.is_empty()).then(|| {
        format!(
            "{name}: equation (3) of the paper (plain least squares) has negative squares: {}",
            negative.join(", ")
        )
    })
}

/// Error sources of both instruments, as `imu` of a scenario has them.
fn sources(axes: &[Axis]) -> String {
    let mut text = String::from("# Error sources found by `study: allan`; a list holds the axes x, y, z.\n");
    for instrument in Instrument::ALL {
        let of: Vec<&Fit> =
            fits(axes).filter(|(a, _)| a.instrument == instrument).map(|(_, fit)| fit).collect();
        text.push_str(instrument.name());
        // A triad needs its three axes.
        if let [x, y, z] = of[..] {
            text.push_str(":\n");
            let list = to_yaml(&[x.clone(), y.clone(), z.clone()], instrument);
            text.extend(list.lines().map(|line| format!("  {line}\n")));
            if !list.lines().any(|l| l.starts_with('-')) {
                text.push_str("  []\n");
            }
        } else {
            text.push_str(": []      # not all three axes could be fitted\n");
        }
    }
    text
}
