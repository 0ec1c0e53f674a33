//! omega_tb and omega_ie have no frame between them: omega_et is missing.
use schuler_frames::{B, E, I, Rate, T, Vec3};

fn main() {
    let omega_tb = Rate::<B, T, T>::claim(Vec3::ZERO);
    let omega_ie = Rate::<E, I, T>::claim(Vec3::ZERO);
    let _ = omega_tb + omega_ie;
}
