//! A rate table that turns one body axis after the other.

use schuler_frames::{B, Dcm, Geodetic, Rot, T, Vec3};

use super::{Kinematics, Place, Stance, Trajectory};

/// Segments: about x, y, z, each forward and back.
const SEGMENTS: u64 = 6;

/// How a rate table turns: about each body axis x, y, z forward and back at `rate`, its own axis tilted from the
/// vertical by `tilt`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableTurns {
    /// Rate of the table, rad/s, positive.
    pub rate: f64,
    /// Tilt of the table axis from the vertical, rad.
    pub tilt: f64,
    /// Angular acceleration of its starts and stops, rad/s², positive; infinite where they take no time.
    pub acceleration: f64,
    /// Root mean square of its vibration along x, y, z of the body, m/s².
    pub vibration: [f64; 3],
}

/// A table that turns one body axis after the other about its own axis, which leans from the vertical. Between
/// axes the instrument is mounted anew, in no time: its attitude jumps there.
#[derive(Clone, Debug, PartialEq)]
pub struct RateTable {
    place: Place,
    /// Table at rest to local level, z along the table's axis.
    c_tp: Rot<T, B>,
    turn: Turn,
    /// Begin of each segment, and the end of the last, s.
    begins: [f64; SEGMENTS as usize + 1],
    joints: Vec<f64>,
    vibration: [f64; 3],
}

/// A turn from rest to rest: speeds up, keeps its rate, slows down.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    /// rad/s.
    rate: f64,
    /// rad/s², infinite where starts and stops take no time.
    acceleration: f64,
}

impl RateTable {
    /// The table at `position` over `samples` of `dt` (s), cut in six; each segment takes whole samples.
    pub fn new(position: Geodetic, table: &TableTurns, samples: u64, dt: f64) -> Self {
        let begins = std::array::from_fn(|k| (k as u64 * samples / SEGMENTS) as f64 * dt);
        let turn = Turn { rate: table.rate, acceleration: table.acceleration };
        let ramp = turn.rate / turn.acceleration;
        let mut joints = Vec::new();
        for pair in begins.windows(2) {
            joints.push(pair[0]);
            if ramp > 0.0 {
                joints.extend([pair[0] + ramp, pair[1] - ramp]);
            }
        }
        joints.push(begins[SEGMENTS as usize]);
        // z down the table's axis: the vertical, turned about east so that its lower end goes south.
        let (s, c) = libm::sincos(table.tilt);
        let c_tp = Rot::from_dcm(Dcm::claim([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]));
        let vibration = table.vibration.map(|rms| rms * rms);
        RateTable { place: Place::still(position), c_tp, turn, begins, joints, vibration }
    }
}

impl Turn {
    /// Angle, rate and angular acceleration at the time `t` of a turn that takes `whole` seconds.
    fn at(&self, t: f64, whole: f64) -> [f64; 3] {
        let Turn { rate, acceleration } = *self;
        if acceleration.is_infinite() {
            return [rate * t, rate, 0.0];
        }
        let ramp = rate / acceleration;
        let up = |t: f64| 0.5 * acceleration * t * t;
        match t {
            t if t < 0.0 => [0.0; 3],
            t if t < ramp => [up(t), acceleration * t, acceleration],
            t if t < whole - ramp => [rate * (t - 0.5 * ramp), rate, 0.0],
            t if t < whole => {
                [rate * (whole - ramp) - up(whole - t), acceleration * (whole - t), -acceleration]
            }
            _ => [rate * (whole - ramp), 0.0, 0.0],
        }
    }
}

impl Trajectory for RateTable {
    fn at(&self, t: f64) -> Kinematics {
        let begins = &self.begins[..SEGMENTS as usize];
        let segment = begins.partition_point(|begin| *begin <= t).saturating_sub(1);
        let length = |segment: usize| self.begins[segment + 1] - self.begins[segment];
        let [angle, rate, acceleration] = self.turn.at(t - self.begins[segment], length(segment));
        // The way back begins where the way there ended.
        let [angle, rate, acceleration] = if segment.is_multiple_of(2) {
            [angle, rate, acceleration]
        } else {
            let there = length(segment - 1);
            [self.turn.at(there, there)[0] - angle, -rate, -acceleration]
        };
        // The body axis of the segment points along z of the table, the others follow in cyclic order: axes of
        // the table are a turn by a third about their common diagonal.
        let mount: Rot<B, B> = match segment / 2 {
            0 => Rot::claim([0.5, 0.5, 0.5, 0.5]),
            1 => Rot::claim([0.5, -0.5, -0.5, -0.5]),
            _ => Rot::IDENTITY,
        };
        let z = Vec3::<B>::new(0.0, 0.0, 1.0);
        let turned: Rot<B, B> = Rot::from_rotation_vector(z * angle);
        let axis = mount * z;
        let stance = Stance {
            c_tb: self.c_tp * turned * mount.inverse(),
            omega_tb_b: axis * rate,
            alpha_tb_b: axis * acceleration,
        };
        Kinematics::new(self.place, stance)
    }

    fn joints(&self) -> &[f64] {
        &self.joints
    }

    fn duration(&self) -> Option<f64> {
        Some(self.begins[SEGMENTS as usize])
    }

    fn fastest(&self, _: f64) -> f64 {
        // Two of its axes see a force that turns; the angle itself is a parabola at most.
        2.0 * self.turn.rate
    }

    fn vibration(&self) -> [f64; 3] {
        self.vibration
    }
}
