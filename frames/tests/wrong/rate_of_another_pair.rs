//! omega_et + omega_ie is omega_it, not omega_ib.
use schuler_frames::{B, E, I, Rate, T, Vec3};

fn main() {
    let omega_et = Rate::<T, E, T>::claim(Vec3::ZERO);
    let omega_ie = Rate::<E, I, T>::claim(Vec3::ZERO);
    let _: Rate<B, I, T> = omega_et + omega_ie;
}
