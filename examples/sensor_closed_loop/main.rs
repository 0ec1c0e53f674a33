//! How well does a small satellite point that knows its attitude from its gyroscopes alone?

use std::error::Error;

use schuler_imu::preset::{GRADES, Preset};
use schuler_imu::{Imu, Sample, State, Stream, Truth};
use schuler_studies::figure::{Axis, Figure, Panel, Series};

/// Moments of inertia, kg m²: a satellite of twelve units.
const INERTIA: [f64; 3] = [0.20, 0.25, 0.12];
/// Disturbance torque, N m.
const DISTURBANCE: [f64; 3] = [2e-8, -1e-8, 1.5e-8];
/// Bandwidth of the controller, rad/s, and its damping.
const BANDWIDTH: f64 = 0.3;
const DAMPING: f64 = 0.8;
/// Duration, s.
const DURATION: f64 = 1200.0;

/// The satellite (small angles from the wanted attitude) and what its computer believes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Satellite {
    t: f64,
    angle: [f64; 3],
    rate: [f64; 3],
    believed: [f64; 3],
    measured: [f64; 3],
}

impl Satellite {
    const START: Satellite =
        Satellite { t: 0.0, angle: [0.0; 3], rate: [0.0; 3], believed: [0.0; 3], measured: [0.0; 3] };

    /// One control period: torque from what is believed, motion, measurement.
    fn step(&mut self, imu: &mut Imu, dt: f64) -> Sample {
        let mut dtheta = [0.0; 3];
        for i in 0..3 {
            let wanted =
                -BANDWIDTH * BANDWIDTH * self.believed[i] - 2.0 * DAMPING * BANDWIDTH * self.measured[i];
            let acceleration = wanted + DISTURBANCE[i] / INERTIA[i];
            dtheta[i] = (self.rate[i] + 0.5 * acceleration * dt) * dt;
            self.angle[i] += dtheta[i];
            self.rate[i] += acceleration * dt;
        }
        // Free fall: no specific force.
        let sample = imu.step(dt, &Truth::increments(dtheta, [0.0; 3]));
        for i in 0..3 {
            self.believed[i] += sample.dtheta[i];
            self.measured[i] = sample.dtheta[i] / dt;
        }
        self.t += dt;
        sample
    }

    /// Pointing error, deg.
    fn error(&self) -> f64 {
        self.angle.iter().map(|a| a * a).sum::<f64>().sqrt().to_degrees()
    }
}

/// A saved simulation: the plant and its sensor.
struct Saved(Satellite, State);

/// Flies one grade; the step is fixed or varies between 5 and 35 ms.
fn fly(grade: &Preset, fixed: bool) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let mut imu = Imu::new(&grade.spec()?, Stream { seed: 7, run: 0 })?;
    let mut satellite = Satellite::START;
    let step = |k: u32| if fixed { 0.02 } else { 0.005 * f64::from(1 + (k * k) % 7) };
    let mut curve = vec![[0.0, 0.0]];
    let mut k = 0;
    while satellite.t < DURATION {
        if k == 5000 {
            // Rollback, as a predictor or a solver that rejects a step needs it.
            let saved = Saved(satellite, imu.save());
            let ahead: Vec<Sample> = (k..k + 200).map(|k| satellite.step(&mut imu, step(k))).collect();
            (satellite, _) = (saved.0, imu.restore(&saved.1)?);
            let again: Vec<Sample> = (k..k + 200).map(|k| satellite.step(&mut imu, step(k))).collect();
            assert_eq!(ahead, again, "rollback must repeat every bit");
            k += 200;
        }
        satellite.step(&mut imu, step(k));
        k += 1;
        if k % 100 == 0 {
            curve.push([satellite.t, satellite.error()]);
        }
    }
    curve.push([satellite.t, satellite.error()]);
    Ok(curve)
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:14}{:>22}{:>22}", "grade", "fixed step (deg)", "varying step (deg)");
    let mut panel = Panel::new(Axis::log("pointing error (deg)"));
    for grade in GRADES {
        let (fixed, varying) = (fly(grade, true)?, fly(grade, false)?);
        let last = |curve: &[[f64; 2]]| curve.last().map_or(0.0, |p| p[1]);
        println!("{:14}{:22.6}{:22.6}", grade.name, last(&fixed), last(&varying));
        panel = panel.with(Series::line(grade.name, fixed));
    }
    Figure::new("Pointing by gyroscopes alone", Axis::time("time"))
        .subtitle("small satellite, five grades of sensor, fixed step of 20 ms")
        .panel(panel)
        .write_svg("examples/sensor_closed_loop/figure.svg".as_ref())?;
    Ok(())
}
