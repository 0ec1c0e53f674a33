use std::f64::consts::PI;
use std::fmt::Write as _;

use crate::{Fit, Parameter, Term, Verdict};

/// What the log measures; decides the units of the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instrument {
    /// Angular rate, rad/s.
    Gyro,
    /// Specific force, m/s².
    Accel,
}

const HOUR: f64 = 3600.0;
const DEG: f64 = PI / 180.0;
/// Standard gravity (m/s²), exact by definition (3rd CGPM 1901); the `g` of the scenario language.
const G: f64 = 9.806_65;

impl Instrument {
    /// Name of the instrument in a scenario.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Instrument::Gyro => "gyro",
            Instrument::Accel => "accel",
        }
    }

    /// Unit that people in the field use for the coefficient of `term`, and its size in SI.
    #[must_use]
    pub fn unit(self, term: Term) -> (&'static str, f64) {
        match (self, term) {
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
}

/// The fits of one to three axes of an instrument as error sources of a scenario, in YAML: a source for each term
/// that is seen on some axis, a comment for the rest.
///
/// A list holds one number an axis, 0 where the term is not seen on it; axes of a Markov process or a
/// sinusoid differ in time constant or frequency, so they come as one source an axis.
#[must_use]
pub fn to_yaml(fits: &[Fit], instrument: Instrument) -> String {
    let mut out = String::new();
    for term in Term::POWER_LAWS {
        let all: Vec<Option<&Parameter>> = fits.iter().map(|f| f.parameter(term)).collect();
        let values: Vec<f64> = all.iter().map(|p| p.filter(|p| seen(p)).map_or(0.0, |p| p.value)).collect();
        if values.iter().any(|v| *v > 0.0) {
            let (unit, size) = instrument.unit(term);
            let value = list(&values.iter().map(|v| quantity(v / size, unit)).collect::<Vec<_>>());
            line(&mut out, &process(term, &value, fits));
        }
        for (axis, p) in all.iter().enumerate() {
            if let Some(p) = p.filter(|p| !seen(p)) {
                comment(&mut out, p, axis, fits.len(), instrument);
            }
        }
    }
    for (axis, fit) in fits.iter().enumerate() {
        for p in fit.parameters.iter().filter(|p| p.term.shape().is_some()) {
            if seen(p) {
                let (unit, size) = instrument.unit(p.term);
                let values: Vec<String> = (0..fits.len())
                    .map(|i| quantity(if i == axis { p.value / size } else { 0.0 }, unit))
                    .collect();
                line(&mut out, &process(p.term, &list(&values), fits));
            } else {
                comment(&mut out, p, axis, fits.len(), instrument);
            }
        }
    }
    out
}

fn seen(p: &Parameter) -> bool {
    p.verdict == Verdict::Seen
}

fn process(term: Term, value: &str, fits: &[Fit]) -> String {
    match term {
        Term::Quantization => format!("quantization: {{ q: {value} }}"),
        Term::White => format!("white: {{ density: {value} }}"),
        Term::Flicker => {
            // Flicker needs a band: what the log can have seen.
            let first = fits.iter().map(|f| f.tau0).fold(f64::INFINITY, f64::min);
            let last = fits.iter().map(|f| f.duration).fold(0.0, f64::max);
            format!(
                "flicker: {{ instability: {value}, tau_min: {}, tau_max: {} }}",
                quantity(first, "s"),
                quantity(last, "s")
            )
        }
        Term::RandomWalk => format!("random_walk: {{ density: {value} }}"),
        // The sign of a ramp does not show in a variance.
        Term::Ramp => format!("ramp: {{ sigma: {value} }}"),
        Term::Markov { tau } => format!("gauss_markov: {{ sigma: {value}, tau: {} }}", quantity(tau, "s")),
        Term::Sinusoid { f0 } => {
            format!("sinusoid: {{ amplitude: {value}, frequency: {} }}", quantity(f0, "Hz"))
        }
    }
}

fn line(out: &mut String, process: &str) {
    let _ = writeln!(out, "- bias: {{ {process} }}");
}

fn comment(out: &mut String, p: &Parameter, axis: usize, axes: usize, instrument: Instrument) {
    let (unit, size) = instrument.unit(p.term);
    let axis = if axes > 1 { format!(" {}", ["x", "y", "z"][axis.min(2)]) } else { String::new() };
    let limit = p.interval.1 / size;
    let what = if p.verdict == Verdict::NotObservable {
        format!("not observable from this log (about {})", quantity(p.value / size, unit))
    } else if limit.is_finite() {
        format!("not seen; below {} with 95 % confidence", quantity(limit, unit))
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
