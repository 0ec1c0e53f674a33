//! What the measurements of an alignment can tell of each state of a filter, and what they never will.

use nalgebra::SMatrix;
use schuler_frames::{B, Rot, T, Vec3, earth};
use schuler_imu::Truth;
use schuler_strapdown::filter::{Now, Observability, limit_covariance};
use schuler_strapdown::{ErrorDynamics, Pva};

use super::fine::{Fine, ROOM};
use super::place::Place;
use crate::scenario::FilterSettings;

/// States of a filter under endless noise-free measurement.
pub struct Observed {
    /// Independent combinations that are observed, of how many that vary.
    pub rank: usize,
    pub of: usize,
    pub states: Vec<State>,
    /// The combinations that are never observed, in words.
    pub never: Vec<String>,
}

/// One state.
pub struct State {
    pub name: String,
    /// Standard deviation at the start, and what is left of it for ever.
    pub start: f64,
    pub limit: f64,
}

/// A part of a combination that is smaller than this in standard deviations is rounding.
const PART: f64 = 1e-6;

/// What a filter with `settings` observes at rest in each of the `attitudes` after the other.
pub fn observed(settings: &FilterSettings, place: &Place, attitudes: &[Rot<T, B>]) -> Option<Observed> {
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
    // Attitude first: combinations are read as what goes with a tilt or a heading.
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_key(|&k| !names[k].starts_with("phi") && !names[k].starts_with("psi"));
    let never =
        combinations(&null, nullity, &sigma, &order).iter().map(|v| words(v, &names, &sigma)).collect();
    Some(Observed { rank: observability.rank(), of: observability.states(), states, never })
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
fn words(v: &[f64], names: &[String], sigma: &[f64; ROOM]) -> String {
    let in_sigmas = |k: usize| if sigma[k] > 0.0 { (v[k] / sigma[k]).abs() } else { 0.0 };
    let largest = (0..v.len()).map(in_sigmas).fold(0.0, f64::max);
    let parts = (0..v.len()).filter(|&k| in_sigmas(k) > PART * largest);
    parts.map(|k| format!("{} {}", names[k], significant(v[k]))).collect::<Vec<_>>().join(", ")
}

/// Five digits.
fn significant(x: f64) -> String {
    let text = if (1e-3..1e5).contains(&x.abs()) {
        let places = (4 - x.abs().log10().floor() as i32).max(0) as usize;
        format!("{x:.places$}")
    } else {
        return format!("{x:.4e}");
    };
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}
