use core::fmt::{self, Write};

use super::{Level, STEPS, fill_normals, philox4x32_10};

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
pub(crate) struct Key(pub [u32; 2]);

impl Stream {
    /// A key for the run, itself drawn with the seed as key, so that all 64 bits of seed and run count.
    pub(crate) fn key(self) -> Key {
        let [a, b, _, _] =
            philox4x32_10([low(self.run), high(self.run), 0, 0], [low(self.seed), high(self.seed)]);
        Key([a, b])
    }
}

impl Key {
    /// The first two standard normals of `address`, for what is drawn once per run.
    pub(crate) fn start(self, level: Level, address: Address) -> [f64; 2] {
        let mut normals = [[0.0; STEPS]; 4];
        fill_normals(level, self.0, 0, &[address.0; 4], &mut normals);
        [normals[0][0], normals[0][1]]
    }
}

/// Where in the specification a draw belongs: a hash of the component's name and of the use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Address(pub u64);

impl Address {
    /// Of draw number `draw` of part `part` of the component called `name`.
    pub(crate) fn new(name: &dyn fmt::Display, part: usize, draw: usize) -> Address {
        let mut hash = Fnv::new();
        write!(hash, "{name}/{part}/{draw}").expect("invariant: hashing accepts every text");
        Address(hash.0)
    }
}

/// FNV-1a, 64 bits.
pub(crate) struct Fnv(pub u64);

impl Fnv {
    pub(crate) const fn new() -> Fnv {
        Fnv(0xcbf2_9ce4_8422_2325)
    }
}

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
