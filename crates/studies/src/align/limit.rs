//! The analytic limit of each method: what the sensors' errors leave and what noise allows.

use nalgebra::Matrix3;
use schuler_frames::{B, Geodetic, Gravity, Rot, T, Vec3};
use schuler_imu::process::LinearModel;
use schuler_imu::{Input, Instrument, Spec, Truth};
use schuler_strapdown::align::{Gyrocompass, Limits, Vectors};
use schuler_strapdown::static_base::Site;

use super::mean;
use crate::scenario::{AlignStudy, MethodKind};

/// Time constants after which the gyrocompass has come to rest: e^-10 (1 + 10 + 50) is 0.3 % of the start.
const SETTLED: f64 = 10.0;

/// True errors of the sensors as the laws of alignment take them, resolved in t at the attitude of the start, and what the base
/// does.
pub struct Limit {
    pub laws: Limits,
    position: Geodetic,
    gravity: Gravity,
    parts: Vec<Part>,
    /// Density of the noise of the measured velocity, m²/s.
    pub velocity: f64,
    /// Whether it rocks.
    pub rocks: bool,
    /// When the base is first turned from one position to another, s.
    pub turn: Option<f64>,
}

/// One coefficient of an error source.
pub struct Part {
    pub source: String,
    instrument: Instrument,
    column: Vec3<T>,
    model: LinearModel,
    /// Keeps its value.
    constant: bool,
}

/// Errors of gyro (rad/s) and accelerometer (m/s²) as means over a time: mean and covariance.
#[derive(Clone, Copy, Debug)]
pub struct Means {
    mean: [Vec3<T>; 2],
    spread: [Matrix3<f64>; 2],
}

impl Means {
    const NONE: Means =
        Means { mean: [Vec3::ZERO; 2], spread: [Matrix3::new(0., 0., 0., 0., 0., 0., 0., 0., 0.); 2] };

    fn add(&mut self, part: &Part, [mean, variance]: [f64; 2]) {
        let (i, column) = (part.instrument as usize, part.column.as_nalgebra());
        self.mean[i] += part.column * mean;
        self.spread[i] += column * column.transpose() * variance;
    }
}

impl Limit {
    /// The limit for sensors with the errors `spec` that see `truth` over `dt` (s) in the attitude `c_tb`, velocity being measured with
    /// the standard deviation `noise` (m/s); whether the base rocks, and when it is turned (s).
    pub fn new(
        study: &AlignStudy,
        (spec, truth, dt): (&Spec, &Truth, f64),
        c_tb: Rot<T, B>,
        noise: f64,
        rocks: bool,
        turn: Option<f64>,
    ) -> Limit {
        let (position, gravity) = (study.start.position, study.mechanization.gravity);
        let parts = spec.components().map(|component| {
            let instrument = component.instrument();
            let input = Input::new(instrument, truth, dt, spec.calibration_temperature);
            let column = component.term().regressor(&input).columns()[component.coefficient()];
            Part {
                source: component.source().name().to_string(),
                instrument,
                column: c_tb * Vec3::<B>::claim(column),
                model: component.evolution().linear_model(),
                constant: component.evolution().is_constant(),
            }
        });
        Limit {
            laws: Limits::new(Site::new(position, gravity)),
            position,
            gravity,
            parts: parts.collect(),
            velocity: noise * noise * study.velocity.every as f64 * dt,
            rocks,
            turn,
        }
    }

    /// The coefficients of the sources.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Whether the base is turned before `t` (s).
    pub fn turned(&self, t: f64) -> bool {
        self.turn.is_some_and(|turn| t > turn)
    }

    /// Errors as means over `t` (s), all but white noise; once the base is turned also without what keeps its value.
    pub fn means(&self, t: f64, wanted: impl Fn(&Part) -> bool) -> Means {
        let turned = self.turned(t);
        let mut means = Means::NONE;
        for part in self.parts.iter().filter(|part| wanted(part) && !(turned && part.constant)) {
            means.add(part, mean::of_process(&part.model, t));
        }
        means
    }

