//! Equal seeds give equal bits: in debug and release, one by one or in batches, in lanes of every width, on
//! every machine, in every version until the changelog says "value-breaking". The digest below was printed by
//! this crate and proves nothing else.

use schuler_imu::{Imu, Instrument, Sample, Source, Spec, Stream, TERMS, Truth, process_kind};

use super::examples::{on_bias, process, processes};
use super::philox::levels;

/// Every process, and every term with a constant.
fn spec() -> Spec {
    let mut spec = Spec::from_sources(processes().map(|(_, p)| on_bias(p))).unwrap();
    let constant = process_kind("constant").unwrap();
    for instrument in Instrument::ALL {
        for term in TERMS.iter().filter(|t| t.instruments().contains(&instrument)) {
            let p = process(constant, constant.forms()[1]);
            spec.push(Source::new(instrument, *term, p).unwrap()).unwrap();
        }
    }
    spec
}

#[test]
fn samples_keep_their_bits() {
    let spec = spec();
    for level in levels() {
        let mut digest = 0xcbf2_9ce4_8422_2325_u64;
        for run in 0..3 {
            let mut imu = Imu::new(&spec, Stream { seed: 2026, run }).unwrap();
            imu.set_level(level);
            for (k, dt) in [0.01, 0.01, 0.5].into_iter().enumerate() {
                let truths = [(); 100].map(|()| {
                    Truth::rates([0.1, k as f64, -0.3], [9.8, 0.0, 1.0])
                        .with_omega_dot([0.2, -0.1, 0.3])
                        .with_temperature(300.0, 0.01)
                        .with_vibration([1.0, 2.0, 3.0])
                });
                let mut samples = [Sample::default(); 100];
                imu.steps(dt, &truths, &mut samples);
                for x in samples.iter().flat_map(|s| s.dtheta.into_iter().chain(s.dv)) {
                    for byte in x.to_bits().to_le_bytes() {
                        digest = (digest ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
                    }
                }
            }
        }
        assert_eq!(digest, 0x3aa4_7961_3322_59c5, "{level:?}: digest {digest:#018x}");
    }
}
