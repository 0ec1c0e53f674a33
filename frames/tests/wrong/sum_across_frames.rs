//! Vectors of two frames have no sum.
use schuler_frames::{B, T, Vec3};

fn main() {
    let _ = Vec3::<T>::ZERO + Vec3::<B>::ZERO;
}
