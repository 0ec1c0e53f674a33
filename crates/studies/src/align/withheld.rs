//! Where heading cannot be had, and why.

use super::limit::{Limit, Part};
use super::observability::significant;
use crate::scenario::{AlignStudy, MethodKind};

/// Heading error beyond which the laws for small angles, and heading itself, mean nothing, rad (30 deg).
const LARGE: f64 = 0.5;

/// The sentence for a place without a horizontal part of the Earth rate.
const POLE: &str = "Heading cannot be had: at a pole the Earth rate has no horizontal part";

/// What is not shown.
pub struct Withheld {
    /// Whether a method's heading is withheld.
    pub heading: Vec<bool>,
    /// Why.
    pub notes: Vec<String>,
}

/// Why no method finds heading at this place, if none does.
pub fn at_pole(laws: &schuler_strapdown::align::Limits) -> Option<&'static str> {
    (laws.omega_north().abs() < 1e-6 * laws.site.omega_ie).then_some(POLE)
}

impl Withheld {
    /// After `t` (s) of alignment.
    ///
    /// The sensors' errors count by the variance of their means over the time, projected on the horizontal Earth rate, whatever the
    /// method; noise of the velocity only where a method measures it and knows no heading before.
    pub fn new(study: &AlignStudy, limit: &Limit, t: f64) -> Withheld {
        if let Some(why) = at_pole(&limit.laws).map(String::from).or_else(|| by_sensors(limit, t)) {
            return Withheld { heading: vec![true; study.methods.len()], notes: vec![why] };
        }
        let [.., [_, _, of_velocity]] = limit.separate(t, true);
        let blind = |kind: &MethodKind| match kind {
            MethodKind::AnyHeading(_) => true,
            MethodKind::Filter(settings) => !settings.position && settings.heading > LARGE,
            _ => false,
        };
        let heading: Vec<bool> =
            study.methods.iter().map(|method| of_velocity > LARGE && blind(&method.kind)).collect();
        let names = study.methods.iter().zip(&heading).filter(|(_, withheld)| **withheld);
        let notes = names.map(|(method, _)| {
            format!(
                "Heading cannot be had by `{}` in {t} s: the noise of the measured velocity alone leaves {} deg",
                method.name,
                significant(of_velocity.to_degrees())
            )
        });
        Withheld { notes: notes.collect(), heading }
    }
}

/// The sentence with the largest of the causes, if the sensors are too bad.
fn by_sensors(limit: &Limit, t: f64) -> Option<String> {
    let kind = MethodKind::Triad(schuler_strapdown::align::Vectors::ForceFirst);
    let heading = |wanted: &dyn Fn(&Part) -> bool| {
        let parts = [limit.means(t, wanted), limit.white_means(t, wanted)];
        parts.map(|means| limit.left(&kind, &means)[2]).into_iter().fold(0.0, f64::hypot)
    };
    let whole = heading(&|_| true);
    if whole <= LARGE {
        return None;
    }
    let omega = limit.laws.omega_north().abs();
    let per_hour = |x: f64| significant((x * omega).to_degrees() * 3600.0);
    let mut sources: Vec<(&str, f64)> = Vec::new();
    for part in limit.parts() {
        if !sources.iter().any(|(name, _)| *name == part.source) {
            sources.push((&part.source, heading(&|p| p.source == part.source)));
        }
    }
    let (cause, size) = sources.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(format!(
        "Heading cannot be had: as a mean over {t} s the sensor errors are worth {} deg/h of the horizontal Earth rate of {} deg/h, most of it by `{cause}`, {} deg/h",
        per_hour(whole),
        per_hour(1.0),
        per_hour(size)
    ))
}
