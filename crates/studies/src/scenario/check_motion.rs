//! Motions: from the written to the valid form.

use std::f64::consts::{FRAC_PI_2, TAU};

use schuler_frames::{Euler, Geodetic};
use schuler_imu::Unit;

use super::{
    de::At,
    document::{Document, NodeId, Spot},
    quantity::Range,
    valid::Start,
    valid_motion::{Motion, TrajectoryFile, Way},
    written::Quantity,
    written_motion as w,
};
use crate::{
    Diagnostic,
    record::columns,
    trajectory::{Impossible, Passage, Pose, Segment, Sharpness, Sine, SwayAxes, TableTurns, Turn, Waypoint},
};

pub(super) const SPEED: Unit = Unit::METRE.over(Unit::SECOND);
/// Ramps where none is stated, s.
const TURN_RAMP: f64 = 2.0;
const CLIMB_RAMP: f64 = 3.0;
/// Eights that nobody means.
const MAX_EIGHTS: u64 = 100_000;

impl Document {
    /// The motion with everything checked but what only its trajectory shows. `duration` is that of the scenario, s.
    pub(super) fn motion(
        &self,
        motion: &At<w::Motion>,
        start: Option<&Start>,
        duration: Option<f64>,
    ) -> Result<Motion, Diagnostic> {
        let moves = matches!(
            motion.value,
            w::Motion::Segments(_) | w::Motion::ConstantVelocity | w::Motion::Shaken(_) | w::Motion::File(_)
        );
        if !moves && start.is_some_and(|start| start.velocity != [0.0; 3]) {
            return Err(self
                .diagnostic(Spot::Node(motion.node), "a velocity at the start of a motion that has its own")
                .expected("no `start.velocity`")
                .help("take it out, or choose `segments` or `constant_velocity`"));
        }
        let attitude = start.map_or_else(Euler::default, |start| start.attitude);
        Ok(match &motion.value {
            w::Motion::ZeroTruth => Motion::ZeroTruth,
            w::Motion::Static => Motion::Static,
            w::Motion::RateTable(table) => {
                Motion::RateTable(self.rate_table(motion.node, table, duration)?)
            }
            w::Motion::Sway(sway) => {
                let w::Sway { roll, pitch, yaw, n, e, d } = sway;
                Motion::Sway(self.sway([roll, pitch, yaw], [n, e, d])?)
            }
            w::Motion::Positions(positions) => {
                let rate = self.quantity(&positions.rate, Unit::RATE, Range::Positive)?;
                let poses = positions.poses.value.iter().map(|pose| self.pose(pose, attitude));
                let poses = poses.collect::<Result<Vec<_>, _>>()?;
                if poses.is_empty() {
                    return Err(self
                        .diagnostic(Spot::Node(positions.poses.node), "no position")
                        .expected("one or more")
                        .example("poses: [{ yaw: 0 deg, dwell: 300 s }, { yaw: 180 deg, dwell: 300 s }]"));
                }
                Motion::Positions(poses, rate)
            }
            w::Motion::Coning(coning) => Motion::Coning([
                self.quantity(&coning.half_angle, Unit::RADIAN, Range::Any)?,
                self.quantity(&coning.frequency, Unit::HERTZ, Range::Positive)?,
            ]),
            w::Motion::Sculling(sculling) => Motion::Sculling([
                self.quantity(&sculling.angle, Unit::RADIAN, Range::Any)?,
                self.quantity(&sculling.acceleration, Unit::FORCE, Range::Any)?,
                self.quantity(&sculling.frequency, Unit::HERTZ, Range::Positive)?,
            ]),
            w::Motion::Segments(segments) => {
                if let Some(start) = start {
                    self.nose_first(motion.node, start)?;
                }
                let segments = segments.value.iter().map(|segment| self.segment(segment));
                Motion::Segments(segments.collect::<Result<_, _>>()?)
            }
            w::Motion::ConstantVelocity => Motion::ConstantVelocity,
            w::Motion::GreatCircle(circle) => {
                let speed = self.quantity(&circle.speed, SPEED, Range::Positive)?;
                let way = match (&circle.heading, &circle.to) {
                    (Some(heading), None) => {
                        Way::Heading(self.quantity(heading, Unit::RADIAN, Range::Any)?)
                    }
                    (None, Some(to)) => {
                        let [lat, lon] = self.quantities(to, Unit::RADIAN)?;
                        Way::To(self.ground(to.node, lat, lon)?)
                    }
                    _ => {
                        return Err(self.one_of(
                            motion.node,
                            "`heading` or `to`",
                            "great_circle: { speed: 250 m/s, to: [60 deg, -30 deg] }",
                        ));
                    }
                };
                Motion::GreatCircle(speed, way)
            }
            w::Motion::Shaken(shaken) => {
                let w::Shaken { motion, roll, pitch, yaw, x, y, z } = &**shaken;
                let axes = self.sway([roll, pitch, yaw], [x, y, z])?;
                let inner = self.motion(motion, start, duration)?;
                if inner == Motion::ZeroTruth {
                    return Err(self
                        .diagnostic(Spot::Node(motion.node), "zero truth is no motion")
                        .expected("a motion on the Earth")
                        .example("motion: static"));
                }
                Motion::Shaken(Box::new(inner), axes)
            }
            w::Motion::Waypoints(waypoints) => {
                let mut points = Vec::new();
                let mut h = start.map_or(0.0, |start| start.position.h);
                for point in &waypoints.points.value {
                    let point = self.waypoint(point, h)?;
                    h = point.position.h;
                    points.push(point);
                }
                Motion::Waypoints(waypoints.flat.unwrap_or(false), points)
            }
            w::Motion::File(file) => {
                let columns = columns::TRAJECTORY;
                let [t, lat, lon, h, .., roll, pitch, yaw] = columns;
                let standard = [t, lat, lon, h, roll, pitch, yaw].map(String::from);
                let angle = file.angle.as_ref();
                Motion::File(TrajectoryFile {
                    file: file.file.value.clone(),
                    columns: file.columns.clone().unwrap_or(standard),
                    angle: angle.map_or(Ok(1.0), |a| self.quantity(a, Unit::RADIAN, Range::Positive))?,
                    knots: self.quantity(&file.knots, Unit::SECOND, Range::Positive)?,
                })
            }
        })
    }

