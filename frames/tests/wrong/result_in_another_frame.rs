//! What c_tb makes of a vector of b is resolved in t, not in e.
use schuler_frames::{B, E, Rot, T, Vec3};

fn main() {
    let c_tb: Rot<T, B> = Rot::IDENTITY;
    let _: Vec3<E> = c_tb * Vec3::<B>::ZERO;
}
