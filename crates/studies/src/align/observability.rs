//! What the measurements of an alignment can tell of each state of a filter, and what they never will.

use nalgebra::{DMatrix, SMatrix};
use schuler_frames::{B, Rot, T, Vec3, earth};
use schuler_imu::{Input, Instrument, Truth};
use schuler_strapdown::filter::{Accumulator, Now, Observability, limit_covariance};
use schuler_strapdown::{ErrorDynamics, Increments, Pva};

use super::fine::{Fine, ROOM};
use super::place::Place;
use super::scene::Scene;
use crate::scenario::FilterSettings;

/// What a filter's measurements tell of its states.
pub struct Observed {
    /// Independent combinations that are observed, of how many that vary.
    pub rank: usize,
    pub of: usize,
    pub states: Vec<State>,
    /// The combinations that are not, in words: at rest those that never are, of a base that rocks those of which the run tells
    /// little.
    pub unseen: Vec<String>,
    /// Whether the base rocks.
    pub rocks: bool,
}

/// One state.
pub struct State {
    pub name: String,
    /// Standard deviation at the start, and what is left of it: at rest after endless measurement without noise, of a base that rocks
    /// after the measurements of the run with no other noise than theirs.
    pub start: f64,
    pub limit: f64,
}

/// A combination is observed by a run that leaves less than half of its variance.
const HALF: f64 = 0.5;

/// A part of a combination that is smaller than this in standard deviations is rounding.
const PART: f64 = 1e-6;

/// The same where combinations are not exact.
const INEXACT: f64 = 0.02;

/// What a filter with `settings` observes at rest in each of the `attitudes` after the other.
pub fn at_rest(settings: &FilterSettings, place: &Place, attitudes: &[Rot<T, B>]) -> Option<Observed> {
    let fine = Fine::new(settings).ok()?;
    let (model, p0) = (fine.filter().model(), fine.filter().p);
    let n = model.len();
    let sigma: [f64; ROOM] = std::array::from_fn(|k| p0[(k, k)].sqrt());
    let mut observability = Observability::new(n, sigma);
    let dynamics = ErrorDynamics { gravity: place.gravity, vertical: place.vertical };
    let (s, c) = place.position.lat.sin_cos();
    for &c_tb in attitudes {
        let pva = Pva { position: place.position, v_t: Vec3::ZERO, c_tb };
        let f_b = c_tb.inverse() * -place.gravity.gravity_t(place.position);
        let omega_b = c_tb.inverse() * earth::omega_ie_t(s, c).as_vec3();
        let seen = Truth::rates(omega_b.as_array(), f_b.as_array());
        let system = model.form().system(&dynamics, &pva, f_b);
        let now = Now::new(&pva, omega_b, f_b);
        let observation = fine.observation(place, [0.0; 2], &now).ok()?;
        observability.add_observation(model, &system, &seen, &observation, &now);
    }
    let (null, nullity) = observability.null_space();
    let left = limit_covariance(&null, nullity, &p0, n);
    let names: Vec<String> = (0..n).map(|k| model.name(k).to_string()).collect();
    let states = (0..n)
        .map(|k| State { name: names[k].clone(), start: sigma[k], limit: left[(k, k)].max(0.0).sqrt() })
        .collect();
    let unseen = all_words(&null, nullity, &sigma, &names, PART);
    Some(Observed { rank: observability.rank(), of: observability.states(), states, unseen, rocks: false })
}

