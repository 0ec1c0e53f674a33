//! The errors of the sensors that a filter knows, made ready for every sample.

use schuler_imu::{Instrument, Truth};
use schuler_strapdown::filter::Filter;

/// What a unit of something makes: errors of gyro x, y, z and accelerometer x, y, z where nothing moves, and their slopes against
/// angular rate and specific force.
#[derive(Clone, Debug, Default)]
struct Affine {
    constant: [f64; 6],
    slopes: [[f64; 6]; 6],
}

/// The errors of gyros and accelerometers as `e0 + E u`, u being angular rate and specific force: nearly all error sources are of
/// this kind, and then a sample costs a product instead of a walk over the sources.
#[derive(Clone, Debug)]
pub struct SensorErrors {
    now: Affine,
    /// That of a unit of each state of the sources; empty where one is not of this kind.
    states: Vec<Affine>,
    /// Whether any slope is there.
    sloped: bool,
}

/// Input at which nothing is special, rad/s and m/s².
const ELSEWHERE: [f64; 6] = [0.31, -0.17, 0.23, 4.1, -2.3, -9.7];

impl SensorErrors {
    /// What `filter` knows at its start.
    pub fn new<const N: usize>(filter: &Filter<N>) -> Self {
        let model = filter.model();
        let mut states = Vec::new();
        let (mut affine, mut sloped) = (true, false);
        for state in model.nav_len()..model.len() {
            let mut x = nalgebra::SVector::<f64, N>::zeros();
            x[state] = 1.0;
            let at = |u: &[f64; 6]| errors(|i, seen| model.sensor_error(i, &x, seen, 1.0), u);
            let unit = Affine::of(at);
            sloped |= unit.slopes.as_flattened().iter().any(|slope| *slope != 0.0);
            for scale in [1.0, -0.6] {
                let u = ELSEWHERE.map(|u| scale * u);
                let (exact, series) = (at(&u), unit.at(&u));
                let size = exact.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
                affine &= (0..6).all(|k| (exact[k] - series[k]).abs() <= 1e-12 * size);
            }
            states.push(unit);
        }
        if !affine {
            states.clear();
        }
        let mut new = SensorErrors { now: Affine::default(), states, sloped };
        new.refresh(filter);
        new
    }

    /// Takes what `filter` knows now.
    pub fn refresh<const N: usize>(&mut self, filter: &Filter<N>) {
        let first = filter.model().nav_len();
        self.now = Affine::default();
        for (k, unit) in self.states.iter().enumerate() {
            let x = filter.taken_out()[first + k];
            for row in 0..6 {
                self.now.constant[row] += x * unit.constant[row];
                if self.sloped {
                    for (slope, unit) in self.now.slopes[row].iter_mut().zip(unit.slopes[row]) {
                        *slope += x * unit;
                    }
                }
            }
        }
    }

    /// Errors of gyros and accelerometers, integrated over `dt` (s), where these increments are measured.
    #[inline]
    pub fn integrated<const N: usize>(
        &self,
        filter: &Filter<N>,
        dtheta: [f64; 3],
        dv: [f64; 3],
        dt: f64,
    ) -> [[f64; 3]; 2] {
        if self.states.is_empty() {
            let seen = Truth::increments(dtheta, dv);
            return Instrument::ALL.map(|i| filter.sensor_error(i, &seen, dt).map(|e| e * dt));
        }
        let mut sum = self.now.constant.map(|e| e * dt);
        if self.sloped {
            // Slopes are per unit of the input: of increments they give increments.
            let u = [dtheta[0], dtheta[1], dtheta[2], dv[0], dv[1], dv[2]];
            for (sum, slopes) in sum.iter_mut().zip(&self.now.slopes) {
                *sum += product(slopes, &u);
            }
        }
        let [a, b, c, d, e, f] = sum;
        [[a, b, c], [d, e, f]]
    }
}

impl Affine {
    fn of(at: impl Fn(&[f64; 6]) -> [f64; 6]) -> Self {
        let mut new = Affine { constant: at(&[0.0; 6]), slopes: [[0.0; 6]; 6] };
        for input in 0..6 {
            let mut u = [0.0; 6];
            u[input] = 1.0;
            for (k, error) in at(&u).iter().enumerate() {
                new.slopes[k][input] = error - new.constant[k];
            }
        }
        new
    }

    fn at(&self, u: &[f64; 6]) -> [f64; 6] {
        std::array::from_fn(|k| self.constant[k] + product(&self.slopes[k], u))
    }
}

#[inline(always)]
fn product(s: &[f64; 6], u: &[f64; 6]) -> f64 {
    (s[0] * u[0] + s[1] * u[1] + s[2] * u[2]) + (s[3] * u[3] + s[4] * u[4] + s[5] * u[5])
}

/// Errors of both instruments at the rate and force `u`.
fn errors(error: impl Fn(Instrument, &Truth) -> [f64; 3], u: &[f64; 6]) -> [f64; 6] {
    let seen = Truth::rates([u[0], u[1], u[2]], [u[3], u[4], u[5]]);
    let ([a, b, c], [d, e, f]) = (error(Instrument::Gyro, &seen), error(Instrument::Accel, &seen));
    [a, b, c, d, e, f]
}

#[cfg(test)]
mod tests {
    use schuler_imu::{Instrument::*, Source, Spec};
    use schuler_strapdown::filter::{Form, Model, NavStates};

    use super::*;

    fn filter(sources: &[(Instrument, &str)]) -> Filter<40> {
        let spec = Spec::from_sources(
            sources
                .iter()
                .map(|(i, term)| Source::named(*i, term, "constant", &[("sigma", 1e-3.into())]).unwrap()),
        )
        .unwrap();
        let mut filter =
            Filter::new(Model::new(Form::Phi, NavStates::ALL, &spec).unwrap(), &[1.0; 9]).unwrap();
        // Estimates that the feedback takes out.
        let (first, len) = (filter.model().nav_len(), filter.model().len());
        for k in first..len {
            filter.x[k] = 1e-3 * (k as f64 - 11.3);
        }
        let pva = schuler_strapdown::Pva {
            position: schuler_frames::Geodetic::new(0.8, 0.2, 100.0),
            v_t: schuler_frames::Vec3::ZERO,
            c_tb: schuler_frames::Rot::IDENTITY,
        };
        filter.feedback(&pva);
        filter
    }

    /// The table gives what the walk over the sources gives, whatever the sources.
    #[test]
    fn equals_the_walk_over_the_sources() {
        let linear = [
            (Gyro, "bias"),
            (Gyro, "scale_factor"),
            (Gyro, "g_sensitivity"),
            (Accel, "bias"),
            (Accel, "misalignment"),
        ];
        for (sources, fast) in
            [(&linear[..1], true), (&linear[..], true), (&[(Accel, "quadratic"), (Gyro, "bias")][..], false)]
        {
            let filter = filter(sources);
            let errors = SensorErrors::new(&filter);
            assert_eq!(!errors.states.is_empty(), fast);
            let (dtheta, dv, dt) = ([1e-3, -2e-3, 5e-4], [0.02, -0.01, -0.049], 0.005);
            let seen = Truth::increments(dtheta, dv);
            let found = errors.integrated(&filter, dtheta, dv, dt);
            for (instrument, found) in Instrument::ALL.into_iter().zip(found) {
                let exact = filter.sensor_error(instrument, &seen, dt).map(|e| e * dt);
                assert!((0..3).all(|k| (found[k] - exact[k]).abs() < 1e-16), "{found:?} {exact:?}");
            }
        }
    }
}
