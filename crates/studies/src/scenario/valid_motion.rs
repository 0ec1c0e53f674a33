//! Motions and aiding measurements of the valid scenario.

use schuler_frames::{Geodetic, Gravity, Vec3};

use super::valid::{Imu, Start};
use crate::trajectory::{
    self, Course, Impossible, Pose, Segment, SwayAxes, TableTurns, Trajectory, Waypoint,
};

/// What the instrument goes through.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Zero angular velocity and zero specific force: no place on the Earth, but what an error model
    /// shows when it is alone.
    ZeroTruth,
    /// At rest on the Earth.
    Static,
    /// On a rate table that tilts and turns it.
    RateTable(TableTurns),
    /// A rocking base.
    Sway(SwayAxes),
    /// Dwells in several attitudes, and turns between them with this largest rate, rad/s.
    Positions(Vec<Pose>, f64),
    /// Coning with a half angle (rad) and a frequency (Hz).
    Coning([f64; 2]),
    /// Sculling with amplitudes of angle (rad) and acceleration (m/s²) and a frequency (Hz).
    Sculling([f64; 3]),
    /// A drive or flight of segments.
    Segments(Vec<Segment>),
    /// Always the velocity of the start.
    ConstantVelocity,
    /// A great circle at a speed, m/s.
    GreatCircle(f64, Way),
    /// Through points, in turns level or banked (`flat` is the first).
    Waypoints(bool, Vec<Waypoint>),
    /// A recorded trajectory.
    File(TrajectoryFile),
    /// Another motion with a vibration on top.
    Shaken(Box<Motion>, SwayAxes),
}

/// A recorded trajectory and how to read it.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryFile {
    /// File name, as written.
    pub file: String,
    /// Columns of time, latitude, longitude, height, roll, pitch, yaw.
    pub columns: [String; 7],
    /// rad per unit of an angle.
    pub angle: f64,
    /// Distance of the knots of the splines, s.
    pub knots: f64,
}

/// Where a great circle leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// First heading, rad.
    Heading(f64),
    /// End; its height does not count.
    To(Geodetic),
}

impl Motion {
    /// The motion as a function of time, from `start`; `gravity` decides the bank of coordinated turns. A motion that
    /// has no end of its own lasts for `samples` of `dt` (s). `None` for zero truth, which is no motion, and for what is recorded in
    /// a file.
    ///
    /// # Errors
    /// What no vehicle can do.
    pub fn trajectory(
        &self,
        start: &Start,
        gravity: Gravity,
        samples: u64,
        dt: f64,
    ) -> Result<Option<Box<dyn Trajectory>>, Impossible> {
        let Start { position, attitude, velocity, .. } = *start;
        Ok(Some(match self {
            Motion::ZeroTruth | Motion::File(_) => return Ok(None),
            Motion::Static => Box::new(trajectory::Still::new(position, attitude)),
            Motion::RateTable(table) => Box::new(trajectory::RateTable::new(position, table, samples, dt)),
            Motion::Sway(axes) => Box::new(trajectory::Sway::new(position, attitude, axes.clone())),
            Motion::Positions(poses, rate) => Box::new(trajectory::Positions::new(position, poses, *rate)),
            Motion::Coning([half_angle, frequency]) => {
                Box::new(trajectory::Coning::new(position, attitude, *half_angle, *frequency))
            }
            Motion::Sculling([angle, acceleration, frequency]) => {
                Box::new(trajectory::Sculling::new(position, attitude, *angle, *acceleration, *frequency))
            }
            Motion::Segments(segments) => {
                Box::new(trajectory::Segments::new(course(start), segments, gravity)?)
            }
            Motion::ConstantVelocity => {
                let duration = samples as f64 * dt;
                let v_t = Vec3::claim(velocity);
                Box::new(trajectory::ConstantVelocity::new(position, attitude, v_t, duration)?)
            }
            Motion::GreatCircle(speed, way) => Box::new(match way {
                Way::Heading(heading) => {
                    trajectory::GreatCircle::new(position, *heading, *speed, attitude.roll, attitude.pitch)?
                }
                Way::To(end) => {
                    trajectory::GreatCircle::to(position, *end, *speed, attitude.roll, attitude.pitch)?
                }
            }),
            Motion::Waypoints(flat, points) => {
                Box::new(trajectory::Waypoints::new(position, points, *flat, gravity)?)
            }
            Motion::Shaken(motion, axes) => match motion.trajectory(start, gravity, samples, dt)? {
                None => return Ok(None),
                Some(carrier) => Box::new(trajectory::Shaken::new(carrier, axes.clone())),
            },
        }))
    }

