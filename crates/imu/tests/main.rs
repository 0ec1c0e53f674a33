//! Tests of the error model.

mod api;
mod philox;
mod terms;
mod unit;
