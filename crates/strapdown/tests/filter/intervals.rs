//! Transition and process noise of intervals of any length, against products over their steps.

use nalgebra::{Matrix3, SMatrix};
use schuler_frames::{B, Euler, Geodetic, Rot, T, Vec3, earth};
use schuler_imu::Instrument::{Accel, Gyro};
use schuler_imu::{Source, Spec, Truth};
use schuler_strapdown::filter::{Accumulator, Form, Model, NavStates, Propagation};
use schuler_strapdown::{ErrorDynamics, Increments, LocalLevel, Pva, Vertical};

use crate::accumulated::middle;
use crate::common::*;

const N: usize = 15;
type Full = SMatrix<f64, N, N>;

const DT: f64 = 0.01;
/// Steps of 21 s. Every length of interval that is tried divides it.
const STEPS: usize = 2100;

/// Increments of step `k`, which begins at `pva`.
type Motion = fn(usize, &Pva) -> Increments;

/// What keeps velocity and attitude in t as they are, but for the rate `turn` (t) and the force `push` (t).
fn kept(pva: &Pva, turn: Vec3<T>, push: Vec3<T>) -> Increments {
    let (s, c) = pva.position.lat.sin_cos();
    let ie = earth::omega_ie_t(s, c).as_vec3();
    let it = ie + earth::omega_et_t(pva.v_t, pva.position).as_vec3();
    let f = (it + ie).cross(pva.v_t) - GRAVITY.gravity_t(pva.position) + push;
    let to_body: Rot<B, T> = pva.c_tb.inverse();
    Increments { dtheta: (to_body * (it + turn)) * DT, dv: (to_body * f) * DT }
}

fn cruise(_: usize, pva: &Pva) -> Increments {
    kept(pva, Vec3::ZERO, Vec3::ZERO)
}

/// A turn of 3 deg/s, the velocity turning with the body.
fn turn(_: usize, pva: &Pva) -> Increments {
    let rate = Vec3::new(0.0, 0.0, 3.0 * DEG);
    kept(pva, rate, rate.cross(pva.v_t))
}

fn shaken(k: usize, _: &Pva) -> Increments {
    crate::accumulated::shaken(k, DT)
}

fn model(form: Form) -> Model<N> {
    let s = |i, process, given: &[(&str, f64)]| {
        let given: Vec<_> = given.iter().map(|(name, value)| (*name, (*value).into())).collect();
        Source::named(i, "bias", process, &given).unwrap()
    };
    let spec = Spec::from_sources([
        s(Gyro, "white", &[("density", 1e-5)]),
        s(Accel, "white", &[("density", 1e-4)]),
        s(Gyro, "gauss_markov", &[("sigma", 1e-6), ("tau", 100.0)]),
        s(Accel, "gauss_markov", &[("sigma", 1e-3), ("tau", 300.0)]),
    ])
    .unwrap();
    Model::new(form, NavStates::ALL, &spec).unwrap()
}

/// Largest difference of two transitions by triads of their columns, relative to the norm of `b` there. What is below a
/// hundredth, metres counting by the Schuler rate and radians by g over it, is held against that.
fn apart(a: &Full, b: &Full) -> f64 {
    const W: f64 = 1.25e-3;
    const UNIT: [f64; 5] = [W, 1.0, 9.8 / W, 9.8 / W, 1.0];
    let off = |i: usize, j: usize| {
        let (x, y) = (a.fixed_view::<3, 1>(3 * i, j), b.fixed_view::<3, 1>(3 * i, j));
        (x - y).norm() / y.norm().max(1e-2 * UNIT[j / 3] / UNIT[i])
    };
    (0..5).flat_map(|i| (0..N).map(move |j| (i, j))).map(|(i, j)| off(i, j)).fold(0.0, f64::max)
}

/// The same of two covariances, relative to the deviations of both triads.
fn correlations_apart(a: &Full, b: &Full) -> f64 {
    let off = |i: usize, j: usize| {
        let size = (triad(b, i, i).trace() * triad(b, j, j).trace()).sqrt();
        (triad(a, i, j) - triad(b, i, j)).norm() / size
    };
    (0..25).map(|k| off(k / 5, k % 5)).fold(0.0, f64::max)
}

fn triad(m: &Full, i: usize, j: usize) -> Matrix3<f64> {
    m.fixed_view::<3, 3>(3 * i, 3 * j).into_owned()
}

/// Largest relative difference of standard deviations.
fn sigmas_apart(a: &Full, b: &Full) -> f64 {
    let off = |k: usize| {
        if b[(k, k)] == 0.0 {
            assert_eq!(a[(k, k)], 0.0);
            return 0.0;
        }
        ((a[(k, k)] / b[(k, k)]).sqrt() - 1.0).abs()
    };
    (0..N).map(off).fold(0.0, f64::max)
}

