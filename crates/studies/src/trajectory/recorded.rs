//! A recorded trajectory, made smooth.

use std::f64::consts::{PI, TAU};

use schuler_frames::{Euler, Geodetic, position_error};

use super::{Impossible, Kinematics, Stance, Trajectory, route::Passing, smooth, spline::Fit};

/// One row of a recorded trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// s.
    pub t: f64,
    /// Where.
    pub position: Geodetic,
    /// How it stands.
    pub attitude: Euler,
}

/// How far rows are from the splines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// Root mean square north, east, down, m.
    pub position_rms: [f64; 3],
    /// Largest distance, m.
    pub position_largest: f64,
    /// Root mean square of roll, pitch, yaw, rad.
    pub attitude_rms: [f64; 3],
    /// Largest difference of an angle, rad.
    pub attitude_largest: f64,
}

/// A recorded trajectory as quintic splines in latitude, longitude, height, roll, pitch and yaw, fitted by least
/// squares: whatever is slower than the distance of their knots stays, what is faster (noise) goes. Time begins with its first row.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    fit: Fit<6>,
    /// Of latitude, longitude and height, from which the splines count.
    origin: Geodetic,
    joints: Vec<f64>,
    residual: Residual,
}

/// Rows of which the splines between two knots must have some.
const ROWS: usize = 2;
/// Largest believed step of an angle from row to row, rad: beyond, which way it turned is not known.
const STEP: f64 = 0.5 * PI;

impl Recorded {
    /// Splines with knots every `knots` (s) through `rows`.
    ///
    /// # Errors
    /// Times that do not increase, gaps, angles that jump, speeds beyond reason; each with its row.
    pub fn new(rows: &[Row], knots: f64) -> Result<Self, Impossible> {
        let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
            return Err(Impossible::new("a trajectory without rows", "at least two rows between two knots"));
        };
        let origin = first.position;
        let mut values: Vec<[f64; 6]> = Vec::with_capacity(rows.len());
        for (k, row) in rows.iter().enumerate() {
            let Euler { roll, pitch, yaw } = row.attitude;
            let Geodetic { lat, lon, h } = row.position;
            let mut value = [lat - origin.lat, lon - origin.lon, h - origin.h, roll, pitch, yaw];
            if let Some(before) = values.last() {
                let dt = row.t - rows[k - 1].t;
                let increases = dt > 0.0;
                if !increases {
                    let problem = format!("the time {} s does not come after {} s", row.t, rows[k - 1].t);
                    return Err(Impossible::new(problem, "times that increase").at(k));
                }
                if dt > knots {
                    let problem = format!("a gap of {dt} s");
                    return Err(
                        Impossible::new(problem, format!("a row every {knots} s or more often")).at(k)
                    );
                }
                for axis in [1, 3, 5] {
                    value[axis] -= TAU * ((value[axis] - before[axis]) / TAU).round();
                }
                let steps = [3, 4, 5].map(|axis| (value[axis] - before[axis]).abs());
                if steps.iter().any(|step| *step > STEP || step.is_nan()) {
                    return Err(
                        Impossible::new("an angle jumps by more than 90 deg", "rows more often").at(k)
                    );
                }
            }
            values.push(value);
        }
        let few = || {
            let problem = format!("{} rows are too few for knots every {knots} s", rows.len());
            Impossible::new(problem, format!("{ROWS} rows or more between two knots, and five more"))
        };
        let times: Vec<f64> = rows.iter().map(|row| row.t - first.t).collect();
        let fit = Fit::new(&times, &values, knots).ok_or_else(few)?;
        let intervals = ((last.t - first.t) / fit.knots()).round() as u64;
        if rows.len() < ROWS * intervals as usize + 5 {
            return Err(few());
        }
        let joints = (0..=intervals).map(|k| k as f64 * fit.knots()).collect();
        let mut recorded = Recorded { fit, origin, joints, residual: Residual::default() };
        recorded.residual = recorded.compare(rows, &times)?;
        Ok(recorded)
    }

    /// How far the rows are from the splines.
    pub fn residual(&self) -> Residual {
        self.residual
    }

    fn compare(&self, rows: &[Row], times: &[f64]) -> Result<Residual, Impossible> {
        let mut residual = Residual::default();
        let n = rows.len() as f64;
        for (k, (row, t)) in rows.iter().zip(times).enumerate() {
            let (passing, [roll, pitch, yaw]) = self.split(*t);
            passing.possible(false).map_err(|fault| fault.at(k))?;
            let apart = position_error(passing.place.position, row.position);
            let Euler { roll: r, pitch: p, yaw: y } = row.attitude;
            let angles = [(roll, r), (pitch, p), (yaw, y)].map(|(spline, row)| {
                let apart = spline.value() - row;
                apart - TAU * (apart / TAU).round()
            });
            residual.position_largest = residual.position_largest.max(apart.norm());
            for axis in 0..3 {
                residual.position_rms[axis] += apart[axis] * apart[axis] / n;
                residual.attitude_rms[axis] += angles[axis] * angles[axis] / n;
                residual.attitude_largest = residual.attitude_largest.max(angles[axis].abs());
            }
        }
        residual.position_rms = residual.position_rms.map(f64::sqrt);
        residual.attitude_rms = residual.attitude_rms.map(f64::sqrt);
        Ok(residual)
    }

    fn split(&self, t: f64) -> (Passing, [super::Jet<5>; 3]) {
        let [lat, lon, h, roll, pitch, yaw] = self.fit.at(t);
        let Geodetic { lat: lat0, lon: lon0, h: h0 } = self.origin;
        (Passing::new([lat + lat0, lon + lon0, h + h0]), [roll, pitch, yaw])
    }
}

impl Trajectory for Recorded {
    fn at(&self, t: f64) -> Kinematics {
        let (passing, [roll, pitch, yaw]) = self.split(t);
        let stance = Stance::from_euler(roll.truncated(), pitch.truncated(), yaw.truncated());
        Kinematics::new(passing.place, stance)
    }

    fn joints(&self) -> &[f64] {
        &self.joints
    }

    fn duration(&self) -> Option<f64> {
        self.joints.last().copied()
    }

    fn fastest(&self, _: f64) -> f64 {
        2.0 * smooth::frequency(self.fit.knots())
    }
}
