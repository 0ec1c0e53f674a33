//! A method at work: samples and velocities in, an attitude and what the method thinks of it out.

use schuler_frames::{B, I, Rate, Rot, T, Vec3};
use schuler_strapdown::align::{
    AnyHeading, AnyHeadingNoise, Gyrocompass, InertialFrame, Limits, Solution, Vectors,
};
use schuler_strapdown::static_base::Site;
use schuler_strapdown::{BodyMotion, Increments};

use super::fine::Fine;
use super::place::Place;
use super::withheld::at_pole;
use crate::scenario::{Method, MethodKind};

/// A method while it works.
pub enum Worker {
    /// Averages two vectors.
    Mean { vectors: Vectors, dtheta: Vec3<B>, dv: Vec3<B>, time: f64 },
    /// Collects in inertial space.
    Inertial { frame: Box<InertialFrame>, solution: Solution, latitude_known: bool },
    /// The classical loop, once it has a coarse attitude.
    Loop { tau: f64, compass: Option<Box<Gyrocompass>> },
    /// A filter for any heading, once the first interval has shown what is level.
    AnyHeading { noise: AnyHeadingNoise, dv: Vec3<B>, filter: Option<Box<AnyHeading>> },
    /// A filter.
    Fine(Box<Fine>),
}

/// The attitude that a method has found, and its own idea of the error.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub c_tb: Rot<T, B>,
    /// Standard deviations of phi by the method itself, rad, if it has any.
    pub sigma: Option<[f64; 3]>,
}

impl Worker {
    /// A method that begins at `place`; `duration` (s) is the time it will have.
    ///
    /// A filter keeps its errors along north and east and heading: at a pole there is none.
    pub fn new(method: &Method, place: &Place, duration: f64) -> Result<Worker, String> {
        if matches!(method.kind, MethodKind::Filter(_) | MethodKind::AnyHeading(_))
            && let Some(why) = at_pole(&Limits::new(Site::new(place.position, place.gravity)))
        {
            return Err(why.into());
        }
        Ok(match &method.kind {
            MethodKind::Triad(vectors) => {
                Worker::Mean { vectors: *vectors, dtheta: Vec3::ZERO, dv: Vec3::ZERO, time: 0.0 }
            }
            &MethodKind::Inertial { solution, latitude_known } => {
                let frame = Box::new(InertialFrame::new(0.5 * duration));
                Worker::Inertial { frame, solution, latitude_known }
            }
            MethodKind::Gyrocompass(tau) => Worker::Loop { tau: *tau, compass: None },
            &MethodKind::AnyHeading(noise) => Worker::AnyHeading { noise, dv: Vec3::ZERO, filter: None },
            MethodKind::Filter(settings) => Worker::Fine(Box::new(Fine::new(settings)?)),
        })
    }

    /// TRIAD, specific force first.
    pub fn mean() -> Worker {
        Worker::Mean { vectors: Vectors::ForceFirst, dtheta: Vec3::ZERO, dv: Vec3::ZERO, time: 0.0 }
    }

    /// Least squares in inertial space over `duration` (s).
    pub fn inertial(duration: f64) -> Worker {
        let frame = Box::new(InertialFrame::new(0.5 * duration));
        Worker::Inertial { frame, solution: Solution::Optimal, latitude_known: true }
    }

    /// Whether it begins with a coarse attitude.
    pub fn needs_coarse(&self) -> bool {
        matches!(self, Worker::Loop { .. } | Worker::Fine(_))
    }

    /// The coarse attitude is there.
    pub fn begin(&mut self, c_tb: Rot<T, B>, place: &Place) {
        match self {
            Worker::Mean { .. } | Worker::Inertial { .. } | Worker::AnyHeading { .. } => {}
            Worker::Loop { tau, compass } => {
                *compass = Some(Box::new(Gyrocompass::new(c_tb, place.position, place.gravity, *tau)));
            }
            Worker::Fine(fine) => fine.begin(c_tb, place),
        }
    }

    /// One sample: what was measured, and the motion that the coning algorithm makes of it.
    pub fn advance(&mut self, increments: &Increments, motion: &BodyMotion, dt: f64) {
        match self {
            Worker::Mean { dtheta, dv, time, .. } => {
                *dtheta += increments.dtheta;
                *dv += increments.dv;
                *time += dt;
            }
            Worker::Inertial { frame, .. } => frame.advance(motion, dt),
            Worker::AnyHeading { dv, filter, .. } => match filter {
                Some(filter) => filter.advance(motion, dt),
                None => *dv += increments.dv,
            },
            Worker::Loop { compass, .. } => {
                if let Some(compass) = compass {
                    compass.advance(motion, dt);
                }
            }
            Worker::Fine(fine) => fine.advance(increments, dt),
        }
    }

