//! The unit in which a quantity reads best.

use std::f64::consts::PI;

/// A physical quantity that curves are drawn of, in SI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Metres.
    Length,
    /// Metres per second.
    Velocity,
    /// Radians.
    Angle,
    /// Radians per second.
    AngularRate,
    /// Metres per second squared.
    Acceleration,
}

/// A unit to show a quantity in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    /// As written in a label: `km`, `arcsec`, `µg`.
    pub symbol: &'static str,
    /// Shown number per SI number: the factor that data are multiplied by.
    pub per_si: f64,
}

const ARCSEC: f64 = PI / 648_000.0;
const DEG: f64 = PI / 180.0;
/// Standard gravity, m/s²: the g of `mg` and `µg`.
const G0: f64 = 9.806_65;

impl Quantity {
    /// The unit in which a curve whose largest absolute value is `largest` (SI) has labels of few digits; for the units
    /// the field prefers (arcmin, deg/h, µg), not plain powers of ten.
    pub fn shown(self, largest: f64) -> Shown {
        // From the largest unit down: symbol, unit in SI, smallest `largest` it is used for.
        let units: &[(&'static str, f64, f64)] = match self {
            Quantity::Length => &[("km", 1e3, 2e3), ("m", 1.0, 0.02), ("mm", 1e-3, 2e-5), ("µm", 1e-6, 0.0)],
            Quantity::Velocity => &[("m/s", 1.0, 0.02), ("mm/s", 1e-3, 2e-5), ("µm/s", 1e-6, 0.0)],
            Quantity::Angle => &[
                ("deg", DEG, 2.0 * DEG),
                ("arcmin", 60.0 * ARCSEC, 120.0 * ARCSEC),
                ("arcsec", ARCSEC, 0.02 * ARCSEC),
                ("nrad", 1e-9, 0.0),
            ],
            Quantity::AngularRate => &[("deg/s", DEG, 0.05 * DEG), ("deg/h", DEG / 3600.0, 0.0)],
            Quantity::Acceleration => {
                &[("m/s²", 1.0, 0.05), ("mg", 1e-3 * G0, 2e-3 * G0), ("µg", 1e-6 * G0, 0.0)]
            }
        };
        let fits = |&&(_, _, from): &&(&str, f64, f64)| largest >= from;
        let &(symbol, unit, _) =
            units.iter().find(fits).unwrap_or(&units[usize::from(self == Quantity::Length)]);
        Shown { symbol, per_si: 1.0 / unit }
    }
}
