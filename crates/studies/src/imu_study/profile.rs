//! The true motion of a measurement study, over the sample intervals.

use schuler_frames::Gravity;
use schuler_imu::Truth;

use crate::{
    scenario::{ImuStudy, Motion, Temperature},
    trajectory,
};

/// What the instrument goes through, sample by sample.
pub struct Profile {
    course: Course,
    temperature: Option<Temperature>,
    rate: f64,
}

enum Course {
    /// The same in each sample.
    Constant(Truth),
    /// A motion.
    Moving(trajectory::Truth),
}

impl Profile {
    /// The profile of a valid study, in Somigliana's gravity.
    pub fn new(study: &ImuStudy) -> Self {
        let rate = study.imu.rate;
        Profile { course: Course::new(study), temperature: study.imu.temperature.clone(), rate }
    }

    /// Truth over sample `k`, from 0.
    pub fn truth(&self, k: u64) -> Truth {
        let (t, dt) = (k as f64 / self.rate, 1.0 / self.rate);
        let truth = match &self.course {
            Course::Constant(truth) => *truth,
            Course::Moving(truth) => truth.imu_truth(t, dt),
        };
        match &self.temperature {
            None => truth,
            Some(temperature) => truth.at_temperature(&temperature.profile(), t, dt),
        }
    }
}

impl Course {
    fn new(study: &ImuStudy) -> Self {
        let gravity = Gravity::Somigliana;
        let trajectory = study.start.as_ref().and_then(|start| {
            let trajectory = study.motion.trajectory(start, gravity, study.samples, 1.0 / study.imu.rate);
            trajectory.expect("invariant: the trajectory of a valid scenario is possible")
        });
        let Some(trajectory) = trajectory else {
            return Course::Constant(Truth::rates([0.0; 3], [0.0; 3]));
        };
        let truth = trajectory::Truth::boxed(trajectory, gravity);
        if study.motion != Motion::Static {
            return Course::Moving(truth);
        }
        let now = truth.moment(0.0);
        Course::Constant(Truth::rates(now.omega_ib_b.as_vec3().as_array(), now.f_b.as_array()))
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
                let schuler_imu::Motion::Increments { dtheta, dv } = profile.truth(k as u64).motion else {
                    panic!("increments")
                };
                let [omega, f] = [dtheta, dv].map(|x| x.map(|x| x * 20.0));
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