    /// Whether the instrument is taken off and mounted anew on the way, so that its attitude jumps.
    pub fn is_mounted_anew(&self) -> bool {
        match self {
            Motion::RateTable(_) => true,
            Motion::Shaken(motion, _) => motion.is_mounted_anew(),
            _ => false,
        }
    }

    /// The file it is recorded in, if it is.
    pub fn file(&self) -> Option<&TrajectoryFile> {
        match self {
            Motion::File(file) => Some(file),
            Motion::Shaken(motion, _) => motion.file(),
            _ => None,
        }
    }

    /// In a few words, for figures: `at rest`.
    pub fn words(&self) -> &'static str {
        match self {
            Motion::ZeroTruth => "zero truth",
            Motion::Static => "at rest",
            Motion::RateTable(_) => "on a rate table",
            Motion::Sway(_) => "swaying",
            Motion::Positions(..) => "in several positions",
            Motion::Coning(_) => "coning",
            Motion::Sculling(_) => "sculling",
            Motion::Segments(_) => "under way",
            Motion::ConstantVelocity => "at constant velocity",
            Motion::GreatCircle(..) => "on a great circle",
            Motion::Waypoints(..) => "from point to point",
            Motion::File(_) => "as recorded",
            Motion::Shaken(..) => "shaken",
        }
    }
}

/// How a vehicle begins: where it moves, heading and climb are those of its velocity.
fn course(start: &Start) -> Course {
    let [n, e, d] = start.velocity;
    let level = n.hypot(e);
    let speed = level.hypot(d);
    let (heading, climb) = if speed > 0.0 {
        (libm::atan2(e, n), libm::atan2(-d, level))
    } else {
        (start.attitude.yaw, start.attitude.pitch)
    };
    Course { position: start.position, speed, heading, climb, roll: start.attitude.roll }
}

/// `study: simulate`.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulate {
    /// What the instrument goes through; not zero truth.
    pub motion: Motion,
    /// Where, when and how it begins.
    pub start: Start,
    /// Field of the truth.
    pub gravity: Gravity,
    /// Number of samples, positive.
    pub samples: u64,
    /// The instrument.
    pub imu: Imu,
    /// Measurements beside the IMU.
    pub aiding: Aiding,
}

/// Measurements beside the IMU.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aiding {
    /// Position of an antenna; sigma in m.
    pub position: Option<Aid>,
    /// Velocity of an antenna; sigma in m/s.
    pub velocity: Option<Aid>,
    /// Height; sigma in m.
    pub height: Option<Aid>,
    /// Heading; sigma in rad.
    pub heading: Option<Aid>,
}

/// One kind of measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Aid {
    /// Interval, in samples of the IMU, positive.
    pub stride: u64,
    /// Standard deviation of the noise, three times the same where there is one component only.
    pub sigma: [f64; 3],
    /// From the IMU to the antenna, body axes, m.
    pub lever_arm: [f64; 3],
    /// Begin and end of times without measurement, s.
    pub outages: Vec<[f64; 2]>,
    /// From the end of a sample of the IMU to the measurement, s.
    pub phase: f64,
    /// What has to be added to the times of the log to get those of the IMU, s.
    pub offset: f64,
}