    /// White noise as means over `t` (s).
    pub fn white_means(&self, t: f64, wanted: impl Fn(&Part) -> bool) -> Means {
        let mut means = Means::NONE;
        for part in self.parts.iter().filter(|part| wanted(part)) {
            means.add(part, [0.0, part.model.white / t]);
        }
        means
    }

    /// Root mean square of phi (rad) that `means` leave in a method of this kind.
    pub fn left(&self, kind: &MethodKind, means: &Means) -> [f64; 3] {
        let square = self.left_squares(kind, means);
        std::array::from_fn(|axis| square[(axis, axis)].sqrt())
    }

    /// Means of the products of the three (rad²).
    fn left_squares(&self, kind: &MethodKind, means: &Means) -> Matrix3<f64> {
        let value = self.linear(kind, means.mean).as_nalgebra();
        // Linear in the six errors: the columns, one error at a time.
        let unit = |k: usize| Vec3::<T>::claim(std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 }));
        let of_gyro = |k: usize| self.linear(kind, [unit(k), Vec3::ZERO]).as_nalgebra();
        let of_accel = |k: usize| self.linear(kind, [Vec3::ZERO, unit(k)]).as_nalgebra();
        let columns = [
            Matrix3::from_columns(&[of_gyro(0), of_gyro(1), of_gyro(2)]),
            Matrix3::from_columns(&[of_accel(0), of_accel(1), of_accel(2)]),
        ];
        let mut squares = value * value.transpose();
        for (columns, spread) in columns.iter().zip(&means.spread) {
            squares += columns * spread * columns.transpose();
        }
        squares
    }

    /// phi (rad) that constant errors leave, to first order.
    fn linear(&self, kind: &MethodKind, [eps, nabla]: [Vec3<T>; 2]) -> Vec3<T> {
        let [n, e, d] = self.laws.bias(eps, nabla).as_array();
        let Site { g, sin_lat: s, cos_lat: c, omega_ie: o, .. } = self.laws.site;
        match kind {
            MethodKind::Triad(Vectors::RateFirst) => Vec3::new(n, -(s * eps[0] + c * eps[2]) / o, d),
            MethodKind::Triad(Vectors::Inverse) => {
                Vec3::new(n, 0.5 * ((nabla[2] * s / c - nabla[0]) / g - eps[2] / (o * c)), d)
            }
            &MethodKind::Gyrocompass(tau) => {
                Gyrocompass::new(Rot::IDENTITY, self.position, self.gravity, tau).settled(eps, nabla)
            }
            _ => Vec3::new(n, e, d),
        }
    }

    /// Standard deviations of phi (rad) after `t` (s) by the method's own law of white noise; NaN where there is none.
    fn noise(&self, kind: &MethodKind, t: f64) -> [f64; 3] {
        let [gyro, accel] = self.white_means(1.0, |_| true).spread;
        let density = |m: &Matrix3<f64>, axis: usize| m[(axis, axis)].sqrt();
        // A tilt about north is seen by the east accelerometer, tilt about east and heading by the north one.
        let of_axes = |angle: &dyn Fn(f64) -> Vec3<T>, velocity: &dyn Fn(f64) -> Vec3<T>| {
            let (of_gyro, of_accel) = ([0, 1, 1], [1, 0, 0]);
            std::array::from_fn(|k| {
                angle(density(&gyro, of_gyro[k]))[k].hypot(velocity(density(&accel, of_accel[k]))[k])
            })
        };
        match kind {
            MethodKind::Triad(_) => self.left(kind, &self.white_means(t, |_| true)),
            &MethodKind::Inertial { solution, latitude_known: true } => {
                of_axes(&|n| self.laws.inertial_angle_walk(solution, n, t), &|q| {
                    self.laws.inertial_velocity_walk(solution, q, t)
                })
            }
            MethodKind::Inertial { latitude_known: false, .. } => [f64::NAN; 3],
            &MethodKind::Gyrocompass(tau) if t >= SETTLED * tau => {
                let settled = Gyrocompass::new(Rot::IDENTITY, self.position, self.gravity, tau);
                of_axes(&|n| settled.angle_walk(n), &|q| settled.velocity_walk(q))
            }
            MethodKind::Gyrocompass(_) => [f64::NAN; 3],
            MethodKind::AnyHeading(_) => self.separate(t, true).map(|law| rss(&law)),
            MethodKind::Filter(settings) => self.separate(t, !settings.position).map(|law| rss(&law)),
        }
    }

    /// The laws of the best estimator one by one, axis by axis (rad): angle random walk, velocity random walk and, where
    /// velocity is `measured`, its white noise.
    pub fn separate(&self, t: f64, measured: bool) -> [[f64; 3]; 3] {
        let [gyro, accel] = self.white_means(1.0, |_| true).spread;
        let [north_q, east_q] = [accel[(0, 0)].sqrt(), accel[(1, 1)].sqrt()];
        let r = if measured { self.velocity } else { 0.0 };
        let [north, _] = self.laws.tilt_velocity_walk(east_q, t);
        let [_, east] = self.laws.tilt_velocity_walk(north_q, t);
        let [north_v, east_v] = self.laws.tilt_velocity_noise(r, t);
        [
            [0.0, north, north_v],
            [0.0, east, east_v],
            [
                self.laws.heading_angle_walk(gyro[(1, 1)].sqrt(), t),
                self.laws.heading_velocity_walk(north_q, t),
                self.laws.heading_velocity_noise(r, t),
            ],
        ]
    }

    /// What stays and noise in variance, rad; NaN where no law is known.
    pub fn total(&self, kind: &MethodKind, means: &Means, t: f64) -> [f64; 3] {
        let at_rest_only = matches!(kind, MethodKind::Triad(_) | MethodKind::Gyrocompass(_));
        if self.turned(t) || (self.rocks && at_rest_only) {
            return [f64::NAN; 3];
        }
        let (stays, noise) = (self.left(kind, means), self.noise(kind, t));
        std::array::from_fn(|k| stays[k].hypot(noise[k]))
    }

    /// Means of the products of phi (rad²): of what stays with the variances of noise on its diagonal.
    pub fn total_squares(&self, kind: &MethodKind, means: &Means, t: f64) -> Matrix3<f64> {
        let mut squares = self.left_squares(kind, means);
        for (axis, total) in self.total(kind, means, t).into_iter().enumerate() {
            squares[(axis, axis)] = total * total;
        }
        squares
    }

    /// What a reader must know of the limits, `t` (s) being the time of the alignment.
    pub fn words(&self, t: f64) -> Vec<String> {
        let mut words = vec![format!(
            "The limit of a method is, to first order, what the sensors' errors leave in one position, phi_N = nabla_E/g, phi_E = -nabla_N/g, phi_D = eps_E/(Ω cos L) - tan L nabla_E/g by their means over the time, and in variance to it the method's own law of white noise after {t} s: that of means (TRIAD), of the vectors laid upon each other (inertial), of the settled loop (gyrocompass, from ten tau on), of the best estimator that knows nothing before (filters); correlated noise and bursts of the velocity, knocks, what is known before and what is left of a coarse start are not in it"
        )];
        if self.rocks {
            words.push("For a base that rocks TRIAD and the gyrocompass have no limit here".into());
        }
        if let Some(turn) = self.turn.filter(|turn| *turn < t) {
            words.push(format!(
                "The limit is that of one position, up to the turn at {turn} s; from there on no closed form holds, and a filter's own standard deviation, with all its noise, stands in its place"
            ));
        }
        words
    }
}

/// Root of the sum of the squares.
fn rss(of: &[f64]) -> f64 {
    of.iter().map(|x| x * x).sum::<f64>().sqrt()
}
