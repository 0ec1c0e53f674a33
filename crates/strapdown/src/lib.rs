//! Strapdown mechanization, linear error dynamics and closed forms.
#![no_std]

pub mod align;
mod anchor;
mod cartesian;
mod coning;
mod error_dynamics;
pub mod filter;
mod first_order;
mod increments;
mod kernel;
mod local_level;
mod mechanization;
mod profile;
mod psi;
mod pva;
mod series;
pub mod static_base;
mod transition;
mod vertical;
mod wander;

pub use cartesian::{Cartesian, Centred, EarthFixed, Inertial};
pub use coning::{BodyMotion, Coning, Samples};
pub use error_dynamics::{ErrorDynamics, System};
pub use first_order::FirstOrder;
pub use increments::Increments;
pub use local_level::{Eight, LANES, LocalLevel, LocalLevelLanes};
pub use mechanization::Mechanization;
pub use psi::PsiMap;
pub use pva::{NavError, Pva};
pub use transition::Transition;
pub use vertical::{BaroLoop, Vertical};
pub use wander::WanderAzimuth;
