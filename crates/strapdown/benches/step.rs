//! A navigation step against the same equations written plainly.
//!
//! `cargo bench -p schuler-strapdown` prints both; what counts is their ratio in one run.

mod plain;

use divan::{Bencher, black_box};
use schuler_frames::{B, Geodetic, Gravity, Rot, Vec3};
use schuler_strapdown::{Increments, LocalLevel, Pva, Vertical};

const STEPS: usize = 1000;
const DT: f64 = 0.01;

fn main() {
    divan::main();
}

fn start() -> Pva {
    Pva {
        position: Geodetic::new(0.785, 0.1, 500.0),
        v_t: Vec3::new(60.0, 40.0, -1.0),
        c_tb: Rot::claim([0.9, 0.1, -0.2, (1.0f64 - 0.81 - 0.01 - 0.04).sqrt()]),
    }
}

fn log() -> Vec<Increments> {
    (0..STEPS)
        .map(|k| {
            let x = k as f64 * 0.01;
            Increments {
                dtheta: Vec3::<B>::new(1e-3 * x.sin(), 2e-3 * x.cos(), 5e-4),
                dv: Vec3::<B>::new(0.01 * x.cos(), 0.005, -0.098 + 0.001 * x.sin()),
            }
        })
        .collect()
}

#[divan::bench(args = [Gravity::Somigliana, Gravity::Normal])]
fn local_level(bencher: Bencher, gravity: Gravity) {
    let log = log();
    bencher.counter(divan::counter::ItemsCount::new(STEPS)).bench_local(|| {
        let mut nav = LocalLevel::new(&start(), gravity, Vertical::Free);
        for increments in black_box(&log) {
            nav.step(increments, DT);
        }
        nav
    });
}

#[divan::bench]
fn plain_nalgebra(bencher: Bencher) {
    let log = log();
    bencher.counter(divan::counter::ItemsCount::new(STEPS)).bench_local(|| {
        let mut nav = plain::Plain::new(&start());
        for increments in black_box(&log) {
            nav.step(increments, DT);
        }
        nav
    });
}
