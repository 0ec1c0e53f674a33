//! Linear error dynamics along a manoeuvring flight.

use schuler_frames::{B, Geodetic, Gravity, Rot, Vec3, with_phi, with_position_error};
use schuler_strapdown::static_base::{Drivers, Site, exact};
use schuler_strapdown::{BaroLoop, ErrorDynamics, Increments, LocalLevel, NavError, PsiMap, Pva, Vertical};

use crate::paths::{GreatCircle, Manoeuvres};
use crate::truth::{Trajectory, at, increments};

const GRAVITY: Gravity = Gravity::Normal;
const RATE: f64 = 100.0;
const DURATION: f64 = 600.0;

/// Sizes of the errors: position, velocity, attitude, gyro, accelerometer.
const SIZE: [f64; 5] = [1.0, 0.01, 1e-5, 1e-8, 1e-4];

fn start(truth: &Pva, source: usize, sign: f64) -> Pva {
    let mut error = [Vec3::ZERO; 3];
    if source < 9 {
        let mut axis = [0.0; 3];
        axis[source % 3] = sign * SIZE[source / 3];
        error[source / 3] = Vec3::claim(axis);
    }
    Pva {
        position: with_position_error(truth.position, error[0]),
        v_t: truth.v_t + error[1],
        c_tb: with_phi(truth.c_tb, error[2]),
    }
}

fn corrupt(increments: &Increments, source: usize, sign: f64) -> Increments {
    let mut corrupted = *increments;
    if source >= 9 {
        let mut axis = [0.0; 3];
        axis[source % 3] = sign * SIZE[source / 3] / RATE;
        if source < 12 {
            corrupted.dtheta += Vec3::claim(axis);
        } else {
            corrupted.dv += Vec3::claim(axis);
        }
    }
    corrupted
}

/// For every source, the largest deviation of the linear propagation from half the difference of two non-linear runs,
/// each of the nine errors relative to the largest value of its curve.
fn deviations(vertical: Vertical) -> [[f64; 9]; 15] {
    let dynamics = ErrorDynamics { gravity: GRAVITY, vertical };
    let truth = at(&Manoeuvres, GRAVITY, 0.0).pva;
    let mut nominal = LocalLevel::new(&truth, GRAVITY, vertical);
    let pair =
        |source| [1.0, -1.0].map(|sign| LocalLevel::new(&start(&truth, source, sign), GRAVITY, vertical));
    let mut pairs: [[LocalLevel; 2]; 15] = std::array::from_fn(pair);
    let mut linear = nalgebra::SMatrix::<f64, 10, 15>::zeros();
    for source in 0..9 {
        linear[(source, source)] = SIZE[source / 3];
    }
    let mut inputs = nalgebra::SMatrix::<f64, 6, 15>::zeros();
    for source in 9..15 {
        inputs[(source - 9, source)] = SIZE[source / 3];
    }
    let (mut worst, mut largest) = ([[0f64; 9]; 15], [[0f64; 9]; 15]);
    for k in 0..(0.5 * DURATION * RATE) as usize {
        let mut force = Vec3::<B>::ZERO;
        let mut middle = nominal.pva();
        for half in 0..2 {
            let true_increments = increments(&Manoeuvres, GRAVITY, (2 * k + half) as f64 / RATE, 1.0 / RATE);
            for (source, pair) in pairs.iter_mut().enumerate() {
                for (nav, sign) in pair.iter_mut().zip([1.0, -1.0]) {
                    nav.step(&corrupt(&true_increments, source, sign), 1.0 / RATE);
                }
            }
            // Both halves of the force in the axes of the middle.
            let turned = true_increments.dtheta.cross(true_increments.dv) * 0.5;
            force += true_increments.dv + if half == 0 { -turned } else { turned };
            nominal.step(&true_increments, 1.0 / RATE);
            if half == 0 {
                middle = nominal.pva();
            }
        }
        let step = dynamics.transition_at_middle(&middle, force * (0.5 * RATE), 2.0 / RATE);
        linear = step.phi * linear + step.gamma * inputs;
        let now = nominal.pva();
        for (source, [plus, minus]) in pairs.iter().enumerate() {
            let (plus, minus) = (NavError::between(&plus.pva(), &now), NavError::between(&minus.pva(), &now));
            for row in 0..9 {
                let curve = 0.5 * (plus.as_array()[row] - minus.as_array()[row]);
                assert!(curve.is_finite() && linear[(row, source)].is_finite(), "a run without numbers");
                worst[source][row] = worst[source][row].max((linear[(row, source)] - curve).abs());
                largest[source][row] = largest[source][row].max(curve.abs());
            }
        }
    }
    // A longitude error moves nothing else: those curves are rounding.
    let resolved = |source: usize, row: usize| source != 1 || row == 1;
    std::array::from_fn(|s| {
        std::array::from_fn(|r| if resolved(s, r) { worst[s][r] / largest[s][r].max(1e-300) } else { 0.0 })
    })
}

