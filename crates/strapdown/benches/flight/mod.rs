//! The flight that the benches navigate.

use schuler_frames::{B, Geodetic, Rot, Vec3};
use schuler_strapdown::{Increments, Pva};

pub const STEPS: usize = 1000;
pub const DT: f64 = 0.01;

pub fn start() -> Pva {
    Pva {
        position: Geodetic::new(0.785, 0.1, 500.0),
        v_t: Vec3::new(60.0, 40.0, -1.0),
        c_tb: Rot::claim([0.9, 0.1, -0.2, 0.14f64.sqrt()]),
    }
}

pub fn log() -> impl Iterator<Item = Increments> {
    (0..STEPS).map(|k| {
        let x = (k % 64) as f64 * 0.015;
        Increments {
            dtheta: Vec3::<B>::new(1e-3 * x, 2e-3 - 1e-3 * x, 5e-4),
            dv: Vec3::<B>::new(0.01 * x, 0.005, -0.098 + 0.001 * x),
        }
    })
}
