//! Mechanizations and error dynamics along motions whose truth is known in closed form.

mod errors;
mod flight;
mod paths;
mod truth;
