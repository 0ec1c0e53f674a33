//! Tests of the error model.

mod allocation;
mod api;
mod batches;
mod cost_of_a_term;
mod draws;
mod examples;
mod innovation;
mod laws;
mod philox;
mod presets;
mod process_laws;
mod readout;
mod recovery;
mod state;
mod streams;
mod temperature;
mod terms;
mod unit;
mod value_stability;
