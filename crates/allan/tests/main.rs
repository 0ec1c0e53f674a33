//! Laws and oracles of the crate.
mod bad_input;
mod closure;
mod confidence;
mod estimators;
mod fit;
mod pyramid;
mod simulation;
mod support;
mod terms;