/// What the measurements of a run tell a filter with `settings` on a base that rocks.
///
/// With Phi the transition from the start, by the true motion, H and R those of a measurement, the information in units of the
/// standard deviations S of the start is `G = sum S Phi' H' R⁻¹ H Phi S`, and `(1 + G)⁻¹` is the share of the start's variance that
/// is left: rank and combinations by its eigenvectors, weighed by what is left. Noise other than that of the measurements
/// would leave more.
pub fn rocking(settings: &FilterSettings, place: &Place, scene: &Scene, every: u64) -> Option<Observed> {
    let fine = Fine::new(settings).ok()?;
    let (model, p0) = (fine.filter().model(), fine.filter().p);
    let n = model.len();
    let sigma: [f64; ROOM] = std::array::from_fn(|k| p0[(k, k)].sqrt());
    let varying: Vec<usize> = (0..n).filter(|&k| sigma[k] > 0.0).collect();
    let dynamics = ErrorDynamics { gravity: place.gravity, vertical: place.vertical };
    let mut accumulator = Accumulator::new(model, dynamics, &scene.pva(0));
    let mut phi = SMatrix::<f64, ROOM, ROOM>::identity();
    let mut information = DMatrix::<f64>::zeros(varying.len(), varying.len());
    for k in 0..scene.samples {
        let input = scene.input(k);
        let (pva, dt) = (scene.pva(k + 1), scene.dt);
        let mean = |instrument| Input::new(instrument, &input, dt, input.temperature);
        let (omega, f) = (Vec3::claim(mean(Instrument::Gyro).omega), Vec3::claim(mean(Instrument::Accel).f));
        accumulator.step(model, &pva, &Increments { dtheta: omega * dt, dv: f * dt }, dt);
        if !(k + 1).is_multiple_of(every) {
            continue;
        }
        phi = accumulator.close(model).phi() * phi;
        accumulator.begin(model, &pva);
        let now = Now::new(&pva, omega, f);
        let observation = fine.observation(place, [0.0; 2], &now).ok()?;
        for (i, row) in observation.rows(model, &now)[..observation.len].iter().enumerate() {
            let seen: Vec<f64> = varying
                .iter()
                .map(|&j| row.pairs().map(|(s, h)| h * phi[(s, j)]).sum::<f64>() * sigma[j])
                .collect();
            let seen = nalgebra::DVector::from_vec(seen);
            information += &seen * seen.transpose() / observation.r[i][i];
        }
    }
    let eigen = information.symmetric_eigen();
    let left: Vec<f64> = eigen.eigenvalues.iter().map(|g| 1.0 / (1.0 + g.max(0.0))).collect();
    let mut space = SMatrix::<f64, ROOM, ROOM>::zeros();
    let mut count = 0;
    for column in (0..varying.len()).filter(|&c| left[c] > HALF) {
        for (row, &state) in varying.iter().enumerate() {
            space[(state, count)] = eigen.eigenvectors[(row, column)] * sigma[state];
        }
        count += 1;
    }
    let names: Vec<String> = (0..n).map(|k| model.name(k).to_string()).collect();
    let limit = |state: usize| {
        let Some(row) = varying.iter().position(|&v| v == state) else { return 0.0 };
        let share: f64 =
            left.iter().enumerate().map(|(c, left)| left * eigen.eigenvectors[(row, c)].powi(2)).sum();
        share.sqrt() * sigma[state]
    };
    let states = (0..n).map(|k| State { name: names[k].clone(), start: sigma[k], limit: limit(k) }).collect();
    // In units of what is left: a coarse attitude is known so little before that its part would be lost beside the biases.
    let scale: [f64; ROOM] = std::array::from_fn(|k| if k < n { limit(k) } else { 0.0 });
    let unseen = all_words(&space, count, &scale, &names, INEXACT);
    Some(Observed { rank: varying.len() - count, of: varying.len(), states, unseen, rocks: true })
}

/// The space of the first columns in words, one combination after the other.
fn all_words(
    space: &SMatrix<f64, ROOM, ROOM>,
    count: usize,
    sigma: &[f64; ROOM],
    names: &[String],
    part: f64,
) -> Vec<String> {
    // Attitude first: combinations are read as what goes with a tilt or a heading.
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by_key(|&k| !names[k].starts_with("phi") && !names[k].starts_with("psi"));
    combinations(space, count, sigma, &order).iter().map(|v| words(v, names, sigma, part)).collect()
}

/// The columns of `null` in reduced echelon form: each with a state of its own that the others leave at zero.
fn combinations(
    null: &SMatrix<f64, ROOM, ROOM>,
    nullity: usize,
    sigma: &[f64; ROOM],
    order: &[usize],
) -> Vec<Vec<f64>> {
    let n = order.len();
    let mut rows: Vec<Vec<f64>> = (0..nullity).map(|j| (0..n).map(|k| null[(k, j)]).collect()).collect();
    let mut done = 0;
    for &k in order {
        let size = |row: &Vec<f64>| if sigma[k] > 0.0 { (row[k] / sigma[k]).abs() } else { 0.0 };
        let Some(best) = (done..rows.len()).max_by(|&a, &b| size(&rows[a]).total_cmp(&size(&rows[b]))) else {
            break;
        };
        if size(&rows[best]) < PART {
            continue;
        }
        rows.swap(done, best);
        let pivot = rows[done][k];
        rows[done].iter_mut().for_each(|x| *x /= pivot);
        let lead = rows[done].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != done) {
            let factor = row[k];
            row.iter_mut().zip(&lead).for_each(|(x, l)| *x -= factor * l);
        }
        done += 1;
    }
    rows
}

/// `phi_n 1, phi_d -1, accel.bias.constant.y 9.806`: rad, m/s, rad/s, m/s² and so on.
fn words(v: &[f64], names: &[String], sigma: &[f64; ROOM], part: f64) -> String {
    let in_sigmas = |k: usize| if sigma[k] > 0.0 { (v[k] / sigma[k]).abs() } else { 0.0 };
    let largest = (0..v.len()).map(in_sigmas).fold(0.0, f64::max);
    let parts = (0..v.len()).filter(|&k| in_sigmas(k) > part * largest);
    parts.map(|k| format!("{} {}", names[k], significant(v[k]))).collect::<Vec<_>>().join(", ")
}

/// Five digits.
pub fn significant(x: f64) -> String {
    let text = if (1e-3..1e5).contains(&x.abs()) {
        let places = (4 - x.abs().log10().floor() as i32).max(0) as usize;
        format!("{x:.places$}")
    } else {
        return format!("{x:.4e}");
    };
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}
