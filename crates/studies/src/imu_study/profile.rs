//! The true motion of a measurement study, as means over the sample intervals.

use schuler_frames::{B, Gravity, Rot, T, Vec3, earth::omega_ie_t};
use schuler_imu::Truth;

use crate::scenario::{ImuStudy, Motion, Start, Temperature};

/// Segments of the rate table: about x, y, z, each forward and back.
const SEGMENTS: u64 = 6;

/// What the instrument goes through, sample by sample.
pub struct Profile {
    course: Course,
    temperature: Option<Temperature>,
    dt: f64,
}

enum Course {
    /// The same in each sample.
    Constant(Truth),
    /// A rate table.
    Table(Table),
}

/// A table that turns one body axis after the other about its own axis, which leans from the vertical.
struct Table {
    samples: u64,
    dt: f64,
    turn: Turn,
    /// Mean square of the vibration, (m/s²)².
    vibration: [f64; 3],
    /// Earth rate and specific force in axes of the table at rest, z along the table's axis.
    omega_ie: [f64; 3],
    f: [f64; 3],
}

/// A turn from rest to rest: speeds up, keeps its rate, slows down.
#[derive(Clone, Copy)]
struct Turn {
    /// rad/s.
    rate: f64,
    /// rad/s², infinite where starts and stops take no time.
    acceleration: f64,
}

impl Profile {
    /// The profile of a valid study.
    pub fn new(study: &ImuStudy) -> Self {
        let dt = 1.0 / study.imu.rate;
        Profile { course: Course::new(study, dt), temperature: study.imu.temperature.clone(), dt }
    }

    /// Truth over sample `k`, from 0.
    pub fn truth(&self, k: u64) -> Truth {
        let truth = match &self.course {
            Course::Constant(truth) => *truth,
            Course::Table(table) => table.truth(k),
        };
        match &self.temperature {
            None => truth,
            Some(temperature) => truth.at_temperature(&temperature.profile(), k as f64 * self.dt, self.dt),
        }
    }
}

impl Course {
    fn new(study: &ImuStudy, dt: f64) -> Self {
        let zero = Truth::rates([0.0; 3], [0.0; 3]);
        let Some(start) = &study.start else { return Course::Constant(zero) };
        let (omega_ie, f) = at_rest(start);
        match study.motion {
            Motion::ZeroTruth => Course::Constant(zero),
            Motion::Static => {
                let c_bt = Rot::<T, B>::from_euler(start.attitude).inverse();
                Course::Constant(Truth::rates((c_bt * omega_ie).as_array(), (c_bt * f).as_array()))
            }
            Motion::RateTable(table) => {
                // z down the table's axis: the vertical, turned about east so that its lower end goes south.
                let (s, c) = table.tilt.sin_cos();
                let lean = |v: Vec3<T>| {
                    let [n, e, d] = v.as_array();
                    [c * n + s * d, e, c * d - s * n]
                };
                Course::Table(Table {
                    samples: study.samples,
                    dt,
                    turn: Turn { rate: table.rate, acceleration: table.acceleration },
                    vibration: table.vibration.map(|rms| rms * rms),
                    omega_ie: lean(omega_ie),
                    f: lean(f),
                })
            }
        }
    }
}

/// Earth rate and specific force at rest (Somigliana's gravity), local level.
fn at_rest(start: &Start) -> (Vec3<T>, Vec3<T>) {
    let (s, c) = start.position.lat.sin_cos();
    let g_t = Gravity::Somigliana.gravity_t(start.position);
    (omega_ie_t(s, c).as_vec3(), g_t.scaled(-1.0))
}

impl Turn {
    /// Rate at time `t` of a turn that takes `whole` seconds.
    fn rate(&self, t: f64, whole: f64) -> f64 {
        if self.acceleration.is_infinite() {
            return self.rate;
        }
        self.rate.min(self.acceleration * t.min(whole - t)).max(0.0)
    }

    /// Angle turned until time `t`.
    fn angle(&self, t: f64, whole: f64) -> f64 {
        let ramp = self.rate / self.acceleration;
        let up =
            |t: f64| if t < ramp { 0.5 * self.acceleration * t * t } else { self.rate * (t - 0.5 * ramp) };
        let whole_angle = self.rate * (whole - ramp);
        if t < 0.5 * whole { up(t) } else { whole_angle - up(whole - t) }
    }
}

