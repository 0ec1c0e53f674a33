//! The error-state filter.
//!
//! - [`Model`]: what the states are. Chosen navigation errors, then the states of any list of error sources
//!   ([`schuler_imu::Spec`]), then states of measurements.
//! - [`Propagation`]: transition and process noise over an interval, [exact](Propagation::exact) where nothing changes,
//!   or gathered over several IMU steps by an [`Accumulator`].
//! - [`Measurement`]: what is compared with the navigator; [`Observation`] is what the filter sees of it.
//! - [`Filter`]: estimates and covariance; time update, measurement update, gate, feedback.
//! - [`Dual`]: covariance of the true errors where truth has another list of sources than the filter.
//! - [`Observability`]: what measurements can tell and what they never will; [`smooth`]: estimates from all measurements.
//! - [`strategy`]: fading and adaptive forms, which plug into the same filter.
//!
//! Everything is in SI units; errors are computed minus true, sensor errors measured minus true.
//!
//! ```
//! use schuler_frames::{Geodetic, Gravity, Rot, Vec3};
//! use schuler_imu::{Instrument::{Accel, Gyro}, Source, Spec, Truth};
//! use schuler_strapdown::filter::{Filter, Form, Model, NavStates, Now, Propagation, ZeroVelocity};
//! use schuler_strapdown::{ErrorDynamics, Pva, Vertical};
//!
//! // A level body at rest that looks north, its sensors with white noise and constant biases.
//! let place = Geodetic::new(0.8, 0.0, 0.0);
//! let pva = Pva { position: place, v_t: Vec3::ZERO, c_tb: Rot::IDENTITY };
//! let f_b = Vec3::claim((-Gravity::Somigliana.gravity_t(place)).as_array());
//! let spec = Spec::from_sources([
//!     Source::named(Gyro, "bias", "white", &[("density", 8.7e-7.into())])?,
//!     Source::named(Gyro, "bias", "constant", &[("sigma", 4.8e-8.into())])?,
//!     Source::named(Accel, "bias", "constant", &[("sigma", 4.9e-4.into())])?,
//! ])?;
//! let model = Model::<16>::new(Form::Phi, NavStates::LEVEL, &spec)?;
//!
//! // Aligned for ten minutes by zero velocity, once a second.
//! let dynamics = ErrorDynamics { gravity: Gravity::Somigliana, vertical: Vertical::Held };
//! let seen = Truth::rates([5.08e-5, 0.0, -5.23e-5], f_b.as_array());
//! let second = Propagation::exact(&model, &dynamics.system(&pva, f_b), &seen, 1.0);
//! let mut filter = Filter::new(model, &[0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.02, 0.02, 0.1])?;
//! for _ in 0..600 {
//!     filter.propagate(&second);
//!     filter.update(&ZeroVelocity::new(0.01), &Now::at(&pva))?;
//! }
//! assert!(filter.sigma(4) < 2e-3); // heading, rad
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```

mod accumulate;
mod block;
mod body;
pub mod chi_square;
mod close;
mod dual;
mod error;
mod estimator;
mod exact;
mod gate;
mod gather;
pub mod measurement;
mod model;
mod observability;
mod observation;
mod padded;
mod propagation;
mod reset;
mod row;
mod scalar_update;
mod slow;
mod small;
mod small_process;
mod smoother;
mod states;
pub mod strategy;
mod transport;
mod waiting;
#[cfg(test)]
mod widths;

pub use accumulate::Accumulator;
pub use dual::Dual;
pub use error::FilterError;
pub use estimator::{Filter, Outcome, Tally};
pub use gate::Gate;
pub use measurement::{
    Attitude, Heading, Height, IntegratedVelocity, Measurement, NonHolonomic, Position, Velocity, ZeroRate,
    ZeroVelocity,
};
pub use model::Model;
pub use observability::{Observability, limit_covariance};
pub use observation::{MAX_EXTRA, Now, Observation};
pub use propagation::Propagation;
pub use reset::{attitude_reset, corrected};
pub use row::Row;
pub use smoother::{Record, smooth};
pub use states::{Form, NavState, NavStates};
