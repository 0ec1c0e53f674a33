//! Measurements beside the IMU: truth, lever arm, noise, outages.

use schuler_frames::{Geodetic, T, Vec3};
use schuler_imu::{Stream, random::Draws};
use schuler_strapdown::Pva;

use crate::{
    record::{Cell, Table, columns},
    scenario::{Aid, Aiding},
    trajectory::Moment,
};

/// A kind of measurement.
enum Kind {
    Position,
    Velocity,
    Height,
    Heading,
}

/// All kinds that are asked for, with what was measured.
pub struct Aids(Vec<Measured>);

struct Measured {
    kind: Kind,
    aid: Aid,
    draws: Draws,
    table: Table,
}

impl Aids {
    pub fn new(aiding: &Aiding, seed: u64) -> Self {
        let mut aids = Vec::new();
        let mut add = |kind, aid: &Option<Aid>, name: &str, columns: &[&str]| {
            if let Some(aid) = aid {
                let draws = Draws::new(Stream { seed, run: 0 }, &format_args!("aiding.{name}"));
                aids.push(Measured { kind, aid: aid.clone(), draws, table: Table::new(name, columns, &[]) });
            }
        };
        add(Kind::Position, &aiding.position, "position", &columns::POSITION_AID);
        add(Kind::Velocity, &aiding.velocity, "velocity", &columns::VELOCITY_AID);
        add(Kind::Height, &aiding.height, "height", &columns::HEIGHT_AID);
        add(Kind::Heading, &aiding.heading, "heading", &columns::HEADING_AID);
        Aids(aids)
    }

    /// Whether anything is measured at the end of sample `k`, from 1.
    pub fn due(&self, k: u64) -> bool {
        self.0.iter().any(|measured| k.is_multiple_of(measured.aid.stride))
    }

    /// Measures what is due at the end of sample `k`, at the time `t` (s), or its phase later but not after `end` (s).
    pub fn measure(&mut self, k: u64, t: f64, moment: &Moment, end: f64, later: impl Fn(f64) -> Moment) {
        for Measured { kind, aid, draws, table } in &mut self.0 {
            let moved;
            let (t, moment) = match aid.phase {
                0.0 => (t, moment),
                phase if t + phase > end || !k.is_multiple_of(aid.stride) => continue,
                phase => {
                    moved = later(t + phase);
                    (t + phase, &moved)
                }
            };
            let out = aid.outages.iter().any(|[begin, end]| (*begin..*end).contains(&t));
            if !k.is_multiple_of(aid.stride) || out {
                continue;
            }
            let normals = draws.normals(k);
            let t = t - aid.offset;
            let noise: Vec3<T> = Vec3::claim([0, 1, 2].map(|axis| aid.sigma[axis] * normals[axis]));
            let [sigma_n, sigma_e, sigma_d] = aid.sigma;
            let numbers = |numbers: &[f64]| numbers.iter().map(|x| Cell::Number(*x)).collect::<Vec<_>>();
            let antenna = || position(&moment.pva, aid.lever_arm, noise);
            table.push(&match kind {
                Kind::Position => {
                    let Geodetic { lat, lon, h } = antenna();
                    numbers(&[t, lat, lon, h, sigma_n, sigma_e, sigma_d])
                }
                Kind::Velocity => {
                    let [n, e, d] = (velocity(moment, aid.lever_arm) + noise).as_array();
                    numbers(&[t, n, e, d, sigma_n, sigma_e, sigma_d])
                }
                Kind::Height => numbers(&[t, antenna().h, sigma_d]),
                Kind::Heading => {
                    let yaw = moment.pva.c_tb.as_euler().yaw + noise[0];
                    numbers(&[t, yaw, sigma_n])
                }
            });
        }
    }

    /// What was measured.
    pub fn tables(self) -> impl Iterator<Item = Table> {
        self.0.into_iter().map(|measured| measured.table)
    }
}

/// Position of the antenna at `arm` (m, body axes), moved by `noise` (m, north-east-down).
pub(crate) fn position(pva: &Pva, arm: [f64; 3], noise: Vec3<T>) -> Geodetic {
    let offset = pva.c_tb * Vec3::claim(arm) + noise;
    Geodetic::from_ecef(pva.position.ecef_of_local(offset))
}

/// Velocity of the antenna: that of the IMU and omega_eb × arm.
pub(crate) fn velocity(moment: &Moment, arm: [f64; 3]) -> Vec3<T> {
    let Pva { v_t, c_tb, .. } = moment.pva;
    v_t + c_tb * moment.omega_eb_b.cross(Vec3::claim(arm))
}
