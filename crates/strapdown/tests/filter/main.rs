//! The error-state filter against tables, closed forms, numeric derivatives and Monte Carlo.

mod accumulated;
mod common;
mod covariance_table;
mod dual;
mod laws;
mod observability;
mod rows;
mod simulation;
mod smoother;
mod strategies;
