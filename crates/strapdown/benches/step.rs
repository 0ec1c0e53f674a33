//! A navigation step against the same equations written plainly.
//!
//! `cargo bench -p schuler-strapdown` prints both; what counts is their ratio in one run.

mod flight;
mod plain;

use divan::{Bencher, black_box};
use schuler_frames::{B, Gravity, Vec3};
use schuler_strapdown::{
    EarthFixed, Eight, Increments, Inertial, LANES, LocalLevel, LocalLevelLanes, Vertical, WanderAzimuth,
};

fn main() {
    divan::main();
}

#[divan::bench(args = [Gravity::Somigliana, Gravity::Normal])]
fn local_level(bencher: Bencher, gravity: Gravity) {
    let log: Vec<_> = flight::log().collect();
    bencher.counter(divan::counter::ItemsCount::new(flight::STEPS)).bench_local(|| {
        let mut nav = LocalLevel::new(&flight::start(), gravity, Vertical::Free);
        for increments in black_box(&log) {
            nav.step(increments, flight::DT);
        }
        nav
    });
}

/// Eight runs in lanes; an item is a step of one of them.
#[divan::bench(args = [Gravity::Somigliana, Gravity::Normal])]
fn local_level_lanes(bencher: Bencher, gravity: Gravity) {
    let eight = |v: Vec3<B>| Vec3::<B, Eight>::claim(v.as_array().map(|x| [x; LANES]));
    let log: Vec<Increments<Eight>> =
        flight::log().map(|i| Increments { dtheta: eight(i.dtheta), dv: eight(i.dv) }).collect();
    bencher.counter(divan::counter::ItemsCount::new(flight::STEPS * LANES)).bench_local(|| {
        let mut nav = LocalLevelLanes::new(&[flight::start(); LANES], gravity, Vertical::Free);
        nav.steps(black_box(&log), flight::DT);
        nav
    });
}

#[divan::bench(args = [Gravity::Somigliana, Gravity::Normal])]
fn earth_fixed(bencher: Bencher, gravity: Gravity) {
    let log: Vec<_> = flight::log().collect();
    bencher.counter(divan::counter::ItemsCount::new(flight::STEPS)).bench_local(|| {
        let mut nav = <EarthFixed>::new(&flight::start(), gravity, Vertical::Free);
        for increments in black_box(&log) {
            nav.step(increments, flight::DT);
        }
        nav
    });
}

#[divan::bench(args = [Gravity::Somigliana, Gravity::Normal])]
fn inertial(bencher: Bencher, gravity: Gravity) {
    let log: Vec<_> = flight::log().collect();
    bencher.counter(divan::counter::ItemsCount::new(flight::STEPS)).bench_local(|| {
        let mut nav = <Inertial>::new(&flight::start(), gravity, Vertical::Free);
        for increments in black_box(&log) {
            nav.step(increments, flight::DT);
        }
        nav
    });
}

#[divan::bench(args = [Gravity::Somigliana, Gravity::Normal])]
fn wander_azimuth(bencher: Bencher, gravity: Gravity) {
    let log: Vec<_> = flight::log().collect();
    bencher.counter(divan::counter::ItemsCount::new(flight::STEPS)).bench_local(|| {
        let mut nav = WanderAzimuth::new(&flight::start(), gravity, Vertical::Free);
        for increments in black_box(&log) {
            nav.step(increments, flight::DT);
        }
        nav
    });
}

#[divan::bench]
fn plain_nalgebra(bencher: Bencher) {
    let log: Vec<_> = flight::log().collect();
    bencher.counter(divan::counter::ItemsCount::new(flight::STEPS)).bench_local(|| {
        let mut nav = plain::Plain::new(&flight::start());
        for increments in black_box(&log) {
            nav.step(increments, flight::DT);
        }
        nav
    });
}
