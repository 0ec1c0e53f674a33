//! Alignment methods against what they must find and against their laws.

mod any_heading;
mod base;
mod gyrocompass;
mod inertial;
mod laws;
mod noise;
mod triad;
