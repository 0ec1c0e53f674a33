//! Sensitivity columns: what one standard deviation of a constant does, one transition for all of them.

use nalgebra::{Const, DMatrix, Dyn, OMatrix, SMatrix};
use schuler_imu::{Input, Instrument};
use schuler_strapdown::{ErrorDynamics, Transition};

use super::scene::Scene;
use super::source::{Kind, Nine, Source};

/// Longest step along a motion, s; at rest a step is as long as the distance of rows.
const STEP: f64 = 0.1;

/// Errors of one standard deviation of each source at each row, `result[source][row]`; empty for sources that are not
/// constant. With sign: the source is positive.
pub fn responses(scene: &Scene, sources: &[Source]) -> Vec<Vec<[f64; 9]>> {
    let constant = |s: &&Source| match s.kind {
        Kind::Initial(_) => true,
        Kind::Sensor(_) => s.size().is_some_and(|size| size.rate == 0.0),
    };
    let columns: Vec<&Source> = sources.iter().filter(constant).collect();
    let mut x = OMatrix::<f64, Const<10>, Dyn>::zeros(columns.len());
    for (k, source) in columns.iter().enumerate() {
        for (row, value) in source.initial().into_iter().enumerate() {
            x[(row, k)] = value;
        }
    }
    let mut u = DMatrix::<f64>::zeros(6, columns.len());
    let longest = if scene.steady { u64::MAX } else { ((STEP / scene.dt + 1e-9) as u64).max(1) };
    let mut rows = vec![x.clone()];
    let mut last: Option<(u64, Transition)> = None;
    for pair in scene.rows.windows(2) {
        let mut sample = pair[0];
        while sample < pair[1] {
            let count = longest.min(pair[1] - sample);
            let known = last.filter(|(c, _)| scene.steady && *c == count);
            if known.is_none() {
                inputs(scene, &columns, sample, count, &mut u);
            }
            let step = known.map_or_else(|| transition(scene, sample, count), |(_, step)| step);
            x = step.phi * &x + step.gamma * &u;
            last = Some((count, step));
            sample += count;
        }
        rows.push(x.clone());
    }
    let mut next = 0;
    sources
        .iter()
        .map(|source| {
            if !constant(&source) {
                return Vec::new();
            }
            next += 1;
            rows.iter().map(|x| std::array::from_fn(|k| x[(k, next - 1)])).collect()
        })
        .collect()
}

/// The covariance of a response of one standard deviation.
pub fn covariance(x: &[f64; 9]) -> Nine {
    let x = SMatrix::<f64, 9, 1>::from(*x);
    x * x.transpose()
}

/// Sensor errors along body axes that one standard deviation of each column makes during an interval.
fn inputs(scene: &Scene, columns: &[&Source], sample: u64, count: u64, u: &mut DMatrix<f64>) {
    let seen = scene.seen(sample, count);
    let dt = scene.time(count);
    let calibration = scene.study.imu.spec.calibration_temperature;
    let [gyro, accel] = Instrument::ALL.map(|i| Input::new(i, &seen, dt, calibration));
    for (k, source) in columns.iter().enumerate() {
        let (Kind::Sensor(component), Some(size)) = (&source.kind, source.size()) else { continue };
        let (input, first) = match component.instrument() {
            Instrument::Gyro => (&gyro, 0),
            Instrument::Accel => (&accel, 3),
        };
        let column = component.term().regressor(input).columns()[component.coefficient()];
        for axis in 0..3 {
            u[(first + axis, k)] = column[axis] * size.value;
        }
    }
}

fn transition(scene: &Scene, sample: u64, count: u64) -> Transition {
    let (t, dt) = (scene.time(sample), scene.time(count));
    let [a, b] = ErrorDynamics::NODES.map(|node| scene.moment(t + node * dt));
    scene.dynamics().transition([(&a.0, a.1), (&b.0, b.1)], dt)
}
