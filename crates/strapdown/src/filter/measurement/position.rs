//! Position and height.

use nalgebra::Matrix3;
use schuler_frames::{B, Geodetic, T, Vec3, position_error, with_position_error};

use super::{ALL, Axes, Measurement};
use crate::filter::{Now, Observation};

/// Position of a point of the body, an antenna say: `z = dr + [(C l) ×] phi`, metres north, east and down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// What was measured.
    pub position: Geodetic,
    /// Standard deviation of its noise north, east and down, m.
    pub sigma: [f64; 3],
    /// Where in the body the point is, m.
    pub lever: Vec3<B>,
    /// Axes that are used.
    pub axes: Axes,
}

impl Measurement for Position {
    fn observe(&self, now: &Now) -> Observation {
        let lever = now.pva.c_tb * self.lever;
        let computed = with_position_error(now.pva.position, lever);
        let z = position_error(computed, self.position);
        Observation::new(3, z.as_array(), self.sigma)
            .with_block(0, Matrix3::identity())
            .with_block(6, lever.skew())
            .select(self.axes)
    }
}

/// Ellipsoidal height of a point of the body: one row, in metres **down** as the position error is,
/// `z = (measured - computed) = dr_D + ([(C l) ×] phi)_D`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Height {
    /// What was measured, m.
    pub h: f64,
    /// Standard deviation of its noise, m.
    pub sigma: f64,
    /// Where in the body the point is, m.
    pub lever: Vec3<B>,
}

impl Measurement for Height {
    fn observe(&self, now: &Now) -> Observation {
        let position = Geodetic { h: self.h, ..now.pva.position };
        let axes = [false, false, true];
        Position { position, sigma: [self.sigma; 3], lever: self.lever, axes }.observe(now)
    }
}

/// Integral of the velocity computed since the start, at a base that has stayed where it was: the measurement of an
/// alignment by position. `z` is that integral, and the filter's position errors are its error: `z = dr`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratedVelocity {
    /// Integral of the computed velocity, m.
    pub integral: Vec3<T>,
    /// Standard deviation of the base's own way, m.
    pub sigma: f64,
    /// Axes that are used.
    pub axes: Axes,
}

impl IntegratedVelocity {
    /// All three axes.
    pub const fn new(integral: Vec3<T>, sigma: f64) -> Self {
        IntegratedVelocity { integral, sigma, axes: ALL }
    }
}

impl Measurement for IntegratedVelocity {
    fn observe(&self, _: &Now) -> Observation {
        Observation::new(3, self.integral.as_array(), [self.sigma; 3])
            .with_block(0, Matrix3::identity())
            .select(self.axes)
    }
}
