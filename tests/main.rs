//! Tests of the program as users meet it.

mod allan;
mod cli;
mod configs;
mod recorded;
mod schema;
mod tables;
