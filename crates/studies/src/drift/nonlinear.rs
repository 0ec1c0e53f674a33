//! The full non-linear run: injector, mechanization, true minus computed.

use schuler_frames::{Vec3, with_phi, with_position_error};
use schuler_imu::{Imu, Sample, Stream};
use schuler_strapdown::{Increments, NavError, Pva};

use super::case::Case;
use super::scene::Scene;
use crate::{Error, navigator::Navigator};

/// Navigation errors of `case` times `sign`, one for each row of the scene. `each` is handed the mean sensor
/// errors of every sample (gyro, rad/s; accelerometer, m/s²).
pub fn run(
    scene: &Scene,
    case: &Case,
    sign: f64,
    seed: u64,
    mut each: impl FnMut(u64, &Sample),
) -> Result<Vec<NavError>, Error> {
    let mut nav = Navigator::new(&start(scene, case, sign), &scene.mechanization, scene.vertical, scene.dt);
    let mut imu = Imu::new(&case.spec.scaled(sign), Stream { seed, run: 0 })?;
    let motion = scene.motion();
    let steady = case.is_steady();
    // Errors that do not change at rest give the same sample every time: it need not be made again.
    let mut sample = imu.step(scene.dt, &motion);
    let mut increments = increments(&sample);
    let mut rows = Vec::with_capacity(scene.rows.len());
    let mut step = 0;
    for &row in &scene.rows {
        while step < row {
            if !steady && step > 0 {
                sample = imu.step(scene.dt, &motion);
                increments = self::increments(&sample);
            }
            each(step, &sample);
            nav.step(&increments);
            step += 1;
        }
        rows.push(NavError::between(&nav.pva(), &scene.truth));
    }
    Ok(rows)
}

fn increments(sample: &Sample) -> Increments {
    Increments { dtheta: Vec3::claim(sample.dtheta), dv: Vec3::claim(sample.dv) }
}

/// The computed state at the start: truth plus the initial errors times `sign`.
fn start(scene: &Scene, case: &Case, sign: f64) -> Pva {
    let [r, v, phi] = case.initial_errors().map(|part| Vec3::claim(part.map(|x| sign * x)));
    let Pva { position, v_t, c_tb } = scene.truth;
    Pva { position: with_position_error(position, r), v_t: v_t + v, c_tb: with_phi(c_tb, phi) }
}

/// Half the difference of the +e and -e runs: the part of odd order in the error.
pub fn half_difference(plus: &[NavError], minus: &[NavError]) -> Vec<NavError> {
    let half = |a: &NavError, b: &NavError| NavError {
        dr: (a.dr - b.dr).scaled(0.5),
        dv: (a.dv - b.dv).scaled(0.5),
        phi: (a.phi - b.phi).scaled(0.5),
    };
    plus.iter().zip(minus).map(|(a, b)| half(a, b)).collect()
}
