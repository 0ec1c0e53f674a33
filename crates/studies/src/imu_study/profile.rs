//! The true motion of a measurement study, as means over the sample intervals.

use schuler_frames::{B, Gravity, Rot, T, Vec3, earth::omega_ie_t};
use schuler_imu::Truth;

use crate::scenario::{ImuStudy, Motion, Start};

/// Segments of the rate table: about x, y, z, each forward and back.
const SEGMENTS: u64 = 6;

/// What the instrument goes through, sample by sample.
pub enum Profile {
    /// The same in each sample.
    Constant(Truth),
    /// A rate table.
    Table(Table),
}

/// A table that turns one body axis after the other about its own axis, which leans from the vertical.
pub struct Table {
    samples: u64,
    dt: f64,
    rate: f64,
    /// Earth rate and specific force in axes of the table at rest, z along the table's axis.
    omega_ie: [f64; 3],
    f: [f64; 3],
}

impl Profile {
    /// The profile of a valid study.
    pub fn new(study: &ImuStudy) -> Self {
        let zero = Truth::rates([0.0; 3], [0.0; 3]);
        let Some(start) = &study.start else { return Profile::Constant(zero) };
        let (omega_ie, f) = at_rest(start);
        match study.motion {
            Motion::ZeroTruth => Profile::Constant(zero),
            Motion::Static => {
                let c_bt = Rot::<T, B>::from_euler(start.attitude).inverse();
                Profile::Constant(Truth::rates((c_bt * omega_ie).as_array(), (c_bt * f).as_array()))
            }
            Motion::RateTable(table) => {
                // z down the table's axis: the vertical, turned about east so that its lower end goes south.
                let (s, c) = table.tilt.sin_cos();
                let lean = |v: Vec3<T>| {
                    let [n, e, d] = v.as_array();
                    [c * n + s * d, e, c * d - s * n]
                };
                Profile::Table(Table {
                    samples: study.samples,
                    dt: 1.0 / study.imu.rate,
                    rate: table.rate,
                    omega_ie: lean(omega_ie),
                    f: lean(f),
                })
            }
        }
    }

    /// Truth over sample `k`, from 0.
    pub fn truth(&self, k: u64) -> Truth {
        match self {
            Profile::Constant(truth) => *truth,
            Profile::Table(table) => table.truth(k),
        }
    }
}

/// Earth rate and specific force at rest (Somigliana's gravity), local level.
fn at_rest(start: &Start) -> (Vec3<T>, Vec3<T>) {
    let (s, c) = start.position.lat.sin_cos();
    let g_t = Gravity::Somigliana.gravity_t(start.position);
    (omega_ie_t(s, c).as_vec3(), g_t.scaled(-1.0))
}

impl Table {
    fn truth(&self, k: u64) -> Truth {
        let begin = |segment: u64| segment * self.samples / SEGMENTS;
        let segment = (0..SEGMENTS).rfind(|&s| begin(s) <= k).unwrap_or(0);
        let turn = self.rate * self.dt;
        // Turned angle in the middle of the interval; the way back begins where the way there ended.
        let done = (k - begin(segment)) as f64 + 0.5;
        let (rate, angle) = if segment.is_multiple_of(2) {
            (self.rate, turn * done)
        } else {
            (-self.rate, turn * ((begin(segment) - begin(segment - 1)) as f64 - done))
        };
        // The mean of a vector that turns by ±turn/2 about its middle direction.
        let shrink = (0.5 * turn).sin() / (0.5 * turn);
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
