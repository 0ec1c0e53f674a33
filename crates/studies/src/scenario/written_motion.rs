//! What the instrument goes through, as written. Doc comments go into the schema.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    de::At,
    schema::OneOrList,
    written::{OneOrThree, Quantity},
};

/// What the instrument goes through.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Zero angular velocity and zero specific force (no place on the Earth has that).
    ZeroTruth,
    /// At rest on the Earth.
    Static,
    /// On a tilted rate table that turns each axis both ways.
    RateTable(RateTable),
    /// A rocking base: sums of sines about the place and attitude of the start, as of a ship at its moorings.
    Sway(Sway),
    /// Dwells in one attitude after the other: two-position and multi-position tests.
    Positions(Positions),
    /// Classical coning about the attitude of the start.
    Coning(Coning),
    /// Classical sculling: swings about x and is shaken along y, in step.
    Sculling(Sculling),
    /// A drive or flight of segments, from the place, heading, pitch and velocity of the start.
    Segments(At<Vec<At<Segment>>>),
    /// The velocity and attitude of the start all the time: a rhumb line.
    ConstantVelocity,
    /// Around the Earth on a great circle at the height of the start, over the poles too.
    GreatCircle(GreatCircle),
    /// Through given points, nose along the track.
    Waypoints(Waypoints),
    /// A recorded trajectory, made smooth by splines; `start` is not used.
    File(TrajectoryFile),
    /// Another motion with a vibration on top.
    Shaken(Box<Shaken>),
}

/// The duration is cut in six: about x forward and back, about y forward and back, about z forward and back.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RateTable {
    /// Rate of the table, `30 deg/s`.
    pub rate: Quantity,
    /// Tilt of its axis from the vertical, towards north.
    pub tilt: Quantity,
    /// Angular acceleration with which it starts and stops, `60 deg/s^2`; at once when absent.
    pub acceleration: Option<Quantity>,
    /// Root mean square of its vibration, one for all axes of the body or three; none when absent.
    pub vibration: Option<At<OneOrThree>>,
}

/// One sine, or a list of sines that add up.
pub type Sines = OneOrList<Sine>;

/// `amplitude sin(2 pi t / period + phase)`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sine {
    /// Amplitude: an angle in roll, pitch and yaw, a length along an axis.
    pub amplitude: Quantity,
    /// Period; or `frequency`.
    pub period: Option<Quantity>,
    /// Frequency; or `period`.
    pub frequency: Option<Quantity>,
    /// Phase at t = 0; 0 deg when absent.
    pub phase: Option<Quantity>,
}

/// Sums of sines, axis by axis; what is absent keeps still.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sway {
    /// Roll.
    pub roll: Option<Sines>,
    /// Pitch.
    pub pitch: Option<Sines>,
    /// Yaw.
    pub yaw: Option<Sines>,
    /// North.
    pub n: Option<Sines>,
    /// East.
    pub e: Option<Sines>,
    /// Down.
    pub d: Option<Sines>,
}

/// Positions of a test and the turns between them, each the short way about one axis.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Positions {
    /// Largest rate of a turn, which begins and ends smoothly: half a turn at 10 deg/s takes 33.75 s.
    pub rate: Quantity,
    /// The positions.
    pub poses: At<Vec<Pose>>,
}

/// How the body stands, and for how long; angles that are absent are those of `start.attitude`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pose {
    /// Roll.
    pub roll: Option<Quantity>,
    /// Pitch.
    pub pitch: Option<Quantity>,
    /// Yaw.
    pub yaw: Option<Quantity>,
    /// Dwell after the turn, `300 s`.
    pub dwell: Quantity,
}

/// The x axis goes round a cone; at t = 0 the body has turned by the half angle about y.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coning {
    /// Half angle of the cone.
    pub half_angle: Quantity,
    /// Turns of the cone a second.
    pub frequency: Quantity,
}

/// Rotation and vibration in phase.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sculling {
    /// Amplitude of the rotation about x.
    pub angle: Quantity,
    /// Amplitude of the acceleration along y.
    pub acceleration: Quantity,
    /// Frequency of both.
    pub frequency: Quantity,
}

/// A part of a drive or flight. Speed, climb angle and roll pass smoothly (C2) from segment to segment.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Segment {
    /// Nothing moves.
    Stand(Lasting),
    /// To another speed; to a stop too.
    Accelerate(Accelerate),
    /// On as it goes.
    Straight(Straight),
    /// To another heading.
    Turn(TurnBy),
    /// To the right by an angle, to the left by twice the angle, and back to the line.
    STurn(TurnBy),
    /// Full circles to the right and to the left in turn.
    FigureOfEight(Eights),
    /// To another height, and level again.
    Climb(Climb),
    /// To another roll, beside that of coordinated turns.
    Roll(Roll),
}

/// A time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lasting {
    /// How long.
    pub duration: Quantity,
}

/// A change of speed.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Accelerate {
    /// Speed at its end.
    pub to: Quantity,
    /// How long.
    pub duration: Quantity,
}

/// Straight on, by time or by distance.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Straight {
    /// How long; or `distance`.
    pub duration: Option<Quantity>,
    /// How far; or `duration`.
    pub distance: Option<Quantity>,
}

