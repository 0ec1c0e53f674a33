//! Where the base is, as all methods know it.

use schuler_frames::{Geodetic, Gravity};
use schuler_strapdown::{Coning, Vertical};

/// Place, gravity, and how to navigate there.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub position: Geodetic,
    pub gravity: Gravity,
    pub vertical: Vertical,
    pub coning: Coning,
}
