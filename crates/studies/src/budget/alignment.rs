//! The static alignment before a budget: tilt and heading hang together with the sensor errors that caused them.

use nalgebra::{Matrix3, SMatrix};
use schuler_frames::{B, Rate, Rot, T, Vec3};
use schuler_imu::{Imu, Instrument};
use schuler_strapdown::align::{Limits, TriadError, Vectors};
use schuler_strapdown::filter::Propagation;
use schuler_strapdown::static_base::Site;
use schuler_strapdown::{Increments, System};

use super::scene::Scene;
use super::source::{Joined, Joint};

/// Attitude error at the end by the mean errors of the sensors along body axes: `phi = gyro eps + accel nabla`, from
///
/// ```text
/// phi_N = nabla_E / g,   phi_E = -nabla_N / g,   phi_D = eps_E / (Omega cos L) - tan L nabla_E / g
/// ```
pub struct Law {
    gyro: Matrix3<f64>,
    accel: Matrix3<f64>,
    /// C_b^t of the alignment.
    c_tb: Rot<T, B>,
    limits: Limits,
}

impl Law {
    /// The law at the start of a scene.
    pub fn new(scene: &Scene) -> Law {
        let pva = scene.moment(0.0).0;
        let limits = Limits::new(Site::new(pva.position, scene.study.mechanization.gravity));
        let mut law = Law { gyro: Matrix3::zeros(), accel: Matrix3::zeros(), c_tb: pva.c_tb, limits };
        for k in 0..3 {
            let unit = std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
            law.gyro.set_column(k, &law.phi(Instrument::Gyro, unit).into());
            law.accel.set_column(k, &law.phi(Instrument::Accel, unit).into());
        }
        law
    }

    /// Attitude error (rad, north-east-down) by a mean error along body axes (rad/s, m/s²).
    pub fn phi(&self, instrument: Instrument, mean: [f64; 3]) -> [f64; 3] {
        let mean: Vec3<T> = self.c_tb * Vec3::claim(mean);
        let (eps, nabla) = match instrument {
            Instrument::Gyro => (mean, Vec3::ZERO),
            Instrument::Accel => (Vec3::ZERO, mean),
        };
        self.limits.bias(eps, nabla).as_array()
    }
}

/// Length of the alignment, s.
pub fn window(scene: &Scene) -> f64 {
    scene.time(scene.study.alignment)
}

/// Second moment of navigation errors and source states after the alignment, from `p` at its beginning.
///
/// Over the window the source's states go their way and the integrals of the sensor errors along body axes are carried beside
/// them, exactly and with their correlation; these over the window are the means that [`Law`] turns into tilt and heading.
pub fn covariance(scene: &Scene, model: &Joined, p: &Joint) -> Joint {
    let window = window(scene);
    // In place of navigation errors: nothing, integral of the accelerometer error, integral of the gyro error.
    let mut integrals = System { f: SMatrix::zeros(), b_gyro: SMatrix::zeros(), b_accel: SMatrix::zeros() };
    integrals.b_gyro.fixed_view_mut::<3, 3>(6, 0).fill_with_identity();
    integrals.b_accel.fixed_view_mut::<3, 3>(3, 0).fill_with_identity();
    let step = Propagation::exact(model, &integrals, &scene.at_rest(window), window);
    let mut p = *p;
    step.transport(&mut p);
    step.diffuse(&mut p);
    let law = Law::new(scene);
    let mut map = Joint::identity();
    map.fixed_view_mut::<9, 9>(0, 0).fill(0.0);
    map.fixed_view_mut::<3, 3>(6, 6).copy_from(&(law.gyro / window));
    map.fixed_view_mut::<3, 3>(6, 3).copy_from(&(law.accel / window));
    map * p * map.transpose()
}

/// The attitude that the alignment of one run finds, by the samples that `imu` delivers; `same` says that each of them is
/// as the first.
pub fn attitude(scene: &Scene, imu: &mut Imu, same: bool) -> Result<Rot<T, B>, TriadError> {
    let seen = scene.at_rest(scene.dt);
    let samples = if same { 1 } else { scene.study.alignment };
    let mut sum = Increments { dtheta: Vec3::ZERO, dv: Vec3::ZERO };
    for _ in 0..samples {
        let measured = imu.step(scene.dt, &seen);
        sum.dtheta += Vec3::claim(measured.dtheta);
        sum.dv += Vec3::claim(measured.dv);
    }
    let mean = 1.0 / scene.time(samples);
    let omega = Rate::<B, schuler_frames::I, B>::claim(sum.dtheta * mean);
    let start = &scene.study.start;
    Vectors::ForceFirst.attitude(sum.dv * mean, omega, start.position, scene.study.mechanization.gravity)
}
