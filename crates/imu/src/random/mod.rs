//! Random numbers as pure functions of their address.

mod draws;
mod lanes;
mod philox;
mod stream;

pub use draws::Draws;
pub use fearless_simd::Level;
pub(crate) use lanes::{Drawn, OCTETS, fill_drawn};
pub use lanes::{STEPS, best_level, fill_normals};
pub use philox::philox4x32_10;
pub use stream::Stream;
pub(crate) use stream::{Address, Fnv, Key};
