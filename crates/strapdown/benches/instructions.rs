//! Instructions of a thousand navigation steps: the same count on every run, however busy the machine is.
//!
//! Needs valgrind and the runner of the harness: `cargo install gungraun-runner --version 0.20.0`, then
//! `cargo bench -p schuler-strapdown --bench instructions`. `cargo bench --bench step` needs neither.

// The attributes expand to undocumented modules and paths of their own.
#![allow(missing_docs, unused_qualifications)]

mod flight;
mod plain;

use std::hint::black_box;

use gungraun::{library_benchmark, library_benchmark_group, main};
use schuler_frames::Gravity;
use schuler_strapdown::{LocalLevel, Pva, Vertical};

#[library_benchmark]
#[bench::somigliana(Gravity::Somigliana)]
#[bench::normal(Gravity::Normal)]
fn local_level(gravity: Gravity) -> Pva {
    let mut nav = LocalLevel::new(&flight::start(), gravity, Vertical::Free);
    for increments in black_box(flight::log()) {
        nav.step(&increments, flight::DT);
    }
    nav.pva()
}

#[library_benchmark]
fn plain_nalgebra() -> f64 {
    let mut nav = plain::Plain::new(&flight::start());
    for increments in black_box(flight::log()) {
        nav.step(&increments, flight::DT);
    }
    nav.lat
}

// What making the log costs: to be taken off the others.
#[library_benchmark]
fn log_alone() -> usize {
    black_box(flight::log()).count()
}

library_benchmark_group!(name = step, benchmarks = [local_level, plain_nalgebra, log_alone]);
main!(library_benchmark_groups = step);
