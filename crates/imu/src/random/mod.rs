//! Random numbers as pure functions of their address.

mod normal;
mod philox;
mod stream;

pub use normal::normals;
pub use philox::philox4x32_10;
pub use stream::Stream;
pub(crate) use stream::{Address, Key};
