//! The analytic limit of a scenario: what constant errors leave and what noise allows.

use nalgebra::Matrix3;
use schuler_frames::{B, Rot, T, Vec3};
use schuler_imu::{Input, Instrument, Spec, Truth};
use schuler_strapdown::align::Limits;

/// Heading error beyond which the laws for small angles, and heading itself, mean nothing, rad (30 deg).
const LARGE: f64 = 0.5;

/// True errors of the sensors as the laws of alignment take them, resolved in t at the attitude of the start.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    laws: Limits,
    /// Mean and covariance of the errors that stay, gyro (rad/s) and accelerometer (m/s²).
    mean: [Vec3<T>; 2],
    spread: [Matrix3<f64>; 2],
    /// Densities of white noise: (rad/s)² s and (m/s²)² s.
    white: [Matrix3<f64>; 2],
    /// Density of the noise of the measured velocity, m²/s.
    velocity: f64,
    /// Whether the base keeps its attitude: turned, its biases are told apart from it.
    one_position: bool,
}

impl Limit {
    /// The limit for sensors with the errors `spec` that see `truth` over `dt` (s) in the attitude `c_tb`.
    pub fn new(
        laws: Limits,
        spec: &Spec,
        truth: &Truth,
        dt: f64,
        c_tb: Rot<T, B>,
        velocity: f64,
        one_position: bool,
    ) -> Limit {
        let mut mean = [Vec3::<B>::ZERO; 2];
        let mut spread = [Matrix3::zeros(); 2];
        let mut white = [Matrix3::zeros(); 2];
        for component in spec.components() {
            let instrument = component.instrument();
            let input = Input::new(instrument, truth, dt, spec.calibration_temperature);
            let column = component.term().regressor(&input).columns()[component.coefficient()];
            let column = Vec3::<B>::claim(column);
            let model = component.evolution().linear_model();
            let i = instrument as usize;
            let (mut value, mut variance) = (0.0, 0.0);
            for a in 0..model.n {
                value += model.c[a] * model.x0[a];
                for b in 0..model.n {
                    variance += model.c[a] * model.p0[a][b] * model.c[b];
                }
            }
            let square = column.as_nalgebra() * column.as_nalgebra().transpose();
            mean[i] += column * value;
            spread[i] += square * variance;
            white[i] += square * model.white;
        }
        let c = c_tb.as_dcm().as_nalgebra();
        Limit {
            laws,
            mean: mean.map(|m| c_tb * m),
            spread: spread.map(|m| c * m * c.transpose()),
            white: white.map(|m| c * m * c.transpose()),
            velocity,
            one_position,
        }
    }

    /// Root mean square of the bias limit, rad: what no alignment in one position gets rid of.
    pub fn bias(&self) -> [f64; 3] {
        let [gyro, accel] = [Instrument::Gyro as usize, Instrument::Accel as usize];
        let mean = self.laws.bias(self.mean[gyro], self.mean[accel]).as_array();
        // The bias limit is linear in the six errors: its columns, one error at a time.
        let unit = |k: usize| Vec3::<T>::claim(std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 }));
        let columns: [Vec3<T>; 6] = std::array::from_fn(|k| match k {
            0..3 => self.laws.bias(unit(k), Vec3::ZERO),
            _ => self.laws.bias(Vec3::ZERO, unit(k - 3)),
        });
        std::array::from_fn(|axis| {
            let mut variance = mean[axis] * mean[axis];
            for (part, spread) in [(0, &self.spread[gyro]), (3, &self.spread[accel])] {
                for i in 0..3 {
                    for j in 0..3 {
                        variance += columns[part + i][axis] * spread[(i, j)] * columns[part + j][axis];
                    }
                }
            }
            variance.sqrt()
        })
    }

    /// Standard deviations of phi (rad) after `t` (s) by the laws of noise.
    pub fn noise(&self, t: f64) -> [f64; 3] {
        let laws = &self.laws;
        let density = |i: Instrument, axis: usize| self.white[i as usize][(axis, axis)].sqrt();
        let [north, _] = laws.tilt_velocity_walk(density(Instrument::Accel, 1), t);
        let [_, east] = laws.tilt_velocity_walk(density(Instrument::Accel, 0), t);
        let [north_v, east_v] = laws.tilt_velocity_noise(self.velocity, t);
        let heading = laws
            .heading_angle_walk(density(Instrument::Gyro, 1), t)
            .hypot(laws.heading_velocity_walk(density(Instrument::Accel, 0), t))
            .hypot(laws.heading_velocity_noise(self.velocity, t));
        [north.hypot(north_v), east.hypot(east_v), heading]
    }

    /// Both together, rad; of a base that is turned the noise alone.
    pub fn total(&self, t: f64) -> [f64; 3] {
        let (bias, noise) = (self.bias(), self.noise(t));
        if self.one_position { std::array::from_fn(|k| bias[k].hypot(noise[k])) } else { noise }
    }

    /// Why heading cannot be had after `t` (s), if it cannot.
    pub fn no_heading(&self, t: f64) -> Option<String> {
        let omega = self.laws.omega_north().abs();
        let per_hour = |x: f64| x.to_degrees() * 3600.0;
        if omega < 1e-6 * self.laws.site.omega_ie {
            return Some("Heading cannot be had: at a pole the Earth rate has no horizontal part".into());
        }
        let (bias, noise) = (self.bias()[2], self.noise(t)[2]);
        let whole = if self.one_position { bias.hypot(noise) } else { noise };
        (whole > LARGE).then(|| {
            format!(
                "Heading cannot be had: the gyro and accelerometer errors are worth {:.3} deg/h of the horizontal Earth rate of {:.3} deg/h ({:.3} deg/h by what stays, {:.3} deg/h by noise over {t} s)",
                per_hour(whole * omega),
                per_hour(omega),
                per_hour(bias * omega),
                per_hour(noise * omega)
            )
        })
    }
}