/// A turn by an angle; how sharp it is say `rate`, `radius` or `bank`, one of them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TurnBy {
    /// Angle, to the right positive; several turns are fine.
    pub angle: Quantity,
    /// Rate of heading.
    pub rate: Option<Quantity>,
    /// Radius.
    pub radius: Option<Quantity>,
    /// Bank of a coordinated turn.
    pub bank: Option<Quantity>,
    /// Time in which the turn comes to its rate, and from it; 2 s when absent.
    pub ramp: Option<Quantity>,
    /// Whether the vehicle keeps its roll, as a car does; false when absent: it banks, so that nothing is felt sideways.
    pub flat: Option<bool>,
}

/// Figures of eight; how sharp they are say `rate`, `radius` or `bank`, one of them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Eights {
    /// How many; 1 when absent.
    pub count: Option<At<u64>>,
    /// Rate of heading.
    pub rate: Option<Quantity>,
    /// Radius.
    pub radius: Option<Quantity>,
    /// Bank of a coordinated turn.
    pub bank: Option<Quantity>,
    /// Time in which a circle comes to its rate, and from it; 2 s when absent.
    pub ramp: Option<Quantity>,
    /// Whether the vehicle keeps its roll, as a car does; false when absent.
    pub flat: Option<bool>,
}

/// A change of height.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Climb {
    /// Change of height, negative downwards.
    pub height: Quantity,
    /// Climb angle on the way.
    pub angle: Quantity,
    /// Time of the pull at each end; 3 s when absent.
    pub ramp: Option<Quantity>,
}

/// A change of roll.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Roll {
    /// Roll at its end.
    pub to: Quantity,
    /// How long.
    pub duration: Quantity,
}

/// With a first heading, or to a place, where it ends.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GreatCircle {
    /// Speed over ground at the start; it varies by up to 0.7 % with the radii of the Earth.
    pub speed: Quantity,
    /// Heading at the start; or `to`.
    pub heading: Option<Quantity>,
    /// Latitude and longitude of the end; or `heading`.
    pub to: Option<At<[Quantity; 2]>>,
}

/// Points to pass, and how.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waypoints {
    /// The points after the start, which is the first.
    pub points: At<Vec<At<Waypoint>>>,
    /// Whether the vehicle keeps its roll, as a car does; false when absent: it banks in turns.
    pub flat: Option<bool>,
}

/// A point to pass.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// Latitude.
    pub lat: Quantity,
    /// Longitude.
    pub lon: Quantity,
    /// Height; that of the point before when absent.
    pub h: Option<Quantity>,
    /// When; or `speed`.
    pub time: Option<Quantity>,
    /// Mean speed on the way there, along the straight line; or `time`.
    pub speed: Option<Quantity>,
}

/// A recorded trajectory, CSV or CSV.gz.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrajectoryFile {
    /// File; looked up in the data folder (`--data`, `SCHULER_DATA`), then beside the scenario.
    pub file: At<String>,
    /// Columns of time (s), latitude, longitude, height (m), roll, pitch and yaw, by their names in the header; those
    /// of `truth.csv` when absent.
    pub columns: Option<[String; 7]>,
    /// What 1 is in a column of angles, `1 deg`; `1 rad` when absent.
    pub angle: Option<Quantity>,
    /// Distance of the knots of the splines: what is faster is smoothed away. Each has two rows or more.
    pub knots: Quantity,
}

/// A vibration on top of another motion: angles against the body axes, ways along them.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shaken {
    /// The motion that is shaken.
    pub motion: At<Motion>,
    /// Roll.
    pub roll: Option<Sines>,
    /// Pitch.
    pub pitch: Option<Sines>,
    /// Yaw.
    pub yaw: Option<Sines>,
    /// Forward.
    pub x: Option<Sines>,
    /// To the right.
    pub y: Option<Sines>,
    /// Down.
    pub z: Option<Sines>,
}

/// Aiding measurements.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Aiding {
    /// Position of an antenna.
    pub position: Option<At<Aid>>,
    /// Velocity of an antenna, north, east, down.
    pub velocity: Option<At<Aid>>,
    /// Height above the ellipsoid.
    pub height: Option<At<Aid>>,
    /// Heading.
    pub heading: Option<At<Aid>>,
}

/// One kind of measurement.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Aid {
    /// Measurements a second; the first after one interval.
    pub rate: Quantity,
    /// Standard deviation of its white noise, one for all axes or three (north, east, down); 0 is fine.
    pub sigma: At<OneOrThree>,
    /// From the IMU to the antenna along body x, y, z; zero when absent.
    pub lever_arm: Option<At<[Quantity; 3]>>,
    /// Times without measurement, `[[100 s, 160 s]]`.
    pub outages: Option<At<Vec<At<[Quantity; 2]>>>>,
    /// How long after a sample of the IMU it is taken, less than an interval of these measurements; 0 s when absent.
    pub phase: Option<Quantity>,
    /// Time of the log of the IMU minus time that this log has: its clock is wrong by this much; 0 s when absent.
    pub offset: Option<Quantity>,
}
