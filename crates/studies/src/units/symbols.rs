//! The symbols and their exact factors to SI.

use core::f64::consts::PI;

use schuler_imu::Unit;

/// Standard gravity, m/s² (exact by definition, CGPM 1901).
const G: f64 = 9.80665;
/// International nautical mile, m (exact by definition).
const NMI: f64 = 1852.0;
const VELOCITY: Unit = Unit::METRE.over(Unit::SECOND);

/// Symbol, numerator and denominator of its factor to SI, unit. Two numbers, because 1/3600 is no `f64`.
///
/// `degC` is a difference of temperature; where a scenario states a temperature, the zero of the scale is added there.
pub const SYMBOLS: &[(&str, f64, f64, Unit)] = &[
    ("1", 1.0, 1.0, Unit::ONE),
    ("%", 1.0, 100.0, Unit::ONE),
    ("ppm", 1.0, 1e6, Unit::ONE),
    ("ppb", 1.0, 1e9, Unit::ONE),
    ("count", 1.0, 1.0, Unit::ONE),
    ("counts", 1.0, 1.0, Unit::ONE),
    ("LSB", 1.0, 1.0, Unit::ONE),
    ("rad", 1.0, 1.0, Unit::RADIAN),
    ("mrad", 1.0, 1e3, Unit::RADIAN),
    ("urad", 1.0, 1e6, Unit::RADIAN),
    ("µrad", 1.0, 1e6, Unit::RADIAN),
    ("deg", PI, 180.0, Unit::RADIAN),
    ("°", PI, 180.0, Unit::RADIAN),
    ("mdeg", PI, 180e3, Unit::RADIAN),
    ("arcmin", PI, 10_800.0, Unit::RADIAN),
    ("arcsec", PI, 648_000.0, Unit::RADIAN),
    ("rev", 2.0 * PI, 1.0, Unit::RADIAN),
    ("d", 86_400.0, 1.0, Unit::SECOND),
    ("day", 86_400.0, 1.0, Unit::SECOND),
    ("days", 86_400.0, 1.0, Unit::SECOND),
    ("h", 3600.0, 1.0, Unit::SECOND),
    ("hr", 3600.0, 1.0, Unit::SECOND),
    ("min", 60.0, 1.0, Unit::SECOND),
    ("s", 1.0, 1.0, Unit::SECOND),
    ("ms", 1.0, 1e3, Unit::SECOND),
    ("us", 1.0, 1e6, Unit::SECOND),
    ("µs", 1.0, 1e6, Unit::SECOND),
    ("Hz", 1.0, 1.0, Unit::HERTZ),
    ("kHz", 1e3, 1.0, Unit::HERTZ),
    ("m", 1.0, 1.0, Unit::METRE),
    ("km", 1e3, 1.0, Unit::METRE),
    ("cm", 1.0, 100.0, Unit::METRE),
    ("mm", 1.0, 1e3, Unit::METRE),
    ("um", 1.0, 1e6, Unit::METRE),
    ("µm", 1.0, 1e6, Unit::METRE),
    ("nmi", NMI, 1.0, Unit::METRE),
    ("kn", NMI, 3600.0, VELOCITY),
    ("g", G, 1.0, Unit::FORCE),
    ("mg", G, 1e3, Unit::FORCE),
    ("ug", G, 1e6, Unit::FORCE),
    ("µg", G, 1e6, Unit::FORCE),
    ("K", 1.0, 1.0, Unit::KELVIN),
    ("degC", 1.0, 1.0, Unit::KELVIN),
    ("°C", 1.0, 1.0, Unit::KELVIN),
];
