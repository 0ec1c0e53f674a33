//! Quantities as people write them, `0.003 deg/sqrt(h)`, and what they are in SI.
//!
//! Grammar: a number, then factors joined by `*`, `·`, a space or `/` (left to right: `deg/h/g` is
//! `deg/(h·g)`), each a symbol, a bracket or `sqrt(…)`, with an optional power (`m/s^2`, `m/s²`).

mod expected;
mod parse;
mod symbols;

pub use expected::{describe, example};
pub use parse::{UnitError, parse_quantity, parse_unit};

use schuler_imu::Unit;

/// A value in SI with its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Value, SI and radians.
    pub value: f64,
    /// What it measures.
    pub unit: Unit,
}

#[cfg(test)]
mod tests;
