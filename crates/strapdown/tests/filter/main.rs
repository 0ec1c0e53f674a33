//! The error-state filter against tables, closed forms, numeric derivatives and Monte Carlo.

mod accumulated;
mod common;
mod covariance_table;
mod rows;