    fn waypoint(&self, point: &At<w::Waypoint>, h: f64) -> Result<Waypoint, Diagnostic> {
        let w = &point.value;
        let angle = |q| self.quantity(q, Unit::RADIAN, Range::Any);
        let ground = self.ground(point.node, angle(&w.lat)?, angle(&w.lon)?)?;
        let h = w.h.as_ref().map_or(Ok(h), |h| self.quantity(h, Unit::METRE, Range::Any))?;
        let passage = match (&w.time, &w.speed) {
            (Some(time), None) => Passage::Time(self.quantity(time, Unit::SECOND, Range::Any)?),
            (None, Some(speed)) => Passage::Speed(self.quantity(speed, SPEED, Range::Positive)?),
            _ => {
                let example = "{ lat: 48 deg, lon: 11 deg, h: 500 m, speed: 60 m/s }";
                return Err(self.one_of(point.node, "`time` or `speed`", example));
            }
        };
        Ok(Waypoint { position: Geodetic { h, ..ground }, passage })
    }

    fn one_of(&self, node: NodeId, words: &str, example: &str) -> Diagnostic {
        self.diagnostic(Spot::Node(node), format!("not exactly one of {words}"))
            .expected(format!("one of {words}"))
            .example(example)
    }

    fn ground(&self, node: NodeId, lat: f64, lon: f64) -> Result<Geodetic, Diagnostic> {
        if lat.abs() <= FRAC_PI_2 && lon.abs() <= TAU {
            return Ok(Geodetic::new(lat, lon, 0.0));
        }
        Err(self
            .diagnostic(Spot::Node(node), "no place on the Earth")
            .expected("latitude -90 deg to 90 deg, longitude -360 deg to 360 deg")
            .found(format!("{} deg, {} deg", lat.to_degrees(), lon.to_degrees()))
            .example("[60 deg, -30 deg]"))
    }

    /// A vehicle that moves goes where its nose points; `start.attitude` may say so or be absent.
    fn nose_first(&self, node: NodeId, start: &Start) -> Result<(), Diagnostic> {
        let [n, e, d] = start.velocity;
        let Euler { pitch, yaw, .. } = start.attitude;
        let level = n.hypot(e);
        let speed = level.hypot(d);
        if speed == 0.0 || (pitch == 0.0 && yaw == 0.0) {
            return Ok(());
        }
        let along = n * pitch.cos() * yaw.cos() + e * pitch.cos() * yaw.sin() - d * pitch.sin();
        // 0.1 deg.
        if along > 0.999_998_5 * speed {
            return Ok(());
        }
        let (heading, climb) = (e.atan2(n), (0.0 - d).atan2(level));
        Err(self
            .diagnostic(Spot::Node(node), "the start moves, but not where its nose points")
            .expected(format!(
                "pitch {:.3} deg and yaw {:.3} deg, as the velocity has it",
                climb.to_degrees(),
                heading.to_degrees()
            ))
            .found(format!("pitch {:.3} deg, yaw {:.3} deg", pitch.to_degrees(), yaw.to_degrees()))
            .help("leave `start.attitude` out: segments begin along the velocity"))
    }