    /// The velocity of the base (north, east, m/s) as it is known at this time.
    pub fn measure(&mut self, velocity: [f64; 2], place: &Place) -> Result<(), String> {
        match self {
            Worker::AnyHeading { noise, dv, filter } => {
                match filter {
                    Some(filter) => filter.measure(velocity),
                    None => {
                        let begun = AnyHeading::new(*dv, place.position, place.gravity, *noise);
                        *filter = Some(Box::new(begun));
                    }
                }
                Ok(())
            }
            Worker::Fine(fine) => fine.measure(velocity),
            _ => Ok(()),
        }
    }

    /// The attitude now, or why there is none.
    pub fn found(&self, place: &Place) -> Result<Found, String> {
        let (position, gravity) = (place.position, place.gravity);
        let alone = |c_tb| Found { c_tb, sigma: None };
        let found = match self {
            Worker::Mean { vectors, dtheta, dv, time } => {
                let (omega, f) = (*dtheta * (1.0 / time), *dv * (1.0 / time));
                let found = vectors.attitude(f, Rate::<B, I, B>::claim(omega), position, gravity);
                found.map(alone).map_err(|e| e.to_string())
            }
            Worker::Inertial { frame, solution, latitude_known } => {
                let mut there = position;
                if !latitude_known {
                    there.lat = frame.latitude().map_err(|e| e.to_string())?;
                }
                frame.attitude(*solution, there, gravity).map(alone).map_err(|e| e.to_string())
            }
            Worker::Loop { compass, .. } => {
                let compass = compass.as_ref().ok_or("the coarse attitude is not there yet")?;
                Ok(alone(compass.attitude()))
            }
            Worker::AnyHeading { filter, .. } => {
                let filter = filter.as_ref().ok_or("nothing was measured yet")?;
                Ok(Found { c_tb: filter.attitude(), sigma: Some(filter.sigma()) })
            }
            Worker::Fine(fine) => fine.found(),
        };
        let finite = |found: &Found| found.c_tb.as_dcm().as_nalgebra().iter().all(|x| x.is_finite());
        found.and_then(|found: Found| {
            if finite(&found) { Ok(found) } else { Err("its attitude is no finite number any more".into()) }
        })
    }

    /// What the method knows of the sensors' errors now, along body axes (rad/s, m/s²), to be taken out of what they measure.
    pub fn sensor_errors(&self) -> [[f64; 3]; 2] {
        match self {
            Worker::Fine(fine) => fine.sensor_errors(),
            _ => [[0.0; 3]; 2],
        }
    }

    /// Standard deviations of all states now, if it is a filter with a model.
    pub fn state_sigmas(&self) -> Vec<f64> {
        match self {
            Worker::Fine(fine) => (0..fine.filter().model().len()).map(|k| fine.filter().sigma(k)).collect(),
            _ => Vec::new(),
        }
    }

    /// The filter in it, if it is one with a model.
    pub fn fine(&self) -> Option<&Fine> {
        match self {
            Worker::Fine(fine) => Some(fine),
            _ => None,
        }
    }

    /// Normalized estimation error squared of phi (three degrees of freedom), if the method has a covariance.
    pub fn nees(&self, phi: Vec3<T>) -> Option<f64> {
        match self {
            Worker::Fine(fine) => fine.nees(phi),
            _ => None,
        }
    }
}

/// Hands the coarse attitude to all methods that still work.
pub fn begin(workers: &mut [Result<Worker, String>], coarse: &Result<Rot<T, B>, String>, place: &Place) {
    for worker in workers {
        if let Ok(w) = worker {
            match coarse {
                Ok(c_tb) => w.begin(*c_tb, place),
                Err(why) if w.needs_coarse() => *worker = Err(why.clone()),
                Err(_) => {}
            }
        }
    }
}

/// Hands the known velocity of the base to all methods that still work.
pub fn measure(workers: &mut [Result<Worker, String>], velocity: [f64; 2], place: &Place) {
    for worker in workers {
        if let Ok(w) = worker
            && let Err(why) = w.measure(velocity, place)
        {
            *worker = Err(why);
        }
    }
}