/// Every initial error and every sensor bias over 600 s of turns and climbs: within 1e-5 of the largest value
/// of each of the nine curves, at a step of 20 ms with its middle.
#[test]
fn linear_errors_follow_half_the_difference_of_nonlinear_runs() {
    let baro = BaroLoop::third_order(100.0, 3e-6, 6000.0);
    for vertical in [Vertical::Free, Vertical::Held, Vertical::Damped(baro)] {
        let deviations = deviations(vertical);
        for (source, row) in deviations.iter().enumerate() {
            assert!(row.iter().all(|d| *d < 1e-5), "{vertical:?}, source {source}: {row:.1?}");
        }
    }
}

/// With x_psi = M x_phi along a flight, F_psi M = M F_phi + M', to the rounding of a difference quotient for M'.
#[test]
fn psi_form_is_the_phi_form_in_other_coordinates() {
    let circle = GreatCircle { highest: 1.0, period: 30_000.0 };
    let cases: [(&dyn Trajectory, Vertical); 2] = [(&Manoeuvres, Vertical::Free), (&circle, Vertical::Held)];
    for (path, vertical) in cases {
        let dynamics = ErrorDynamics { gravity: GRAVITY, vertical };
        for k in 0..40 {
            let t = 37.0 * f64::from(k);
            let now = at(path, GRAVITY, t);
            let map = |dt: f64| PsiMap::new(&at(path, GRAVITY, t + dt).pva).psi_from_phi;
            const H: f64 = 0.02;
            let m_dot = ((map(H) - map(-H)) * 8.0 - (map(2.0 * H) - map(-2.0 * H))) / (12.0 * H);
            let PsiMap { psi_from_phi: m, phi_from_psi } = PsiMap::new(&now.pva);
            assert_eq!(m * phi_from_psi, nalgebra::SMatrix::<f64, 9, 9>::identity());
            let (psi, phi) = (dynamics.system_psi(&now.pva, now.f_b), dynamics.system(&now.pva, now.f_b));
            assert_eq!(m * phi.b_gyro, psi.b_gyro);
            assert_eq!(m * phi.b_accel, psi.b_accel);
            let off = psi.f * m - m * phi.f - m_dot;
            let scale = psi.f.abs() * m.abs() + m.abs() * phi.f.abs() + m_dot.abs();
            for row in 0..9 {
                for column in 0..9 {
                    // Held: the vertical velocity error is none in phi, and not a state of its own in psi.
                    if vertical == Vertical::Held && (row == 5 || column == 5) {
                        continue;
                    }
                    let (off, scale) = (off[(row, column)].abs(), scale[(row, column)]);
                    assert!(
                        off < 1e-9 * scale + 1e-20,
                        "{vertical:?} at {t} s ({row}, {column}): {off:e} of {scale:e}"
                    );
                }
            }
        }
    }
}

