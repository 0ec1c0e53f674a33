//! The baro-inertial loops against their closed forms, in the three mechanizations and in the error dynamics.
//!
//! With triple pole at -1/tau and u = t/tau: an accelerometer step b makes dh = b t² exp(-u) / 2, an initial height
//! error d makes dh = d (1 - 2u + u²/2) exp(-u). The second-order loop with double pole: b tau² (1 - (1 + u) exp(-u)).
//! That is the channel by itself. Coriolis acceleration couples it to the east velocity: 2e-3 at mid-latitudes, nothing
//! at the pole. So the runs are near one.

use nalgebra::SVector;
use schuler_frames::{B, Geodetic, Gravity, Rot, Vec3, earth};
use schuler_strapdown::{
    BaroLoop, EarthFixed, ErrorDynamics, Increments, Inertial, LocalLevel, Mechanization, Pva, Vertical,
};

const GRAVITY: Gravity = Gravity::Somigliana;
const TAU: f64 = 100.0;
const B_UP: f64 = 100.0 * 9.80665e-6;
const H: f64 = 300.0;

fn place(h: f64) -> Pva {
    Pva { position: Geodetic::new(89f64.to_radians(), 0.2, h), v_t: Vec3::ZERO, c_tb: Rot::IDENTITY }
}

/// -dg/dh, 1/s².
fn instability() -> f64 {
    -GRAVITY.gradient_t(place(H).position).1[2]
}

/// Height errors in t, e and i at the times, after a start at `dh` with the accelerometer error `b_up`.
fn heights(baro: BaroLoop, dh: f64, b_up: f64, times: &[f64]) -> Vec<[f64; 3]> {
    const DT: f64 = 0.05;
    let (truth, start) = (place(H), place(H + dh));
    let vertical = Vertical::Damped(baro);
    let mut all: [Box<dyn Mechanization>; 3] = [
        Box::new(LocalLevel::new(&start, GRAVITY, vertical)),
        Box::new(EarthFixed::new(&start, GRAVITY, vertical)),
        Box::new(Inertial::new(&start, GRAVITY, vertical)),
    ];
    let (s, c) = truth.position.lat.sin_cos();
    let omega = earth::omega_ie_t(s, c).as_vec3() * DT;
    let f = (-GRAVITY.gravity_t(truth.position) - Vec3::new(0.0, 0.0, b_up)) * DT;
    let increments =
        Increments { dtheta: Vec3::<B>::claim(omega.as_array()), dv: Vec3::<B>::claim(f.as_array()) };
    let mut k = 0.0;
    let mut rows = Vec::new();
    for &t in times {
        while k * DT < t - 0.5 * DT {
            all.iter_mut().for_each(|nav| nav.step(&increments, DT));
            k += 1.0;
        }
        rows.push(std::array::from_fn(|n| all[n].pva().position.h - H));
    }
    rows
}

/// The same by transition matrices.
fn linear_heights(baro: BaroLoop, dh: f64, b_up: f64, times: &[f64]) -> Vec<f64> {
    let dynamics = ErrorDynamics { gravity: GRAVITY, vertical: Vertical::Damped(baro) };
    let truth = place(H);
    let f_b = Vec3::claim((-GRAVITY.gravity_t(truth.position)).as_array());
    times
        .iter()
        .map(|&t| {
            let step = dynamics.transition_at_middle(&truth, f_b, t);
            -(step.phi[(2, 2)] * -dh + step.gamma[(2, 5)] * -b_up)
        })
        .collect()
}

/// The three runs, which share one bound with the transition matrices, against `closed`.
fn check(baro: BaroLoop, dh: f64, b_up: f64, closed: impl Fn(f64) -> f64, largest: f64) {
    let times: Vec<f64> = (1..=30).map(|k| 50.0 * f64::from(k)).collect();
    let runs = heights(baro, dh, b_up, &times);
    let linear = linear_heights(baro, dh, b_up, &times);
    for ((t, run), linear) in times.iter().zip(runs).zip(linear) {
        let expected = closed(*t);
        for (k, h) in run.into_iter().chain([linear]).enumerate() {
            let off = (h - expected).abs();
            assert!(off < 3e-6 * largest, "{k} at {t} s: {h} m against {expected} m");
        }
    }
}

