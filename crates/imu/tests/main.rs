//! Tests of the error model.

mod api;
mod philox;
mod unit;
