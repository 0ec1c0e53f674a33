//! How a message names the unit it expects, with an example that parses.

use schuler_imu::Unit;

const VELOCITY: Unit = Unit::METRE.over(Unit::SECOND);

/// What a unit measures and an example of it. An example is taken as it stands by the parser (tested).
const KNOWN: &[(Unit, &str, &str)] = &[
    (Unit::ONE, "a pure number or a ratio", "100 ppm"),
    (Unit::RADIAN, "an angle", "10 arcsec"),
    (Unit::SECOND, "a time", "1 h"),
    (Unit::KELVIN, "a temperature", "20 degC"),
    (Unit::KELVIN.over(Unit::SECOND), "a temperature per time", "1 K/min"),
    (Unit::HERTZ, "a frequency", "100 Hz"),
    (Unit::METRE, "a length", "10 m"),
    (VELOCITY, "a velocity", "0.1 m/s"),
    (Unit::RATE, "an angular rate", "0.01 deg/h"),
    (Unit::FORCE, "a specific force", "50 ug"),
    (Unit::RATE.times_half_seconds(1), "an angular rate density", "0.003 deg/sqrt(h)"),
    (Unit::FORCE.times_half_seconds(1), "a specific force density", "20 ug/sqrt(Hz)"),
    (Unit::RATE.times_half_seconds(-1), "an angular rate per root of time", "0.001 deg/h/sqrt(h)"),
    (Unit::FORCE.times_half_seconds(-1), "a specific force per root of time", "10 ug/sqrt(h)"),
    (Unit::RATE.times_half_seconds(-2), "an angular rate per time", "0.01 deg/h/h"),
    (Unit::FORCE.times_half_seconds(-2), "a specific force per time", "10 ug/h"),
    (Unit::ONE.over(Unit::RATE), "a ratio per angular rate", "10 ppm/(deg/s)"),
    (Unit::ONE.over(Unit::FORCE), "a ratio per specific force", "10 ug/g^2"),
    (Unit::RATE.over(Unit::FORCE), "an angular rate per specific force", "1 deg/h/g"),
    (Unit::RATE.over(Unit::KELVIN), "an angular rate per temperature", "0.1 deg/h/K"),
    (Unit::FORCE.over(Unit::KELVIN), "a specific force per temperature", "10 ug/K"),
    (Unit::ONE.over(Unit::KELVIN), "a ratio per temperature", "10 ppm/K"),
];

fn known(unit: Unit) -> Option<&'static (Unit, &'static str, &'static str)> {
    KNOWN.iter().find(|k| k.0 == unit)
}

/// What is measured in `unit`, with its SI form: `an angular rate (SI: rad/s)`.
pub fn describe(unit: Unit) -> String {
    match known(unit) {
        Some((Unit::ONE, what, _)) => (*what).into(),
        Some((_, what, _)) => format!("{what} (SI: {unit})"),
        None => format!("a quantity in {unit}"),
    }
}

/// A quantity in `unit` that the parser takes.
pub fn example(unit: Unit) -> String {
    known(unit).map_or_else(|| format!("0.1 {unit}"), |k| k.2.into())
}

#[cfg(test)]
pub(super) fn examples() -> impl Iterator<Item = (Unit, &'static str)> {
    KNOWN.iter().map(|k| (k.0, k.2))
}
