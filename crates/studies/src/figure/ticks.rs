//! Ticks: where they stand and what is written at them.

use super::Scale;

/// Ticks of one axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Ticks {
    /// Value in data units, and label.
    pub major: Vec<(f64, String)>,
    /// Values in data units, without label.
    pub minor: Vec<f64>,
    /// What all labels are to be multiplied by and what is to be added, or empty: `×10⁻⁶`.
    pub note: String,
    /// Unit of a time axis.
    pub unit: Option<&'static str>,
}

/// Ticks between `low` and `high`, about `wanted` of them.
pub(super) fn ticks(scale: Scale, low: f64, high: f64, wanted: f64) -> Ticks {
    match scale {
        Scale::Linear => linear(low, high, wanted),
        Scale::Time => time(low, high, wanted),
        Scale::Log => log(low, high, wanted),
    }
}

/// Multiples of `step` from `low` to `high`, both included within rounding.
fn multiples(step: f64, low: f64, high: f64) -> Vec<f64> {
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    let count = (last - first).clamp(-1.0, 1000.0) as i64 + 1;
    // Adding zero turns -0 into 0.
    (0..count).map(|k| (first + k as f64) * step + 0.0).collect()
}

/// The step of 1, 2 or 5 times a power of ten that gives about `wanted` intervals, and the number of fifths or halves
/// that minor ticks divide it into.
fn nice_step(width: f64, wanted: f64) -> (f64, f64) {
    let raw = width / wanted.max(1.0);
    let decade = 10_f64.powf(raw.log10().floor());
    match raw / decade {
        r if r < 1.5 => (decade, 5.0),
        r if r < 3.5 => (2.0 * decade, 4.0),
        r if r < 7.5 => (5.0 * decade, 5.0),
        _ => (10.0 * decade, 5.0),
    }
}

fn linear(low: f64, high: f64, wanted: f64) -> Ticks {
    let (step, parts) = nice_step(high - low, wanted);
    every(step, parts, low, high)
}

/// Ticks at the multiples of `step`, minor ones at `parts` to a step.
fn every(step: f64, parts: f64, low: f64, high: f64) -> Ticks {
    let largest = low.abs().max(high.abs());
    // Labels of more than six digits: the common part goes into the note.
    let offset = if largest / step > 1e6 {
        let unit = 10_f64.powf((high - low).log10().ceil());
        (low / unit).round() * unit
    } else {
        0.0
    };
    let shown = (low - offset).abs().max((high - offset).abs());
    let exponent = (shown * (1.0 + 1e-9)).log10().floor() as i32;
    let power = if (-3..5).contains(&exponent) { 0 } else { 3 * exponent.div_euclid(3) };
    // The step's exponent, safe against a logarithm that falls just short of a whole number.
    let decimals = (power - (step * 1.000_001).log10().floor() as i32).clamp(0, 17) as usize;
    let values: Vec<f64> = multiples(step, low - offset, high - offset);
    // Multiplying and dividing by whole powers keeps decimals that a negative power of ten does not have exactly.
    let scaled = |v: f64| if power < 0 { v * 10_f64.powi(-power) } else { v / 10_f64.powi(power) };
    let major =
        values.iter().map(|&v| (v + offset, minus(&format!("{:.decimals$}", scaled(v) + 0.0)))).collect();
    let minor =
        multiples(step / parts, low - offset, high - offset).into_iter().map(|v| v + offset).collect();
    let mut note = if power == 0 { String::new() } else { format!("×{}", power_of_ten(power)) };
    if offset != 0.0 {
        let sign = if offset < 0.0 { "−" } else { "+" };
        note = format!("{note} {sign} {}", short(offset.abs())).trim_start().to_string();
    }
    Ticks { major, minor, note, unit: None }
}

/// Symbol, seconds, and steps in that unit.
const TIME_UNITS: [(&str, f64, &[f64]); 4] = [
    ("s", 1.0, &[10.0, 15.0, 20.0, 30.0, 60.0]),
    ("min", 60.0, &[1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 60.0]),
    ("h", 3600.0, &[0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 24.0]),
    ("d", 86400.0, &[0.5, 1.0, 2.0, 5.0, 10.0, 20.0]),
];

