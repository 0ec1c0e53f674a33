//! The picture of one axis.

use schuler_allan::unit;

use super::axis::{Axis as Sensor, Found};
use crate::figure::{Axis, Colour, Figure, Panel, Series, Style};

/// Points a decade of the model curves.
const PER_DECADE: i32 = 24;

/// Overlapping deviation with its band, the fit, and each term of it.
pub fn figure(title: &str, sensor: &Sensor, found: &Found) -> Figure {
    // Deviations are in the unit of a bias.
    let (symbol, size) = unit(sensor.instrument, schuler_allan::Term::Flicker);
    let symbol = if symbol == "ug" { "µg" } else { symbol };
    let overlapping = found.curves.first().map_or(&[][..], Vec::as_slice);
    let first = overlapping.first().map_or(1.0, |e| e.point.tau);
    let last = overlapping.last().map_or(1.0, |e| e.point.tau);
    // At the first averaging time every sample but the last two starts a difference of phase.
    let samples = overlapping.first().map_or(0, |e| e.point.terms + 1);
    let floor = overlapping.iter().map(|e| e.low).fold(f64::INFINITY, f64::min) / size;
    let top = overlapping.iter().map(|e| e.high).fold(0.0, f64::max) / size;
    let taus: Vec<f64> = (0..=((last / first).log10() * f64::from(PER_DECADE)).ceil() as i32)
        .map(|k| (first * 10f64.powf(f64::from(k) / f64::from(PER_DECADE))).min(last))
        .collect();

    let mut panel = Panel::new(
        Axis::log(format!("Allan deviation ({symbol})")).from_to(0.3 * floor, 2.0 * top),
    )
    .with(
        Series::band("95 % interval", overlapping.iter().map(|e| [e.point.tau, e.low / size, e.high / size]))
            .colour(Colour::palette(5)),
    );
    if let Ok(fit) = &found.fit {
        for p in fit.parameters.iter().filter(|p| p.value > 0.0) {
            let curve = taus.iter().map(|t| [*t, p.value * p.term.allan_variance(*t).sqrt() / size]);
            panel = panel.with(Series::line(p.term.name(), curve).style(Style::Dashed));
        }
        let curve = taus.iter().map(|t| [*t, fit.allan_variance(*t).sqrt() / size]);
        panel = panel.with(Series::line("fit", curve).colour(Colour::palette(1)));
    }
    let points = overlapping.iter().map(|e| [e.point.tau, e.point.deviation() / size]);
    panel = panel.with(Series::line("overlapping", points).style(Style::Points).colour(Colour::BLACK));
    Figure::new(format!("{title}: {}", sensor.name), Axis::log("averaging time (s)"))
        .subtitle(format!("{samples} samples at {:.6} Hz", 1.0 / first))
        .panel(panel)
}
