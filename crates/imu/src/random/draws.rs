//! Random numbers beside the sensors.

use core::fmt::Display;

use super::{Address, Level, STEPS, Stream, best_level, fill_normals};

/// Standard normals for whatever is random in a run beside an [`Imu`](crate::Imu): noise of other measurements, errors at the start.
///
/// Like those of a sensor they are a pure function of (seed, run, name, number): what is drawn under one name does not
/// depend on what else is drawn.
///
/// ```
/// use schuler_imu::{Stream, random::Draws};
/// let noise = Draws::new(Stream { seed: 1, run: 7 }, &"velocity");
/// assert_eq!(noise.normals(3), Draws::new(Stream { seed: 1, run: 7 }, &"velocity").normals(3));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Draws {
    level: Level,
    key: [u32; 2],
    address: u64,
}

impl Draws {
    /// Those of `name` in the run `stream`.
    pub fn new(stream: Stream, name: &dyn Display) -> Draws {
        let address = Address::new(&format_args!("draws.{name}"), 0, 0);
        Draws { level: best_level(), key: stream.key().0, address: address.0 }
    }

    /// Four independent standard normals for the number `step`.
    pub fn normals(&self, step: u64) -> [f64; 4] {
        let mut out = [[0.0; STEPS]; 4];
        fill_normals(self.level, self.key, step / 2, &[self.address; 4], &mut out);
        // The block of words of this number is the first or the second half.
        let [[a, b, c, d, e, f, g, h], ..] = out;
        if step.is_multiple_of(2) { [a, b, c, d] } else { [e, f, g, h] }
    }
}
