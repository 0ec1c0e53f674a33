use super::{Coefficients, Term, lever_gradient};
use crate::{Input, Instrument, Unit};

/// The case stands away from the point whose motion is the truth.
pub struct LeverArm;

impl Term for LeverArm {
    fn name(&self) -> &'static str {
        "lever_arm"
    }
    fn doc(&self) -> &'static str {
        "The case stands away from the point whose motion is the truth"
    }
    fn formula(&self) -> &'static str {
        "e = w x (w x r) + dw/dt x r"
    }
    fn source(&self) -> &'static str {
        "Acceleration of a point of a rigid body"
    }
    fn instruments(&self) -> &'static [Instrument] {
        &[Instrument::Accel]
    }
    fn unit(&self, _: Instrument) -> Unit {
        Unit::METRE
    }
    #[inline(always)]
    fn output(&self, x: &Input, c: &Coefficients) -> [f64; 3] {
        let g = lever_gradient(x);
        let row = |i: usize| g[i][0] * c[0] + g[i][1] * c[1] + g[i][2] * c[2];
        [row(0), row(1), row(2)]
    }
}
