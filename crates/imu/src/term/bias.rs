use super::{Coefficients, Term};
use crate::{Input, Instrument, Unit};

/// An offset that does not depend on the input.
pub struct Bias;

impl Term for Bias {
    fn name(&self) -> &'static str {
        "bias"
    }
    fn doc(&self) -> &'static str {
        "Offset of the output, whatever the input"
    }
    fn formula(&self) -> &'static str {
        "e_i = b_i"
    }
    fn source(&self) -> &'static str {
        "IEEE Std 528, bias"
    }
    fn unit(&self, instrument: Instrument) -> Unit {
        instrument.unit()
    }
    #[inline(always)]
    fn output(&self, _: &Input, c: &Coefficients) -> [f64; 3] {
        [c[0], c[1], c[2]]
    }
}