#[test]
fn third_order_loop_follows_its_closed_forms() {
    let baro = BaroLoop::third_order(TAU, instability(), H);
    // At two time constants: 2 b tau² / e², 2.654 m.
    let peak = 2.0 * B_UP * TAU * TAU * (-2f64).exp();
    assert!((peak - 2.654).abs() < 5e-4);
    check(baro, 0.0, B_UP, |t| 0.5 * B_UP * t * t * (-t / TAU).exp(), peak);
    let initial = |t: f64| 10.0 * (1.0 - 2.0 * t / TAU + 0.5 * (t / TAU).powi(2)) * (-t / TAU).exp();
    check(baro, 10.0, 0.0, initial, 10.0);
}

#[test]
fn second_order_loop_is_left_with_b_tau_squared() {
    let baro = BaroLoop::second_order(TAU, instability(), H);
    let last = B_UP * TAU * TAU;
    check(baro, 0.0, B_UP, |t| last * (1.0 - (1.0 + t / TAU) * (-t / TAU).exp()), last);
}

/// Steady height under white accelerometer noise, density n: n tau^1.5 / 4 (10 ug/√Hz: 0.02452 m); under white noise of
/// the reference, density r: r √(33 / (16 tau)); a constant error of the reference passes whole.
#[test]
fn third_order_loop_passes_noise_as_its_closed_forms_say() {
    let baro = BaroLoop::third_order(TAU, instability(), H);
    let truth = place(H);
    let f_b = Vec3::claim((-GRAVITY.gravity_t(truth.position)).as_array());
    let system = |vertical| ErrorDynamics { gravity: GRAVITY, vertical }.system(&truth, f_b);
    let transition = |dt| {
        ErrorDynamics { gravity: GRAVITY, vertical: Vertical::Damped(baro) }
            .transition_at_middle(&truth, f_b, dt)
    };
    // An error of the reference enters where the height error is fed back, with the other sign, and dh = -x_D.
    let fed_back = system(Vertical::Damped(baro)).f - system(Vertical::Free).f;
    let mut reference = SVector::<f64, 10>::zeros();
    reference.fixed_rows_mut::<9>(0).copy_from(&fed_back.column(2));
    reference[9] = -baro.k3;
    let mut accelerometer = SVector::<f64, 10>::zeros();
    accelerometer[5] = 1.0;
    const DT: f64 = 0.5;
    let (whole, half) = (transition(DT), transition(0.5 * DT));
    // Variance and, for a constant input, the value after 2000 s; the integral over a step by Simpson's rule.
    let (mut variance, mut value) = ([0.0; 2], 0.0);
    let mut at_start = [accelerometer, reference];
    for _ in 0..4000 {
        for (k, x) in at_start.iter_mut().enumerate() {
            let (a, b, c) = (*x, half.phi * *x, whole.phi * *x);
            variance[k] += DT / 6.0 * (a[2] * a[2] + 4.0 * b[2] * b[2] + c[2] * c[2]);
            if k == 1 {
                value += DT / 6.0 * (a[2] + 4.0 * b[2] + c[2]);
            }
            *x = c;
        }
    }
    let n = 10.0 * 9.80665e-6;
    let sd = n * variance[0].sqrt();
    let expected = n * TAU.powf(1.5) / 4.0;
    assert!((expected - 0.02452).abs() < 5e-6 && (sd / expected - 1.0).abs() < 1e-6, "{sd}");
    // The closed form leaves out the instability of the channel within the gain k2: 0.3 %.
    let ratio = variance[1].sqrt() / (33.0 / (16.0 * TAU)).sqrt();
    assert!((ratio - 1.0).abs() < 3e-3, "{ratio}");
    assert!((value + 1.0).abs() < 1e-6, "{value}");
}
