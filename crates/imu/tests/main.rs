//! Tests of the error model.

mod api;
mod examples;
mod laws;
mod philox;
mod presets;
mod process_laws;
mod readout;
mod state;
mod streams;
mod temperature;
mod terms;
mod unit;