fn time(low: f64, high: f64, wanted: f64) -> Ticks {
    let width = high - low;
    let (symbol, unit, steps) = match width {
        w if w <= 180.0 => TIME_UNITS[0],
        w if w <= 3.0 * 3600.0 => TIME_UNITS[1],
        w if w <= 4.0 * 86400.0 => TIME_UNITS[2],
        _ => TIME_UNITS[3],
    };
    let fine = steps[0];
    let enough = |step: &&f64| width / unit / **step <= wanted.max(2.0);
    let step = match steps.iter().find(enough) {
        Some(&step) if step > fine || width / unit / fine > 0.4 * wanted => step,
        // Finer or coarser than the table: powers of ten.
        _ => nice_step(width / unit, wanted).0,
    };
    let Ticks { major, minor, note, .. } = every(step, 5.0, low / unit, high / unit);
    Ticks {
        major: major.into_iter().map(|(v, label)| (v * unit, label)).collect(),
        minor: if note.is_empty() { Vec::new() } else { minor.into_iter().map(|v| v * unit).collect() },
        note,
        unit: Some(symbol),
    }
}

fn log(low: f64, high: f64, wanted: f64) -> Ticks {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let decades = (high / low).log10();
    let inside = |v: &f64| *v >= low * (1.0 - 1e-9) && *v <= high * (1.0 + 1e-9);
    if decades < 0.7 {
        return linear(low, high, wanted);
    }
    let stride = ((decades / wanted.max(2.0)).ceil() as i32).max(1);
    let steps: &[f64] = if decades < 1.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let powers = (first..=last).filter(|k| k.rem_euclid(stride) == 0);
    let values = powers.flat_map(|k| steps.iter().map(move |&m| (k, m)));
    let plain = low >= 0.009 && high <= 2000.0;
    let label = |k: i32, m: f64| match (plain, m) {
        (true, _) => short(m * 10_f64.powi(k)),
        (false, 1.0) => power_of_ten(k),
        (false, _) => format!("{m}·{}", power_of_ten(k)),
    };
    let major = values.map(|(k, m)| (m * 10_f64.powi(k), label(k, m))).filter(|(v, _)| inside(v)).collect();
    let fine: &[f64] =
        if stride == 1 && decades <= 8.0 { &[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0] } else { &[1.0] };
    let minor = (first..=last).flat_map(|k| fine.iter().map(move |m| m * 10_f64.powi(k))).filter(inside);
    Ticks { major, minor: minor.collect(), note: String::new(), unit: None }
}

/// A number as short as it can be written, within twelve digits.
fn short(v: f64) -> String {
    let rounded: f64 = format!("{v:.11e}").parse().unwrap_or(v);
    if (1e-4..1e15).contains(&rounded.abs()) || rounded == 0.0 {
        return minus(&format!("{rounded}"));
    }
    let scientific = format!("{rounded:e}");
    let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    minus(&format!("{digits}·{}", power_of_ten(exponent.parse().unwrap_or(0))))
}

/// The typographic minus sign instead of the hyphen.
fn minus(number: &str) -> String {
    number.replace('-', "−")
}

/// `10⁻³`.
fn power_of_ten(k: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised =
        k.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])).collect::<String>();
    format!("10{raised}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(t: &Ticks) -> Vec<&str> {
        t.major.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn time_axes_have_steps_people_use() {
        let day = time(0.0, 86400.0, 8.0);
        assert_eq!(labels(&day), ["0", "3", "6", "9", "12", "15", "18", "21", "24"]);
        assert_eq!(day.unit, Some("h"));
        let half_hour = time(0.0, 1847.18, 8.0);
        assert_eq!(labels(&half_hour), ["0", "5", "10", "15", "20", "25", "30"]);
        assert_eq!(half_hour.unit, Some("min"));
        assert_eq!(labels(&time(0.0, 100.0, 7.0)), ["0", "15", "30", "45", "60", "75", "90"]);
        assert_eq!(labels(&time(0.0, 1.0, 5.0)), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&time(0.0, 10.0 * 86400.0, 6.0)), ["0", "2", "4", "6", "8", "10"]);
    }

    #[test]
    fn large_and_small_numbers_share_a_power_of_ten() {
        let small = linear(-3e-9, 3e-9, 6.0);
        assert_eq!(labels(&small), ["−3", "−2", "−1", "0", "1", "2", "3"]);
        assert_eq!(small.note, "×10⁻⁹");
        let large = linear(0.0, 1.2e6, 6.0);
        assert_eq!(labels(&large), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0", "1.2"]);
        assert_eq!(large.note, "×10⁶");
    }

    #[test]
    fn a_large_common_part_goes_into_the_note() {
        let t = linear(6_378_137.0, 6_378_137.5, 5.0);
        assert_eq!(t.note, "+ 6378137");
        assert_eq!(labels(&t), ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]);
    }

    #[test]
    fn decades_are_written_as_powers() {
        assert_eq!(labels(&log(1e-6, 1e-3, 6.0)), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"]);
        assert_eq!(labels(&log(0.1, 100.0, 6.0)), ["0.1", "1", "10", "100"]);
        assert_eq!(labels(&log(1e-12, 1e6, 6.0)), ["10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "10⁰", "10³", "10⁶"]);
    }
}