/// Fourth order in the step with the nodes of Gauss, second with the middle.
#[test]
fn transitions_converge_with_their_order() {
    let dynamics = ErrorDynamics { gravity: GRAVITY, vertical: Vertical::Free };
    let moment = |t: f64| at(&Manoeuvres, GRAVITY, t);
    let over = |dt: f64, gauss: bool| {
        let mut phi = nalgebra::SMatrix::<f64, 10, 10>::identity();
        let mut gamma = nalgebra::SMatrix::<f64, 10, 6>::zeros();
        for k in 0..(64.0 / dt) as usize {
            let t = k as f64 * dt;
            let step = if gauss {
                let [a, b] = ErrorDynamics::NODES.map(|node| moment(t + node * dt));
                dynamics.transition([(&a.pva, a.f_b), (&b.pva, b.f_b)], dt)
            } else {
                let middle = moment(t + 0.5 * dt);
                dynamics.transition_at_middle(&middle.pva, middle.f_b, dt)
            };
            phi = step.phi * phi;
            gamma = step.phi * gamma + step.gamma;
        }
        (phi, gamma)
    };
    // Position north from gyro y and from heading.
    let of = |(phi, gamma): &(nalgebra::SMatrix<f64, 10, 10>, nalgebra::SMatrix<f64, 10, 6>)| {
        [phi[(0, 8)], gamma[(0, 1)], gamma[(1, 3)]]
    };
    let best = of(&over(0.125, true));
    for (gauss, order) in [(true, 4.0), (false, 2.0)] {
        let errors = [2.0, 1.0].map(|dt| of(&over(dt, gauss)));
        for k in 0..3 {
            let observed = ((errors[0][k] - best[k]) / (errors[1][k] - best[k])).abs().log2();
            assert!(observed > order - 0.3, "nodes of Gauss {gauss}, entry {k}: order {observed}");
        }
    }
}

/// At rest nothing changes along the way, so a step may be as long as one likes: a day in steps of ten minutes against
/// the closed form of the static base.
#[test]
fn transition_at_rest_is_the_closed_form() {
    let position = Geodetic::new(0.8, 0.1, 0.0);
    let drivers = Drivers {
        phi0: Vec3::new(1e-5, -2e-5, 3e-4),
        dv0: Vec3::new(0.1, -0.05, 0.0),
        dlat0: 1e-6,
        eps: Vec3::new(3e-8, -5e-8, 2e-8),
        nabla: Vec3::new(1e-4, -2e-4, 0.0),
        ..Drivers::default()
    };
    let site = Site::new(position, GRAVITY);
    let response = exact(&site, &drivers);
    let pva = Pva { position, v_t: Vec3::ZERO, c_tb: Rot::IDENTITY };
    let f_b = Vec3::claim((-GRAVITY.gravity_t(position)).as_array());
    let dynamics = ErrorDynamics { gravity: GRAVITY, vertical: Vertical::Held };
    let step = dynamics.transition([(&pva, f_b), (&pva, f_b)], 600.0);
    let mut x = nalgebra::SVector::<f64, 10>::zeros();
    x[0] = drivers.dlat0 * site.r_m;
    for axis in 0..3 {
        x[3 + axis] = drivers.dv0[axis];
        x[6 + axis] = drivers.phi0[axis];
    }
    let mut u = nalgebra::SVector::<f64, 6>::zeros();
    for axis in 0..3 {
        u[axis] = drivers.eps[axis];
        u[3 + axis] = drivers.nabla[axis];
    }
    let mut largest = [0f64; 9];
    let mut off = [0f64; 9];
    for k in 1..=144 {
        x = step.phi * x + step.gamma * u;
        let e = response.at(600.0 * f64::from(k));
        let expected = NavError { dr: e.dr, dv: e.dv, phi: e.phi }.as_array();
        for row in 0..9 {
            largest[row] = largest[row].max(expected[row].abs());
            off[row] = off[row].max((x[row] - expected[row]).abs());
        }
    }
    for row in 0..9 {
        assert!(off[row] <= 1e-9 * largest[row], "row {row}: {:e} of {:e}", off[row], largest[row]);
    }
}
