//! Calls something of each core crate from a program without std, allocator or operating system.
//!
//! If a dependency brings std in, the build fails with "duplicate lang item `panic_impl`"; if one
//! brings `alloc` in, with "no global memory allocator found". A new core crate gets a function here.
#![no_std]

use core::panic::PanicInfo;

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}

/// schuler-frames: gravity in three frames, attitude there and back.
#[unsafe(no_mangle)]
pub extern "C" fn frames_gate(lat: f64, yaw: f64) -> f64 {
    use schuler_frames::{B, Euler, Geodetic, Gravity, Rot, T, Vec3, c_ie, phi_between};
    let position = Geodetic::new(lat, 0.0, 100.0);
    let g_i = Gravity::Normal.gravitation_i(c_ie(yaw) * position.as_ecef());
    let c_tb: Rot<T, B> = Rot::from_euler(Euler::new(0.0, 0.0, yaw));
    let from_table = Rot::from_quaternion(c_tb.as_quaternion()).unwrap_or(Rot::IDENTITY);
    let f_b = c_tb.inverse() * (Vec3::ZERO - Gravity::Somigliana.gravity_t(position));
    g_i.norm() + f_b.norm() + phi_between(from_table, c_tb).norm()
}

/// schuler-imu: one step of a gyro with white noise.
#[unsafe(no_mangle)]
pub extern "C" fn imu_gate(seed: u64) -> f64 {
    use schuler_imu::{Error, Imu, Instrument, Source, Spec, Stream, Truth};
    let run = || -> Result<f64, Error> {
        let white = Source::named(Instrument::Gyro, "bias", "white", &[("density", 1e-4.into())])?;
        let mut imu = Imu::new(&Spec::from_sources([white])?, Stream { seed, run: 0 })?;
        Ok(imu.step(0.01, &Truth::rates([0.1, 0.0, 0.0], [0.0, 0.0, -9.8])).omega()[0])
    };
    run().unwrap_or(f64::NAN)
}

/// schuler-strapdown: one step of the local-level mechanization.
#[unsafe(no_mangle)]
pub extern "C" fn strapdown_gate(lat: f64) -> f64 {
    use schuler_frames::{Geodetic, Gravity, Rot, Vec3};
    use schuler_strapdown::{Increments, LocalLevel, Pva, Vertical};
    let start = Pva { position: Geodetic::new(lat, 0.0, 0.0), v_t: Vec3::ZERO, c_tb: Rot::IDENTITY };
    let mut nav = LocalLevel::new(&start, Gravity::Somigliana, Vertical::Held);
    nav.step(&Increments { dtheta: Vec3::ZERO, dv: Vec3::new(0.0, 0.0, -0.098) }, 0.01);
    nav.pva().position.lat
}

/// schuler-strapdown: one update of the error-state filter.
#[unsafe(no_mangle)]
pub extern "C" fn filter_gate(lat: f64) -> f64 {
    use schuler_frames::{Geodetic, Rot, Vec3};
    use schuler_imu::Spec;
    use schuler_strapdown::Pva;
    use schuler_strapdown::filter::{Filter, FilterError, Form, Model, NavStates, Now, ZeroVelocity};
    let run = || -> Result<f64, FilterError> {
        let pva = Pva { position: Geodetic::new(lat, 0.0, 0.0), v_t: Vec3::ZERO, c_tb: Rot::IDENTITY };
        let model = Model::<9>::new(Form::Phi, NavStates::ALL, &Spec::new())?;
        let mut filter = Filter::new(model, &[1.0; 9])?;
        filter.update(&ZeroVelocity::new(0.1), &Now::at(&pva))?;
        Ok(filter.sigma(3))
    };
    run().unwrap_or(f64::NAN)
}
