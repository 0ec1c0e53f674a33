//! What the numbers of an axis mean, in sentences.

use schuler_allan::{Fit, Parameter, Term, Verdict, unit};

use super::axis::{Axis, Found};
use super::report::Short;

/// Everything that should be known of an axis beside its numbers.
pub fn notes(axis: &Axis) -> Vec<String> {
    let found = match &axis.found {
        Ok(found) => found,
        Err(error) => return vec![format!("{}: {error}", axis.name)],
    };
    let mut notes = Vec::new();
    if found.streamed {
        notes.push(
            "too long to keep; octaves only, above eight samples from every eighth of an averaging time. Other \
             estimators and a fine search for a sinusoid are left out"
                .into(),
        );
    }
    match &found.fit {
        Err(error) => notes.push(format!("no fit: {error}")),
        Ok(fit) => {
            notes.extend(misfit(fit));
            notes.push(format!("largest in the model: {}", largest(fit)));
            notes.extend(quantization(axis, fit));
            notes.extend(unsure(fit));
        }
    }
    notes.extend(of_sun(found));
    notes.into_iter().map(|note| format!("{}: {note}", axis.name)).collect()
}

fn misfit(fit: &Fit) -> Option<String> {
    fit.misfit.then(|| {
        format!(
            "no sum of these terms is the curve within chance; the log holds something else (motion, temperature, an \
             outlier). The fit allows for {:.0} % of error in the model's variance; what it finds is in the log, but not \
             surely of the sensor",
            100.0 * fit.model_error
        )
    })
}

/// Octaves of averaging times from one sample to a quarter of the log.
fn octaves(fit: &Fit) -> impl Iterator<Item = f64> {
    let tau0 = fit.tau0;
    (0..).map(move |k| tau0 * f64::from(k).exp2()).take_while(|tau| *tau <= 0.25 * fit.duration)
}

/// Part of the model's variance at `tau` that a term has.
fn share(fit: &Fit, p: &Parameter, tau: f64) -> f64 {
    p.value * p.value * p.term.allan_variance(tau) / fit.allan_variance(tau)
}

/// The largest term at each octave, in stretches.
fn largest(fit: &Fit) -> String {
    let mut stretches: Vec<(&str, f64, f64)> = Vec::new();
    for tau in octaves(fit) {
        let top = fit.parameters.iter().max_by(|a, b| share(fit, a, tau).total_cmp(&share(fit, b, tau)));
        let name = top.map_or("nothing", |p| p.term.name());
        match stretches.last_mut() {
            Some(last) if last.0 == name => last.2 = tau,
            _ => stretches.push((name, tau, tau)),
        }
    }
    let show = |(name, from, to): (&str, f64, f64)| match from == to {
        true => format!("{name} at {} s", Short(from)),
        false => format!("{name} from {} s to {} s", Short(from), Short(to)),
    };
    stretches.into_iter().map(show).collect::<Vec<_>>().join(", ")
}

/// Whether quantization dominates at short times, and whether it is that of the counts.
fn quantization(axis: &Axis, fit: &Fit) -> Option<String> {
    let q = fit.parameter(Term::Quantization)?;
    let (unit, size) = unit(axis.instrument, q.term);
    let until = octaves(fit).take_while(|tau| share(fit, q, *tau) > 0.5).last();
    let mut note = match until {
        Some(tau) => format!("quantization is more than half of the variance up to {} s", Short(tau)),
        None if q.value > 0.0 => {
            "quantization is there, but not the largest even from sample to sample".into()
        }
        // Without a count in the log, quantization that is not there is no news.
        None if axis.count.is_none() => return None,
        None if q.interval.1.is_finite() => {
            format!("quantization is not seen; below {} {unit}", Short(q.interval.1 / size))
        }
        None => "quantization is not seen".into(),
    };
    if let Some(count) = axis.count {
        // The carried error of rounding is uniform over a count.
        let rounding = count / 12f64.sqrt();
        note += &format!(
            "; the samples are whole counts, whose rounding makes {} {unit}",
            Short(rounding / size)
        );
        if q.value > 2.0 * rounding {
            note += &format!(
                ", so that most of the {} {unit} found is something else (vibration?)",
                Short(q.value / size)
            );
        }
    }
    Some(note)
}

/// What cannot be told from this log.
fn unsure(fit: &Fit) -> Vec<String> {
    let names = |which: &dyn Fn(&&Parameter) -> bool| {
        let names: Vec<&str> = fit.parameters.iter().filter(which).map(|p| p.term.name()).collect();
        (!names.is_empty()).then(|| names.join(", "))
    };
    let hidden = names(&|p| p.verdict == Verdict::NotObservable)
        .map(|names| format!("not observable from this log (bound above 30 %): {names}"));
    let doubtful = names(&|p| p.verdict == Verdict::Seen && p.interval.0 == 0.0)
        .map(|names| format!("a model without it fits nearly as well (interval from 0): {names}"));
    hidden.into_iter().chain(doubtful).collect()
}

/// The paper's own method on the same points.
fn of_sun(found: &Found) -> Option<String> {
    let sun = found.sun.as_ref()?;
    let negative: Vec<&str> =
        (0..5).filter(|k| sun.coefficients[*k] < 0.0).map(|k| Term::POWER_LAWS[k].name()).collect();
    (!negative.is_empty()).then(|| {
        format!(
            "equation (3) of the paper (plain least squares) has negative squares: {}",
            negative.join(", ")
        )
    })
}