impl Table {
    fn truth(&self, k: u64) -> Truth {
        let begin = |segment: u64| segment * self.samples / SEGMENTS;
        let segment = (0..SEGMENTS).rfind(|&s| begin(s) <= k).unwrap_or(0);
        let whole = (begin(segment + 1) - begin(segment)) as f64 * self.dt;
        let at = |part: f64| ((k - begin(segment)) as f64 + part) * self.dt;
        let [before, middle, after] = [0.0, 0.5, 1.0].map(|part| self.turn.angle(at(part), whole));
        let rates = [0.0, 1.0].map(|part| self.turn.rate(at(part), whole));
        // Digits are lost in a difference of angles; a rate that stays needs none.
        let rate = if rates[0] == rates[1] { rates[0] } else { (after - before) / self.dt };
        let acceleration = (rates[1] - rates[0]) / self.dt;
        // Mean angle over the interval by Simpson's rule.
        let mean_angle = (before + 4.0 * middle + after) / 6.0;
        // The way back begins where the way there ended.
        let (rate, acceleration, angle) = if segment.is_multiple_of(2) {
            (rate, acceleration, mean_angle)
        } else {
            let there = (begin(segment) - begin(segment - 1)) as f64 * self.dt;
            (-rate, -acceleration, self.turn.angle(there, there) - mean_angle)
        };
        // The mean of a vector that turns by ±turn/2 about its middle direction; the rest of the acceleration within
        // one interval is of third order in it.
        let half = 0.5 * (after - before);
        let shrink = if half == 0.0 { 1.0 } else { half.sin() / half };
        let (s, c) = angle.sin_cos();
        let mean = |[x, y, z]: [f64; 3]| [shrink * (c * x + s * y), shrink * (c * y - s * x), z];
        let [omega_x, omega_y, omega_z] = mean(self.omega_ie);
        // The body axis of the segment points along z of the table, the others follow in cyclic order.
        let mount = |[x, y, z]: [f64; 3]| match segment / 2 {
            0 => [z, x, y],
            1 => [y, z, x],
            _ => [x, y, z],
        };
        Truth::rates(mount([omega_x, omega_y, omega_z + rate]), mount(mean(self.f)))
            .with_omega_dot(mount([0.0, 0.0, acceleration]))
            .with_vibration(self.vibration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Scenario, scenario::Study};

    const SCENARIO: &str = "
schuler: 1
study: imu
title: Rate table
start: { position: { lat: 50 deg, lon: 0 deg, h: 100 m } }
motion: { rate_table: { rate: 10 deg/s, tilt: 30 deg } }
duration: 60 s
imu: { rate: 20 Hz }
";

    /// Laws of any table: along its axis a gyro sees table and Earth rate and an accelerometer a constant part
    /// of gravity; the size of the specific force is gravity's, but for the mean over a turning interval.
    #[test]
    fn a_table_turns_each_axis_both_ways() {
        let scenario = Scenario::load("a.yaml", SCENARIO, &[]).expect("valid");
        let Study::Imu(study) = &scenario.study else { panic!("an IMU study") };
        let profile = Profile::new(study);
        let rate = 10f64.to_radians();
        let g = Gravity::Somigliana.gravity_t(study.start.as_ref().expect("a start").position).norm();
        // The upper end of the axis leans by 30 deg to north, so it makes 40 + 30 deg with the pole's
        // direction (latitude 50 deg: the vertical makes 40 deg with it) less twice the lean: 10 deg.
        let along = -7.292115e-5 * 10f64.to_radians().cos();
        for axis in 0..3 {
            let mut sum = 0.0;
            for k in 400 * axis..400 * (axis + 1) {
                let schuler_imu::Motion::Rates { omega, f } = profile.truth(k as u64).motion else {
                    panic!("rates")
                };
                let turn = if k % 400 < 200 { rate } else { -rate };
                assert!((omega[axis] - turn - along).abs() < 1e-15);
                assert!((f[axis] + 0.75f64.sqrt() * g).abs() < 1e-12);
                let size = f.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!((size / g - 1.0).abs() < (0.5 * rate / 20.0).powi(2) / 6.0);
                sum += omega[axis];
            }
            assert!((sum / 400.0 - along).abs() < 1e-15);
        }
    }
}
