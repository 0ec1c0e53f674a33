//! The error-state filter against tables, closed forms, numeric derivatives and Monte Carlo.

mod accumulated;
mod cap;
mod common;
mod consistency;
mod covariance_table;
mod dual;
mod intervals;
mod laws;
mod observability;
mod rows;
mod simulation;
mod smoother;
mod strategies;
