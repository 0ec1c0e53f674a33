//! Units that data sheets print.

use core::f64::consts::PI;

use crate::Unit;

/// A unit as printed, with its size in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedUnit {
    /// As printed.
    pub name: &'static str,
    /// Size in SI units with angles in radians.
    pub factor: f64,
    /// Dimension.
    pub unit: Unit,
}

const DEGREE: f64 = PI / 180.0;
/// Standard acceleration, m/s².
const G: f64 = 9.806_65;

const fn printed(name: &'static str, factor: f64, unit: Unit) -> PrintedUnit {
    PrintedUnit { name, factor, unit }
}

const DENSITY_G: Unit = Unit::RATE.times_half_seconds(1);
const DENSITY_A: Unit = Unit::FORCE.times_half_seconds(1);

pub(super) const DEG_H: PrintedUnit = printed("deg/h", DEGREE / 3600.0, Unit::RATE);
pub(super) const DEG_S: PrintedUnit = printed("deg/s", DEGREE, Unit::RATE);
pub(super) const DEG_SQRT_H: PrintedUnit = printed("deg/sqrt(h)", DEGREE / 60.0, DENSITY_G);
pub(super) const DEG_S_SQRT_HZ: PrintedUnit = printed("deg/s/sqrt(Hz)", DEGREE, DENSITY_G);
pub(super) const MDPS_SQRT_HZ: PrintedUnit = printed("mdeg/s/sqrt(Hz)", 1e-3 * DEGREE, DENSITY_G);
pub(super) const DEG_H_G: PrintedUnit = printed("deg/h/g", DEGREE / 3600.0 / G, Unit::RATE.over(Unit::FORCE));
pub(super) const DEG_S_G: PrintedUnit = printed("deg/s/g", DEGREE / G, Unit::RATE.over(Unit::FORCE));
pub(super) const DEG_S_K: PrintedUnit = printed("deg/s/K", DEGREE, Unit::RATE.over(Unit::KELVIN));
pub(super) const UG: PrintedUnit = printed("ug", 1e-6 * G, Unit::FORCE);
pub(super) const MG: PrintedUnit = printed("mg", 1e-3 * G, Unit::FORCE);
pub(super) const MGAL: PrintedUnit = printed("mGal", 1e-5, Unit::FORCE);
pub(super) const MPS2: PrintedUnit = printed("m/s^2", 1.0, Unit::FORCE);
pub(super) const UG_SQRT_HZ: PrintedUnit = printed("ug/sqrt(Hz)", 1e-6 * G, DENSITY_A);
pub(super) const MPS_SQRT_H: PrintedUnit = printed("m/s/sqrt(h)", 1.0 / 60.0, DENSITY_A);
pub(super) const FPS_SQRT_H: PrintedUnit = printed("ft/s/sqrt(h)", 0.3048 / 60.0, DENSITY_A);
pub(super) const UG_G2: PrintedUnit = printed("ug/g^2", 1e-6 / G, Unit::ONE.over(Unit::FORCE));
pub(super) const MG_K: PrintedUnit = printed("mg/K", 1e-3 * G, Unit::FORCE.over(Unit::KELVIN));
pub(super) const PPM: PrintedUnit = printed("ppm", 1e-6, Unit::ONE);
pub(super) const PERCENT: PrintedUnit = printed("%", 1e-2, Unit::ONE);
pub(super) const PERCENT_K: PrintedUnit = printed("%/K", 1e-2, Unit::ONE.over(Unit::KELVIN));
pub(super) const MRAD: PrintedUnit = printed("mrad", 1e-3, Unit::RADIAN);
pub(super) const DEG: PrintedUnit = printed("deg", DEGREE, Unit::RADIAN);
pub(super) const ARCSEC: PrintedUnit = printed("arcsec", DEGREE / 3600.0, Unit::RADIAN);
