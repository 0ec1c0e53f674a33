//! Closed forms for a navigator at rest on the ellipsoid, height held.
//!
//! [`exact`] is the solution of the full linear error equations (Schuler, Foucault and Earth rates
//! on the ellipsoid); [`single_axis`] is what textbooks print, one horizontal axis at a time.

mod exact;
mod modal;
mod single_axis;
mod site;

pub use exact::exact;
pub use modal::{ModalSum, Rates};
pub use single_axis::single_axis;
pub use site::Site;

use schuler_frames::{T, Vec3};

/// What drives the errors: initial errors, and sensor errors that are constant or grow as a ramp.
///
/// All are computed minus true or measured minus true, resolved in t. The vertical parts of `dv0`,
/// `nabla` and `nabla_rate` do nothing, because the vertical channel is held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drivers {
    /// Initial attitude error phi, rad: `C_computed = exp(-[phi ×]) C_true`.
    pub phi0: Vec3<T>,
    /// Initial velocity error, m/s.
    pub dv0: Vec3<T>,
    /// Initial latitude error, rad.
    pub dlat0: f64,
    /// Initial longitude error, rad.
    pub dlon0: f64,
    /// Gyro error, rad/s.
    pub eps: Vec3<T>,
    /// Accelerometer error, m/s².
    pub nabla: Vec3<T>,
    /// Growth of the gyro error, rad/s².
    pub eps_rate: Vec3<T>,
    /// Growth of the accelerometer error, m/s³.
    pub nabla_rate: Vec3<T>,
}

/// The errors that [`Drivers`] cause, as functions of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Rates of the oscillations, rad/s, shared by all channels.
    pub rates: Rates,
    /// Position error north and east, m (`dlat * R_M`, `dlon * R_N cos L`).
    pub position: [ModalSum; 2],
    /// Attitude error north, east and down, rad.
    pub phi: [ModalSum; 3],
}

/// The errors at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Position error, m; the down part is zero.
    pub dr: Vec3<T>,
    /// Velocity error, m/s; the down part is zero.
    pub dv: Vec3<T>,
    /// Attitude error phi, rad.
    pub phi: Vec3<T>,
}

impl Response {
    /// The errors at time `t` (s).
    pub fn at(&self, t: f64) -> Errors {
        let w = &self.rates;
        let [x, y] = &self.position;
        let [n, e, d] = &self.phi;
        Errors {
            dr: Vec3::new(x.at(w, t), y.at(w, t), 0.0),
            dv: Vec3::new(x.derivative(w).at(w, t), y.derivative(w).at(w, t), 0.0),
            phi: Vec3::new(n.at(w, t), e.at(w, t), d.at(w, t)),
        }
    }

    /// The answer to drivers that are the integral over time of those that gave `self`.
    fn integral(&self) -> Self {
        let w = &self.rates;
        Response {
            rates: *w,
            position: self.position.map(|channel| channel.integral(w)),
            phi: self.phi.map(|channel| channel.integral(w)),
        }
    }

    fn sum(&self, other: &Self) -> Self {
        let mut sum = *self;
        for (channel, more) in sum.position.iter_mut().zip(&other.position) {
            *channel = channel.plus(1.0, more);
        }
        for (channel, more) in sum.phi.iter_mut().zip(&other.phi) {
            *channel = channel.plus(1.0, more);
        }
        sum
    }
}
