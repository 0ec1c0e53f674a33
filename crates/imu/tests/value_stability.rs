//! Equal seeds give equal bits: in debug and release, on every machine, in every version until the
//! changelog says "value-breaking". The digest below was printed by this crate and proves nothing else.

use schuler_imu::{Imu, Spec, Stream, Truth};

use super::examples::{on_bias, processes};

#[test]
fn samples_keep_their_bits() {
    let spec = Spec::from_sources(processes().map(|(_, p)| on_bias(p))).unwrap();
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for run in 0..3 {
        let mut imu = Imu::new(&spec, Stream { seed: 2026, run }).unwrap();
        for k in 0..300_u32 {
            let truth = Truth::rates([0.1, f64::from(k), -0.3], [9.8, 0.0, 1.0]);
            let sample = imu.step(if k < 200 { 0.01 } else { 0.5 }, &truth);
            for byte in sample.dtheta.iter().chain(&sample.dv).flat_map(|x| x.to_bits().to_le_bytes()) {
                digest = (digest ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
            }
        }
    }
    assert_eq!(digest, 0x7d85_c23b_ad98_ff67, "digest {digest:#018x}");
}
