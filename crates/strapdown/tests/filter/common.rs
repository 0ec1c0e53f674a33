//! The static base that most tests stand on.

use schuler_frames::{B, Euler, Geodetic, Gravity, Rot, T, Vec3, earth};
use schuler_imu::Instrument::{Accel, Gyro};
use schuler_imu::process::LinearModel;
use schuler_imu::{Source, Spec, Truth};
use schuler_strapdown::filter::{Form, Model, NavStates, Propagation};
use schuler_strapdown::{ErrorDynamics, Pva, Vertical};

pub const DEG: f64 = std::f64::consts::PI / 180.0;
/// 1 deg/h in rad/s and 1 deg/√h in rad/√s.
pub const DEGPH: f64 = DEG / 3600.0;
pub const DEGPRTH: f64 = DEG / 60.0;
pub const UG: f64 = 9.80665e-6;
pub const ARCMIN: f64 = DEG / 60.0;
pub const GRAVITY: Gravity = Gravity::Somigliana;
pub const HELD: ErrorDynamics = ErrorDynamics { gravity: GRAVITY, vertical: Vertical::Held };

/// At rest at latitude `lat` and height 0, level, with the heading `yaw` (rad).
pub fn at_rest(lat: f64, yaw: f64) -> Pva {
    Pva {
        position: Geodetic::new(lat, 0.0, 0.0),
        v_t: Vec3::ZERO,
        c_tb: Rot::from_euler(Euler::new(0.0, 0.0, yaw)),
    }
}

/// What ideal sensors at rest feel: omega_ib^b and f^b.
pub fn felt(pva: &Pva) -> (Vec3<B>, Vec3<B>) {
    let (s, c) = pva.position.lat.sin_cos();
    let to_body: Rot<B, T> = pva.c_tb.inverse();
    (to_body * earth::omega_ie_t(s, c).as_vec3(), to_body * -GRAVITY.gravity_t(pva.position))
}

pub fn seen(pva: &Pva) -> Truth {
    let (omega, f) = felt(pva);
    Truth::rates(omega.as_array(), f.as_array())
}

/// White noise and constant biases of both triads.
pub fn sensors(arw: f64, vrw: f64, bias_g: f64, bias_a: f64) -> Spec {
    let source = |instrument, process, name, value: f64| {
        Source::named(instrument, "bias", process, &[(name, value.into())]).unwrap()
    };
    Spec::from_sources([
        source(Gyro, "white", "density", arw),
        source(Accel, "white", "density", vrw),
        source(Accel, "constant", "sigma", bias_a),
        source(Gyro, "constant", "sigma", bias_g),
    ])
    .unwrap()
}

/// Without the bias of the accelerometer z, which nothing at rest and level depends on.
pub fn ten(spec: &Spec) -> Spec {
    spec.keep(|c| {
        !(c.instrument() == Accel && c.label() == "z" && c.source().process().kind().name() == "constant")
    })
}

/// The ten states of static alignment: velocity north and east, attitude, accelerometer x and y, gyro x, y and z.
pub fn ten_states(spec: &Spec) -> Model<10> {
    Model::new(Form::Phi, NavStates::LEVEL, &ten(spec)).unwrap()
}

/// A Gauss-Markov process by itself.
pub fn gauss_markov(sigma: f64, tau: f64) -> LinearModel {
    let source =
        Source::named(Accel, "bias", "gauss_markov", &[("sigma", sigma.into()), ("tau", tau.into())])
            .unwrap();
    source.components().next().unwrap().evolution().linear_model()
}

/// The exact time update at rest.
pub fn at_rest_step<const N: usize>(model: &Model<N>, pva: &Pva, dt: f64) -> Propagation<N> {
    let system = model.form().system(&HELD, pva, felt(pva).1);
    Propagation::exact(model, &system, &seen(pva), dt)
}
