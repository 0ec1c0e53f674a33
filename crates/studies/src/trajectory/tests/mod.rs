//! Laws of every kind of motion, and closed forms of single ones.

mod closed_forms;
mod kinds;
mod laws;
mod navigators;
mod rounding;
mod routes;
mod segments;
