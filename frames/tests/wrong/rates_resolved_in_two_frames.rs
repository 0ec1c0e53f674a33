//! omega_tb^b and omega_it^t must be resolved in one frame before they add.
use schuler_frames::{B, I, Rate, T, Vec3};

fn main() {
    let omega_tb_b = Rate::<B, T, B>::claim(Vec3::ZERO);
    let omega_it_t = Rate::<T, I, T>::claim(Vec3::ZERO);
    let _ = omega_tb_b + omega_it_t;
}
