use std::f64::consts::PI;
use std::fmt::Write as _;

use schuler_imu::{Instrument, Source, Value};

use crate::{Fit, Parameter, Term, Verdict};

const HOUR: f64 = 3600.0;
const DEG: f64 = PI / 180.0;
/// Standard gravity (m/s²), exact by definition (3rd CGPM 1901); the `g` of the scenario language.
const G: f64 = 9.806_65;

/// Unit that people in the field use for the coefficient of `term` on an instrument, and its size in SI.
#[must_use]
pub fn unit(instrument: Instrument, term: Term) -> (&'static str, f64) {
    match (instrument, term) {
        (Instrument::Gyro, Term::Quantization) => ("arcsec", DEG / 3600.0),
        (Instrument::Gyro, Term::White) => ("deg/sqrt(h)", DEG / HOUR.sqrt()),
        (Instrument::Gyro, Term::RandomWalk) => ("deg/h/sqrt(h)", DEG / HOUR / HOUR.sqrt()),
        (Instrument::Gyro, Term::Ramp) => ("deg/h/h", DEG / HOUR / HOUR),
        (Instrument::Gyro, _) => ("deg/h", DEG / HOUR),
        (Instrument::Accel, Term::Quantization) => ("m/s", 1.0),
        (Instrument::Accel, Term::White) => ("ug/sqrt(Hz)", 1e-6 * G),
        (Instrument::Accel, Term::RandomWalk) => ("ug/sqrt(h)", 1e-6 * G / HOUR.sqrt()),
        (Instrument::Accel, Term::Ramp) => ("ug/h", 1e-6 * G / HOUR),
        (Instrument::Accel, _) => ("ug", 1e-6 * G),
    }
}

/// A bias with a process of the error model, SI.
struct Entry {
    term: Term,
    process: &'static str,
    /// Name of the coefficient, and its value for each axis.
    coefficient: (&'static str, Vec<f64>),
    /// Other parameters with their unit.
    others: Vec<(&'static str, f64, &'static str)>,
}

/// One entry for each power law that is seen on some axis, one for each axis with a Markov process or a sinusoid:
/// their shapes differ between axes.
fn entries(fits: &[Fit]) -> Vec<Entry> {
    let value = |p: Option<&Parameter>| p.filter(|p| seen(p)).map_or(0.0, |p| p.value);
    let laws =
        Term::POWER_LAWS.into_iter().map(|t| (t, fits.iter().map(|f| value(f.parameter(t))).collect()));
    let shaped = fits.iter().enumerate().flat_map(|(axis, fit)| {
        fit.parameters.iter().filter(|p| p.term.shape().is_some()).map(move |p| {
            let mut values = vec![0.0; fits.len()];
            values[axis] = value(Some(p));
            (p.term, values)
        })
    });
    laws.chain(shaped)
        .filter(|(_, values): &(Term, Vec<f64>)| values.iter().any(|v| *v > 0.0))
        .map(|(term, values)| {
            let (process, name, others) = process(term, fits);
            Entry { term, process, coefficient: (name, values), others }
        })
        .collect()
}

type Process = (&'static str, &'static str, Vec<(&'static str, f64, &'static str)>);

/// Process of the error model, name of its coefficient, other parameters.
fn process(term: Term, fits: &[Fit]) -> Process {
    match term {
        Term::Quantization => ("quantization", "q", vec![]),
        Term::White => ("white", "density", vec![]),
        Term::Flicker => {
            // Flicker needs a band: what the logs can have seen.
            let first = fits.iter().map(|f| f.tau0).fold(f64::INFINITY, f64::min);
            let last = fits.iter().map(|f| f.duration).fold(0.0, f64::max);
            ("flicker", "instability", vec![("tau_min", first, "s"), ("tau_max", last, "s")])
        }
        Term::RandomWalk => ("random_walk", "density", vec![]),
        // The sign of a ramp does not show in a variance; up is as good as down.
        Term::Ramp => ("ramp", "rate", vec![]),
        Term::Markov { tau } => ("gauss_markov", "sigma", vec![("tau", tau, "s")]),
        Term::Sinusoid { f0 } => ("sinusoid", "amplitude", vec![("frequency", f0, "Hz")]),
    }
}

/// The fits of one axis (taken for all three) or of three axes of an instrument as error sources, seen terms only.
///
/// # Errors
/// Neither one nor three fits.
pub fn to_sources(fits: &[Fit], instrument: Instrument) -> Result<Vec<Source>, schuler_imu::Error> {
    entries(fits)
        .iter()
        .map(|e| {
            let (name, values) = &e.coefficient;
            let value = if let [one] = values[..] { Value::Same(one) } else { Value::Each(values) };
            let given: Vec<(&str, Value<'_>)> = std::iter::once((*name, value))
                .chain(e.others.iter().map(|o| (o.0, Value::Same(o.1))))
                .collect();
            Source::named(instrument, "bias", e.process, &given)
        })
        .collect()
}

/// [`to_sources`] in YAML, as a scenario has them: a source for each term that is seen on some axis, a comment for
/// the rest.
#[must_use]
pub fn to_yaml(fits: &[Fit], instrument: Instrument) -> String {
    let mut out = String::new();
    for e in entries(fits) {
        let (text, size) = unit(instrument, e.term);
        let values: Vec<String> = e.coefficient.1.iter().map(|v| quantity(v / size, text)).collect();
        let mut given = format!("{}: {}", e.coefficient.0, list(&values));
        for (name, value, unit) in &e.others {
            let _ = write!(given, ", {name}: {}", quantity(*value, unit));
        }
        let _ = writeln!(out, "- bias: {{ {}: {{ {given} }} }}", e.process);
    }
    for (axis, fit) in fits.iter().enumerate() {
        for p in fit.parameters.iter().filter(|p| !seen(p)) {
            comment(&mut out, p, axis, fits.len(), instrument);
        }
    }
    out
}

fn seen(p: &Parameter) -> bool {
    p.verdict == Verdict::Seen
}

fn comment(out: &mut String, p: &Parameter, axis: usize, axes: usize, instrument: Instrument) {
    let (text, size) = unit(instrument, p.term);
    let axis = if axes > 1 { format!(" {}", ["x", "y", "z"][axis.min(2)]) } else { String::new() };
    let limit = p.interval.1 / size;
    let what = if p.verdict == Verdict::NotObservable {
        format!("not observable from this log (about {})", quantity(p.value / size, text))
    } else if limit.is_finite() {
        format!("not seen; below {} with 97.5 % confidence", quantity(limit, text))
    } else {
        "not seen; this log sets no limit".to_owned()
    };
    let _ = writeln!(out, "#{axis} {}: {what}", p.term.name());
}

fn list(values: &[String]) -> String {
    if let [one] = values { one.clone() } else { format!("[{}]", values.join(", ")) }
}

/// Five digits: well below any standard error, and no more.
fn quantity(value: f64, unit: &str) -> String {
    if value == 0.0 {
        return format!("0 {unit}");
    }
    let digits = (4 - value.abs().log10().floor() as i32).max(0) as usize;
    if digits > 12 || value.abs() >= 1e9 {
        format!("{value:.4e} {unit}")
    } else {
        format!("{value:.digits$} {unit}")
    }
}
