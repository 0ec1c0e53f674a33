use core::fmt::{self, Write};

use super::{normals, philox4x32_10};

/// Which run of which experiment: with the scenario, this determines every random number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Stream {
    /// Master seed of the experiment.
    pub seed: u64,
    /// Number of the run.
    pub run: u64,
}

/// Philox key of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Key([u32; 2]);

impl Stream {
    /// A key for the run, itself drawn with the seed as key, so that all 64 bits of seed and run count.
    pub(crate) fn key(self) -> Key {
        let [a, b, _, _] =
            philox4x32_10([low(self.run), high(self.run), 0, 0], [low(self.seed), high(self.seed)]);
        Key([a, b])
    }
}

impl Key {
    /// The standard normal of `address` at `step`: a pure function of seed, run, address and step.
    #[inline]
    pub(crate) fn normal(self, address: Address, step: u64) -> f64 {
        let block = step >> 2;
        let words = philox4x32_10([low(block), high(block), low(address.0), high(address.0)], self.0);
        normals(words)[(step & 3) as usize]
    }
}

/// Where in the specification a draw belongs: a hash of the component's name and of the use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Address(u64);

impl Address {
    /// Of draw number `draw` of part `part` of the component called `name`.
    pub(crate) fn new(name: &dyn fmt::Display, part: usize, draw: usize) -> Address {
        let mut hash = Fnv(0xcbf2_9ce4_8422_2325);
        write!(hash, "{name}/{part}/{draw}").expect("invariant: hashing accepts every text");
        Address(hash.0)
    }
}

/// FNV-1a, 64 bits.
struct Fnv(u64);

impl Write for Fnv {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        for byte in s.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        Ok(())
    }
}

const fn low(x: u64) -> u32 {
    x as u32
}

const fn high(x: u64) -> u32 {
    (x >> 32) as u32
}
