//! omega_ib - omega_ie is omega_eb turned round: the rate of b with respect to e, not of t.
use schuler_frames::{B, E, I, Rate, T, Vec3};

fn main() {
    let omega_ib = Rate::<B, I, B>::claim(Vec3::ZERO);
    let omega_ie = Rate::<E, I, B>::claim(Vec3::ZERO);
    let _: Rate<B, T, B> = omega_ib - omega_ie;
}
