//! Narrow lanes and the widest of the machine give the same bits.

use fearless_simd::Level;
use nalgebra::SMatrix;
use schuler_frames::{Geodetic, Gravity, Rot, Vec3};
use schuler_imu::Instrument::{Accel, Gyro};
use schuler_imu::{Source, Spec, random::best_level};

use super::{Accumulator, Form, Model, NavStates};
use crate::{ErrorDynamics, Increments, LocalLevel, Pva, Vertical};

/// Phi, Q and P after intervals of several lengths in a turn, with gyro biases that fade within `tau` (s).
fn flown<const N: usize>(nav: NavStates, tau: f64, level: Level) -> [SMatrix<f64, N, N>; 3] {
    let source = |i, process, given: &[_]| Source::named(i, "bias", process, given).unwrap();
    let spec = Spec::from_sources([
        source(Gyro, "white", &[("density", 1e-5.into())]),
        source(Accel, "white", &[("density", 1e-4.into())]),
        source(Gyro, "gauss_markov", &[("sigma", 1e-6.into()), ("tau", tau.into())]),
        source(Accel, "constant", &[("sigma", 1e-3.into())]),
    ])
    .unwrap();
    let model = Model::<N>::new(Form::Phi, nav, &spec).unwrap();
    let start = Pva {
        position: Geodetic::new(0.8, 0.1, 500.0),
        v_t: Vec3::new(60.0, 40.0, -1.0),
        c_tb: Rot::claim([0.9, 0.1, -0.2, libm::sqrt(0.14)]),
    };
    let (gravity, vertical, dt) = (Gravity::Somigliana, Vertical::Free, 0.01);
    let mut navigator = LocalLevel::new(&start, gravity, vertical);
    let mut accumulator = Accumulator::new(&model, ErrorDynamics { gravity, vertical }, &start);
    accumulator.level = level;
    let mut p = model.p0(&[3.0, 3.0, 5.0, 0.1, 0.1, 0.1, 3e-4, 3e-4, 3e-3]).unwrap();
    let mut last = (SMatrix::identity(), SMatrix::zeros());
    for (interval, steps) in [20, 7, 8, 1, 21].into_iter().enumerate() {
        for k in 0..steps {
            let x = 0.1 * (k + interval) as f64;
            let increments = Increments {
                dtheta: Vec3::new(1e-3 * x, 2e-3 - 1e-3 * x, 5e-4),
                dv: Vec3::new(0.01 * x, 0.005, -0.098 + 0.001 * x),
            };
            navigator.step(&increments, dt);
            accumulator.step(&model, &navigator.pva(), &increments, dt);
        }
        let mut step = accumulator.close(&model);
        step.level = level;
        step.apply(&mut p);
        last = (step.phi(), step.q());
    }
    [last.0, last.1, p]
}

#[test]
fn lanes_of_any_width_give_the_same_bits() {
    let bits = |m: &[SMatrix<f64, 15, 15>; 3]| m.map(|m| m.map(f64::to_bits));
    let wide_bits = |m: &[SMatrix<f64, 21, 21>; 3]| m.map(|m| m.map(f64::to_bits));
    let levels = [Level::baseline(), best_level()];
    // Followed through the steps, or from what the body does.
    for tau in [3.0, 100.0] {
        let [narrow, wide] = levels.map(|level| flown::<15>(NavStates::ALL, tau, level));
        assert_eq!(bits(&narrow), bits(&wide));
        for nav in [NavStates::ALL, NavStates::LEVEL] {
            let [narrow, wide] = levels.map(|level| flown::<21>(nav, tau, level));
            assert_eq!(wide_bits(&narrow), wide_bits(&wide));
        }
    }
}
