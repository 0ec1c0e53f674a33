use super::{Coefficients, Term, by_axis};
use crate::{Input, Instrument, Unit};

/// Scale factor that changes with T - T_cal.
pub struct ThermalScaleFactor;

impl Term for ThermalScaleFactor {
    fn name(&self) -> &'static str {
        "thermal_scale_factor"
    }
    fn doc(&self) -> &'static str {
        "Scale factor that changes with T - T_cal"
    }
    fn formula(&self) -> &'static str {
        "e_i = c_i (T - T_cal) u_i"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, scale factor temperature sensitivity"
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::ONE.over(Unit::KELVIN)
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let [ux, uy, uz] = x.u;
        by_axis(c, [ux * x.delta_t, uy * x.delta_t, uz * x.delta_t])
    }
}