    fn pose(&self, pose: &w::Pose, else_as: Euler) -> Result<Pose, Diagnostic> {
        let angle = |angle: &Option<Quantity>, otherwise: f64| {
            angle.as_ref().map_or(Ok(otherwise), |a| self.quantity(a, Unit::RADIAN, Range::Any))
        };
        Ok(Pose {
            attitude: Euler {
                roll: angle(&pose.roll, else_as.roll)?,
                pitch: angle(&pose.pitch, else_as.pitch)?,
                yaw: angle(&pose.yaw, else_as.yaw)?,
            },
            dwell: self.quantity(&pose.dwell, Unit::SECOND, Range::NonNegative)?,
        })
    }

    fn sway(
        &self,
        angles: [&Option<w::Sines>; 3],
        ways: [&Option<w::Sines>; 3],
    ) -> Result<SwayAxes, Diagnostic> {
        let list = |sines: &Option<w::Sines>, unit| {
            let sines = sines.iter().flat_map(|list| &list.0);
            sines.map(|sine| self.sine(sine, unit)).collect::<Result<Vec<_>, _>>()
        };
        let ([roll, pitch, yaw], [n, e, d]) = (angles, ways);
        Ok(SwayAxes {
            roll: list(roll, Unit::RADIAN)?,
            pitch: list(pitch, Unit::RADIAN)?,
            yaw: list(yaw, Unit::RADIAN)?,
            n: list(n, Unit::METRE)?,
            e: list(e, Unit::METRE)?,
            d: list(d, Unit::METRE)?,
        })
    }

    fn sine(&self, sine: &w::Sine, unit: Unit) -> Result<Sine, Diagnostic> {
        let omega = match (&sine.period, &sine.frequency) {
            (Some(period), None) => TAU / self.quantity(period, Unit::SECOND, Range::Positive)?,
            (None, Some(frequency)) => TAU * self.quantity(frequency, Unit::HERTZ, Range::Positive)?,
            _ => {
                let example = "{ amplitude: 2 deg, period: 8 s }";
                return Err(self.one_of(sine.amplitude.node, "`period` or `frequency`", example));
            }
        };
        let phase = sine.phase.as_ref().map_or(Ok(0.0), |p| self.quantity(p, Unit::RADIAN, Range::Any))?;
        Ok(Sine { amplitude: self.quantity(&sine.amplitude, unit, Range::Any)?, omega, phase })
    }

    fn segment(&self, segment: &At<w::Segment>) -> Result<Segment, Diagnostic> {
        let node = segment.node;
        let seconds = |q: &Quantity| self.quantity(q, Unit::SECOND, Range::Positive);
        let speed = |q: &Quantity| self.quantity(q, SPEED, Range::NonNegative);
        let angle = |q: &Quantity| self.quantity(q, Unit::RADIAN, Range::Any);
        Ok(match &segment.value {
            w::Segment::Stand(s) => Segment::Stand { duration: seconds(&s.duration)? },
            w::Segment::Accelerate(s) => {
                Segment::Accelerate { to: speed(&s.to)?, duration: seconds(&s.duration)? }
            }
            w::Segment::Straight(s) => match (&s.duration, &s.distance) {
                (Some(duration), None) => Segment::Straight { duration: seconds(duration)? },
                (None, Some(distance)) => {
                    Segment::Distance { distance: self.quantity(distance, Unit::METRE, Range::Positive)? }
                }
                _ => {
                    let words = "`duration` or `distance`";
                    return Err(self.one_of(node, words, "straight: { duration: 60 s }"));
                }
            },
            w::Segment::Turn(s) => Segment::Turn { angle: angle(&s.angle)?, turn: self.turn_by(node, s)? },
            w::Segment::STurn(s) => Segment::STurn { angle: angle(&s.angle)?, turn: self.turn_by(node, s)? },
            w::Segment::FigureOfEight(s) => {
                let count = s.count.as_ref().map_or(1, |count| count.value);
                if !(1..=MAX_EIGHTS).contains(&count) {
                    return Err(self
                        .diagnostic(Spot::Node(node), "no such number of eights")
                        .expected("1 to 100 000")
                        .found(count.to_string()));
                }
                let turn = self.turn(node, [&s.rate, &s.radius, &s.bank], &s.ramp, s.flat)?;
                Segment::FigureOfEight { count: count as u32, turn }
            }
            w::Segment::Climb(s) => Segment::Climb {
                height: self.quantity(&s.height, Unit::METRE, Range::Any)?,
                angle: self.quantity(&s.angle, Unit::RADIAN, Range::Positive)?,
                ramp: s.ramp.as_ref().map_or(Ok(CLIMB_RAMP), seconds)?,
            },
            w::Segment::Roll(s) => Segment::Roll { to: angle(&s.to)?, duration: seconds(&s.duration)? },
        })
    }

