//! A rocking base: sums of sines about a place and an attitude.

use schuler_frames::{E, Euler, Geodetic, Rot, T, Vec3};

use super::{Jet, Kinematics, Place, Stance, Trajectory};

/// `amplitude sin(omega t + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine {
    /// Amplitude, rad or m.
    pub amplitude: f64,
    /// Angular frequency, rad/s.
    pub omega: f64,
    /// Phase, rad.
    pub phase: f64,
}

/// What sways, axis by axis; each a sum, and empty for what keeps still.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SwayAxes {
    /// About the attitude of the start, rad.
    pub roll: Vec<Sine>,
    /// About the attitude of the start, rad.
    pub pitch: Vec<Sine>,
    /// About the attitude of the start, rad.
    pub yaw: Vec<Sine>,
    /// North of the start, in its tangent plane, m.
    pub n: Vec<Sine>,
    /// East of the start, m.
    pub e: Vec<Sine>,
    /// Down from the start, m.
    pub d: Vec<Sine>,
}

impl SwayAxes {
    fn all(&self) -> [&[Sine]; 6] {
        [&self.roll, &self.pitch, &self.yaw, &self.n, &self.e, &self.d]
    }

    /// The largest angular frequency, rad/s. An attitude that swings by a radian turns what is resolved in it that much
    /// faster.
    pub(super) fn fastest(&self) -> f64 {
        let highest = self.all().into_iter().flatten().map(|sine| sine.omega.abs()).fold(0.0, f64::max);
        let swing: f64 = self.all()[..3].iter().copied().flatten().map(|sine| sine.amplitude.abs()).sum();
        highest * (1.0 + swing)
    }
}

/// A base that rocks about a place and an attitude: a ship at its moorings, an aircraft in gusts.
#[derive(Clone, Debug, PartialEq)]
pub struct Sway {
    position: Geodetic,
    r_e: Vec3<E>,
    c_et: Rot<E, T>,
    attitude: Euler,
    axes: SwayAxes,
    moves: bool,
    fastest: f64,
}

impl Sway {
    /// About `position` and `attitude`.
    pub fn new(position: Geodetic, attitude: Euler, axes: SwayAxes) -> Self {
        Sway {
            position,
            r_e: position.as_ecef(),
            c_et: position.c_et(),
            attitude,
            moves: [&axes.n, &axes.e, &axes.d].iter().any(|list| !list.is_empty()),
            fastest: axes.fastest(),
            axes,
        }
    }
}

/// Sum of the sines at the time `t`.
pub(super) fn sum(sines: &[Sine], t: f64) -> Jet {
    sines.iter().fold(Jet::constant(0.0), |sum, sine| {
        let (s, c) = libm::sincos(sine.omega * t + sine.phase);
        let (a, w) = (sine.amplitude, sine.omega);
        sum + Jet([a * s, a * w * c, -0.5 * a * w * w * s])
    })
}

impl Trajectory for Sway {
    fn at(&self, t: f64) -> Kinematics {
        let place = if self.moves {
            let ned = [&self.axes.n, &self.axes.e, &self.axes.d].map(|sines| sum(sines, t));
            let [r, v, a] = [0, 1, 2].map(|k| self.c_et * Vec3::<T>::claim(ned.map(|jet| jet.0[k])));
            let r = self.r_e + r;
            Place::from_ecef([0, 1, 2].map(|axis| Jet([r[axis], v[axis], a[axis]])))
        } else {
            Place::still(self.position)
        };
        let Euler { roll, pitch, yaw } = self.attitude;
        let stance = Stance::from_euler(
            sum(&self.axes.roll, t) + roll,
            sum(&self.axes.pitch, t) + pitch,
            sum(&self.axes.yaw, t) + yaw,
        );
        Kinematics::new(place, stance)
    }

    fn fastest(&self, _: f64) -> f64 {
        self.fastest
    }
}
