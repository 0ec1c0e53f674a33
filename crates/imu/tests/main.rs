//! Tests of the error model.

mod api;
mod examples;
mod laws;
mod philox;
mod process_laws;
mod terms;
mod unit;
