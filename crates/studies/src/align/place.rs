//! Where the base is, as all methods know it.

use schuler_frames::{Geodetic, Gravity};
use schuler_strapdown::Vertical;

/// Place, gravity and what is done about the vertical channel.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub position: Geodetic,
    pub gravity: Gravity,
    pub vertical: Vertical,
}