/// A flight: transition and noise over it by the exact ones of every step, and the steps.
struct Flight {
    phi: Full,
    q: Full,
    steps: Vec<(Increments, Pva)>,
}

impl Flight {
    fn new(model: &Model<N>, dynamics: ErrorDynamics, motion: Motion, steps: usize) -> Flight {
        let mut nav = LocalLevel::new(&start(), GRAVITY, dynamics.vertical);
        let mut flight = Flight { phi: Full::identity(), q: Full::zeros(), steps: Vec::new() };
        let mut before = start();
        for k in 0..steps {
            let increments = motion(k, &before);
            nav.step(&increments, DT);
            let after = nav.pva();
            let seen = Truth::increments(increments.dtheta.as_array(), increments.dv.as_array());
            let middle = middle(&before, &after);
            let system = model.form().system(&dynamics, &middle, increments.dv * (1.0 / DT));
            flight.then(&Propagation::exact(model, &system, &seen, DT));
            flight.steps.push((increments, after));
            before = after;
        }
        flight
    }

    /// The same with its steps gathered `len` at a time.
    fn gathered(&self, model: &Model<N>, dynamics: ErrorDynamics, len: usize) -> Flight {
        let mut flight = Flight { phi: Full::identity(), q: Full::zeros(), steps: Vec::new() };
        let mut accumulator = Accumulator::new(model, dynamics, &start());
        for steps in self.steps.chunks(len) {
            for (increments, pva) in steps {
                accumulator.step(model, pva, increments, DT);
            }
            flight.then(&accumulator.close(model));
        }
        flight
    }

    fn then(&mut self, step: &Propagation<N>) {
        let phi = step.phi();
        self.phi = phi * self.phi;
        self.q = phi * self.q * phi.transpose() + step.q();
    }

    fn carried(&self, p: &Full) -> Full {
        self.phi * p * self.phi.transpose() + self.q
    }
}

fn start() -> Pva {
    Pva {
        position: Geodetic::new(0.785, 0.1, 1e4),
        v_t: Vec3::new(191.0, 161.0, 0.0),
        c_tb: Rot::from_euler(Euler::new(0.02, 0.03, 0.7)),
    }
}

fn p0(model: &Model<N>) -> Full {
    model.p0(&[3.0, 3.0, 5.0, 0.1, 0.1, 0.1, 3e-4, 3e-4, 3e-3]).unwrap()
}

/// What an interval leaves out grows with the square of its length, whatever that is: there is nothing of first order, and
/// no number of steps that is worse than its neighbours.
#[test]
fn intervals_of_any_length_make_the_product_over_their_steps() {
    let model = model(Form::Phi);
    let p = p0(&model);
    for (name, motion) in [("cruise", cruise as Motion), ("turn", turn), ("shaken", shaken)] {
        for vertical in [Vertical::Free, Vertical::Held] {
            let dynamics = ErrorDynamics { gravity: GRAVITY, vertical };
            let whole = Flight::new(&model, dynamics, motion, STEPS);
            let expected = whole.carried(&p);
            for len in [1, 2, 3, 7, 20, 25, 50] {
                let ours = whole.gathered(&model, dynamics, len);
                let square = (len as f64 * DT).powi(2);
                let of_phi = apart(&ours.phi, &whole.phi);
                let of_q = correlations_apart(&ours.q, &whole.q);
                let sigma = sigmas_apart(&ours.carried(&p), &expected);
                let what = format!("{name} {vertical:?} {len}: phi {of_phi:e}, q {of_q:e}, sigma {sigma:e}");
                assert!(of_phi < 1e-7 + 1e-4 * square, "{what}");
                assert!(of_q < 1e-8 + 2e-5 * square, "{what}");
                assert!(sigma < 1e-10 + 2e-8 * square, "{what}");
            }
        }
    }
}

/// Half a circle and more at 1.3 g, in either form: the velocity, and with it all that is slow, changes within each interval.
#[test]
fn a_minute_of_turn_by_twenty_steps_a_time_update() {
    for form in [Form::Phi, Form::Psi] {
        let model = model(form);
        let p = p0(&model);
        for vertical in [Vertical::Free, Vertical::Held] {
            let dynamics = ErrorDynamics { gravity: GRAVITY, vertical };
            for (steps, limit) in [(STEPS, 5e-10), (3 * STEPS, 2e-9)] {
                let whole = Flight::new(&model, dynamics, turn, steps);
                let ours = whole.gathered(&model, dynamics, 20);
                let sigma = sigmas_apart(&ours.carried(&p), &whole.carried(&p));
                assert!(sigma < limit, "{form:?} {vertical:?} {steps} steps: sigma {sigma:e}");
            }
        }
    }
}
