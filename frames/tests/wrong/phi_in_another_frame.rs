//! phi of two rotations b to t is resolved in t, not in b.
use schuler_frames::{B, Rot, T, Vec3, phi_between};

fn main() {
    let _: Vec3<B> = phi_between(Rot::<T, B>::IDENTITY, Rot::<T, B>::IDENTITY);
}
