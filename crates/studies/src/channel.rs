//! The vertical channel of a scenario as the mechanization takes it.

use schuler_frames::Geodetic;
use schuler_strapdown::{BaroLoop, Vertical};

use crate::scenario::{self, Mechanization};

/// The vertical channel at a place: a damped one is slaved to the height there, and its loop overcomes the
/// instability -dg/dh of the place first.
pub fn vertical(mechanization: &Mechanization, position: Geodetic) -> Vertical {
    let instability = -mechanization.gravity.gradient_t(position).1[2];
    match mechanization.vertical {
        scenario::Vertical::Held => Vertical::Held,
        scenario::Vertical::Free => Vertical::Free,
        scenario::Vertical::Damped(d) if d.order == 2 => {
            Vertical::Damped(BaroLoop::second_order(d.tau, instability, position.h))
        }
        scenario::Vertical::Damped(d) => {
            Vertical::Damped(BaroLoop::third_order(d.tau, instability, position.h))
        }
    }
}
