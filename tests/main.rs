//! Tests of the program as users meet it.

mod allan;
mod cli;
mod configs;
mod monte_carlo;
mod recorded;
mod schema;
mod tables;
