//! Increments of several samples as one step of the filter's transition.

use schuler_frames::{B, Vec3};
use schuler_strapdown::Increments;

/// Length (s) and turn (rad) up to which samples are one step. The transition takes a step's attitude half way; with the turn
/// within the step taken to first order below, what is left out is (turn)²/24 of the force, 1e-4, and less of all else.
const LONGEST: f64 = 0.2;
const TURN: f64 = 0.05;

/// Samples gathered so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gathered {
    theta: Vec3<B>,
    /// Velocity increments along the axes at the begin, to first order in the turn.
    dv: Vec3<B>,
    /// Length so far, s.
    pub t: f64,
}

impl Gathered {
    #[inline]
    pub fn push(&mut self, sample: &Increments, dt: f64) {
        self.dv += sample.dv + (self.theta + sample.dtheta * 0.5).cross(sample.dv);
        self.theta += sample.dtheta;
        self.t += dt;
    }

    /// Whether the next sample, as long as this one of `dt` (s), would be too much.
    #[inline]
    pub fn is_full(&self, dt: f64) -> bool {
        self.t > LONGEST - 0.5 * dt || self.theta.norm_squared() > TURN * TURN
    }

    /// The increments, of velocity along the axes half way, and their length (s). Begins anew.
    pub fn take(&mut self) -> (Increments, f64) {
        let Gathered { theta, dv, t } = std::mem::take(self);
        (Increments { dtheta: theta, dv: dv - theta.cross(dv) * 0.5 }, t)
    }
}

#[cfg(test)]
mod tests {
    use schuler_frames::{Geodetic, Gravity};
    use schuler_imu::{Instrument::*, Source, Spec};
    use schuler_strapdown::filter::{Accumulator, Filter, Form, Model, NavStates};
    use schuler_strapdown::{ErrorDynamics, LocalLevel, Vertical};

    use super::*;
    use crate::trajectory::{Course, Segment, Segments, Shaken, Sharpness, Sine, SwayAxes, Truth, Turn};

    /// Climb, turns and a roll, shaken at 2 Hz by 2 mm (32 mg) and 1 mrad on every axis.
    fn flight() -> Truth {
        let start = Course {
            position: Geodetic::new(0.8, 0.2, 500.0),
            speed: 60.0,
            heading: 0.3,
            climb: 0.0,
            roll: 0.0,
        };
        let turn = Turn { sharpness: Sharpness::Bank(0.6), ramp: 3.0, flat: false };
        let segments = [
            Segment::Climb { height: 200.0, angle: 0.15, ramp: 4.0 },
            Segment::Turn { angle: 2.5, turn },
            Segment::Roll { to: 1.0, duration: 2.0 },
            Segment::Roll { to: 0.0, duration: 2.0 },
            Segment::Accelerate { to: 80.0, duration: 8.0 },
            Segment::Turn { angle: -3.0, turn },
            Segment::Straight { duration: 20.0 },
        ];
        let carrier = Segments::new(start, &segments, Gravity::Normal).expect("a flight");
        let sine = |amplitude: f64| Sine { amplitude, omega: 4.0 * std::f64::consts::PI, phase: 0.4 };
        let (angle, way) = (sine(1e-3), sine(2e-3));
        let axes = SwayAxes {
            roll: vec![angle],
            pitch: vec![angle],
            yaw: vec![angle],
            n: vec![way],
            e: vec![way],
            d: vec![way],
        };
        Truth::new(Shaken::new(Box::new(carrier), axes), Gravity::Normal)
    }

    /// Standard deviations of 21 states after a minute without measurements, sample by sample and gathered.
    #[test]
    fn gathering_changes_no_standard_deviation() {
        let source = |i, term, process, value: f64| {
            let key = if process == "white" { "density" } else { "sigma" };
            Source::named(i, term, process, &[(key, value.into())]).unwrap()
        };
        let spec = Spec::from_sources([
            source(Gyro, "bias", "white", 3e-5),
            source(Gyro, "bias", "constant", 2e-5),
            source(Gyro, "scale_factor", "constant", 3e-4),
            source(Accel, "bias", "white", 1e-3),
            source(Accel, "bias", "constant", 1e-2),
            source(Accel, "scale_factor", "constant", 3e-4),
        ])
        .unwrap();
        let sigma = [1.0, 1.0, 1.0, 0.1, 0.1, 0.1, 2e-3, 2e-3, 1e-2];
        let truth = flight();
        let start = truth.moment(0.0).pva;
        let dynamics = ErrorDynamics { gravity: Gravity::Normal, vertical: Vertical::Free };
        let mut filters: [Filter<24>; 2] = [0, 1]
            .map(|_| Filter::new(Model::new(Form::Phi, NavStates::ALL, &spec).unwrap(), &sigma).unwrap());
        let mut sums = [0, 1].map(|k| Accumulator::new(filters[k].model(), dynamics, &start));
        let mut navigator = LocalLevel::new(&start, Gravity::Normal, Vertical::Free);
        let mut gathered = Gathered::default();
        let (dt, mut steps) = (0.005, 0);
        for k in 1..=12_000u32 {
            let increments = truth.increments(f64::from(k - 1) * dt, dt);
            navigator.step(&increments, dt);
            let pva = navigator.pva();
            sums[0].step(filters[0].model(), &pva, &increments, dt);
            gathered.push(&increments, dt);
            if gathered.is_full(dt) || k % 200 == 0 {
                let (increments, t) = gathered.take();
                sums[1].step(filters[1].model(), &pva, &increments, t);
                steps += 1;
            }
            if k % 200 == 0 {
                for (filter, sum) in filters.iter_mut().zip(&mut sums) {
                    let step = sum.close(filter.model());
                    filter.propagate(&step);
                }
            }
        }
        assert!(steps < 600, "{steps}");
        for state in 0..21 {
            let [each, all] = filters.each_ref().map(|filter| filter.sigma(state));
            assert!((all / each - 1.0).abs() < 1e-4, "state {state}: {each} {all}");
        }
        // Directions too: the largest difference of the covariances, each in its own deviations.
        let mut worst = 0f64;
        for i in 0..21 {
            for j in 0..21 {
                let scale = filters[0].sigma(i) * filters[0].sigma(j);
                worst = worst.max((filters[0].p[(i, j)] - filters[1].p[(i, j)]).abs() / scale);
            }
        }
        assert!(worst < 2e-4, "{worst}");
    }
}