    fn turn_by(&self, node: NodeId, s: &w::TurnBy) -> Result<Turn, Diagnostic> {
        self.turn(node, [&s.rate, &s.radius, &s.bank], &s.ramp, s.flat)
    }

    fn turn(
        &self,
        node: NodeId,
        sharpness: [&Option<Quantity>; 3],
        ramp: &Option<Quantity>,
        flat: Option<bool>,
    ) -> Result<Turn, Diagnostic> {
        let positive = |q, unit| self.quantity(q, unit, Range::Positive);
        let sharpness = match sharpness {
            [Some(rate), None, None] => Sharpness::Rate(positive(rate, Unit::RATE)?),
            [None, Some(radius), None] => Sharpness::Radius(positive(radius, Unit::METRE)?),
            [None, None, Some(bank)] => Sharpness::Bank(positive(bank, Unit::RADIAN)?),
            _ => {
                let words = "`rate`, `radius` or `bank`";
                return Err(self.one_of(node, words, "turn: { angle: 90 deg, rate: 3 deg/s }"));
            }
        };
        let ramp = ramp.as_ref().map_or(Ok(TURN_RAMP), |ramp| positive(ramp, Unit::SECOND))?;
        Ok(Turn { sharpness, ramp, flat: flat.unwrap_or(false) })
    }

    fn rate_table(
        &self,
        node: NodeId,
        w: &w::RateTable,
        duration: Option<f64>,
    ) -> Result<TableTurns, Diagnostic> {
        let Some(duration) = duration else {
            return Err(self
                .diagnostic(
                    Spot::Node(node),
                    "a rate table needs the key `duration`, of which each turn has a sixth",
                )
                .example("duration: 120 s"));
        };
        let rate = self.quantity(&w.rate, Unit::RATE, Range::Positive)?;
        let acceleration = match &w.acceleration {
            None => f64::INFINITY,
            Some(written) => {
                let unit = Unit::RATE.over(Unit::SECOND);
                let acceleration = self.quantity(written, unit, Range::Positive)?;
                let least = 12.0 * rate / duration;
                if acceleration < least {
                    return Err(self
                        .diagnostic(Spot::Node(written.node), "the table does not reach its rate")
                        .expected(format!(
                            "{:.4} deg/s^2 or more: it starts and stops in a sixth of the duration",
                            least.to_degrees()
                        ))
                        .found(format!("{:.4} deg/s^2", acceleration.to_degrees()))
                        .example("acceleration: 60 deg/s^2"));
                }
                acceleration
            }
        };
        let vibration = match &w.vibration {
            None => [0.0; 3],
            Some(vibration) => self.each_axis(vibration, Unit::FORCE, Range::NonNegative)?,
        };
        Ok(TableTurns {
            rate,
            tilt: self.quantity(&w.tilt, Unit::RADIAN, Range::Any)?,
            acceleration,
            vibration,
        })
    }

    /// What a trajectory refuses, at its segment.
    pub(super) fn impossible(&self, motion: &At<w::Motion>, fault: &Impossible) -> Diagnostic {
        let node = match (&motion.value, fault.part) {
            (w::Motion::Segments(segments), Some(k)) => segments.value.get(k).map(|segment| segment.node),
            (w::Motion::Waypoints(w), Some(k)) => w.points.value.get(k).map(|point| point.node),
            (w::Motion::Shaken(shaken), _) => return self.impossible(&shaken.motion, fault),
            _ => None,
        };
        self.diagnostic(Spot::Node(node.unwrap_or(motion.node)), &*fault.problem).expected(&*fault.expected)
    }
}
