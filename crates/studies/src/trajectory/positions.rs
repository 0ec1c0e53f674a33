//! Tests in several positions: dwell, turn, dwell.

use schuler_frames::{B, Euler, Geodetic, Rot, T, Vec3};

use super::{Kinematics, Place, Stance, Trajectory, smooth};

/// One position of the test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// How the body stands.
    pub attitude: Euler,
    /// For how long, s.
    pub dwell: f64,
}

/// A body that stands in one attitude after the other, at one place, and turns between them the short way about a
/// fixed axis, from rest to rest with a quintic in the angle (the rate is smooth, and the angular
/// acceleration continuous).
#[derive(Clone, Debug, PartialEq)]
pub struct Positions {
    place: Place,
    turns: Vec<Turn>,
    first: Rot<T, B>,
    joints: Vec<f64>,
    end: f64,
    fastest: f64,
}

#[derive(Clone, Debug, PartialEq)]
struct Turn {
    begin: f64,
    duration: f64,
    from: Rot<T, B>,
    /// Axis (unit vector) and angle.
    axis: Vec3<B>,
    angle: f64,
}

impl Positions {
    /// The `poses` in turn at `position`; a turn reaches `rate` (rad/s) in its middle.
    pub fn new(position: Geodetic, poses: &[Pose], rate: f64) -> Self {
        let (mut turns, mut joints) = (Vec::new(), Vec::new());
        let mut end = poses.first().map_or(0.0, |pose| pose.dwell);
        let mut fastest = 0f64;
        for pair in poses.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|pose| Rot::<T, B>::from_euler(pose.attitude));
            let rotation: Rot<B, B> = from.inverse() * to;
            let turn = rotation.as_rotation_vector();
            let angle = turn.norm();
            if angle > 0.0 {
                let duration = smooth::STEEPEST * angle / rate;
                turns.push(Turn { begin: end, duration, from, axis: turn * (1.0 / angle), angle });
                joints.extend([end, end + duration]);
                fastest = fastest.max(smooth::frequency(duration) + rate);
                end += duration;
            }
            end += pair[1].dwell;
        }
        let first = Rot::from_euler(poses.first().map_or_else(Euler::default, |pose| pose.attitude));
        Positions { place: Place::still(position), turns, first, joints, end, fastest }
    }
}

impl Trajectory for Positions {
    fn at(&self, t: f64) -> Kinematics {
        let begun = self.turns.partition_point(|turn| turn.begin <= t);
        let stance = match begun.checked_sub(1).map(|k| &self.turns[k]) {
            None => Stance::still(self.first),
            Some(turn) => {
                let part = smooth::step((t - turn.begin) / turn.duration, turn.duration);
                Stance::about(turn.from, turn.axis, part * turn.angle)
            }
        };
        Kinematics::new(self.place, stance)
    }

    fn joints(&self) -> &[f64] {
        &self.joints
    }

    fn duration(&self) -> Option<f64> {
        Some(self.end)
    }

    fn fastest(&self, _: f64) -> f64 {
        self.fastest
    }
}
