//! From written quantities to SI, with messages that name what was expected.

use schuler_imu::Unit;

use super::{
    de::At,
    document::{Document, NodeId, Spot},
    schema::{OneOrMore, Scalar},
};
use crate::{
    Diagnostic,
    units::{self, UnitError},
};

/// Values that a quantity may have.
#[derive(Clone, Copy)]
pub enum Range {
    /// Any finite number.
    Any,
    /// Zero or more.
    NonNegative,
    /// More than zero.
    Positive,
}

impl Document {
    /// A quantity in `unit`, SI.
    pub fn quantity(&self, written: &At<Scalar>, unit: Unit, range: Range) -> Result<f64, Diagnostic> {
        self.scalar(written.node, &written.value, unit, |found| found == unit, range)
    }

    /// A list of quantities in `unit`, SI.
    pub fn quantities<const N: usize>(
        &self,
        written: &At<[At<Scalar>; N]>,
        unit: Unit,
    ) -> Result<[f64; N], Diagnostic> {
        let mut values = [0.0; N];
        for (value, written) in values.iter_mut().zip(&written.value) {
            *value = self.quantity(written, unit, Range::Any)?;
        }
        Ok(values)
    }

    /// One quantity in `unit` for all axes, or one each.
    pub fn each_axis(
        &self,
        written: &At<OneOrMore>,
        unit: Unit,
        range: Range,
    ) -> Result<[f64; 3], Diagnostic> {
        match &written.value {
            OneOrMore::One(scalar) => {
                Ok([self.scalar(written.node, scalar, unit, |found| found == unit, range)?; 3])
            }
            OneOrMore::More(list) => {
                let values: Vec<f64> =
                    list.iter().map(|q| self.quantity(q, unit, range)).collect::<Result<_, _>>()?;
                values.try_into().map_err(|values: Vec<f64>| {
                    self.diagnostic(
                        Spot::Node(written.node),
                        format!("the list has {} entries", values.len()),
                    )
                    .expected("one quantity, or three: x, y, z")
                })
            }
        }
    }

    /// A scalar in `unit`, or in whatever else `accepts` takes for it.
    pub fn scalar(
        &self,
        node: NodeId,
        scalar: &Scalar,
        unit: Unit,
        accepts: impl Fn(Unit) -> bool,
        range: Range,
    ) -> Result<f64, Diagnostic> {
        let (quantity, found) = self.parse_scalar(node, scalar, unit)?;
        if !accepts(quantity.unit) {
            let problem = "wrong dimension";
            return Err(self.expecting(node, problem, unit).found(format!(
                "{}: {}",
                found,
                units::describe(quantity.unit)
            )));
        }
        let (holds, need) = match range {
            Range::Any => (true, ""),
            Range::NonNegative => (quantity.value >= 0.0, "must not be negative"),
            Range::Positive => (quantity.value > 0.0, "must be more than zero"),
        };
        if !holds {
            return Err(self.expecting(node, need, unit).found(found));
        }
        Ok(quantity.value)
    }

    /// Value, unit and text of a scalar for which `unit` is expected.
    pub fn parse_scalar(
        &self,
        node: NodeId,
        scalar: &Scalar,
        unit: Unit,
    ) -> Result<(units::Quantity, String), Diagnostic> {
        let text = match scalar {
            Scalar::Bare(value) if unit == Unit::ONE && value.is_finite() => {
                return Ok((units::Quantity { value: *value, unit }, format!("{value}")));
            }
            Scalar::Bare(value) => {
                let problem =
                    if value.is_finite() { "a number without a unit" } else { "not a finite number" };
                return Err(self.expecting(node, problem, unit).found(format!("{value}")));
            }
            Scalar::Text(text) => text,
        };
        match units::parse_quantity(text) {
            Ok(quantity)
                if quantity.unit == Unit::ONE && text.trim().parse::<f64>().is_ok() && unit != Unit::ONE =>
            {
                Err(self.expecting(node, "a number without a unit", unit).found(format!("`{text}`")))
            }
            Ok(quantity) => Ok((quantity, format!("`{text}`"))),
            Err(error) => {
                let mut diagnostic = self.expecting(node, error.to_string(), unit).found(format!("`{text}`"));
                if let UnitError::UnknownSymbol { similar: Some(similar), .. } = error {
                    diagnostic = diagnostic.help(format!("did you mean `{similar}`?"));
                }
                Err(diagnostic)
            }
        }
    }

    fn expecting(&self, node: NodeId, problem: impl Into<String>, unit: Unit) -> Diagnostic {
        self.diagnostic(Spot::Node(node), problem)
            .expected(units::describe(unit))
            .example(units::example(unit))
    }
}
