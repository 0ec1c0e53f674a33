//! Nothing is allocated: not while a sensor is made, stepped, saved, restored or read out.

use allocation_counter::measure;
use schuler_imu::readout::{Bandwidth, Channel, Faults, Lsb, Timing};
use schuler_imu::{Imu, Readout, Sample, Spec, Stream, Truth, preset};

use super::examples::{on_bias, processes};

#[test]
fn nothing_is_allocated() {
    let names: Vec<_> = processes().collect();
    let counted = measure(|| {
        let mut spec = Spec::new();
        for (_, process) in &names {
            spec.push(on_bias(*process)).unwrap();
        }
        let channel = Channel {
            bandwidth: Some(Bandwidth { natural_frequency: 20.0, damping: 0.7 }),
            timing: Timing { delay: 0.01, jitter: 0.001 },
            range: Some([(-10.0, 10.0); 3]),
            lsb: Some(Lsb { size: [1e-4; 3], carry: true }),
            faults: Faults { drop: 0.1, ..Faults::default() },
            ..Channel::default()
        };
        spec.readout = Some(Readout { gyro: channel, accel: channel });
        let mut imu = Imu::new(&spec, Stream::default()).unwrap();
        let truth = Truth::rates([0.1; 3], [9.8; 3]);
        let mut samples = [Sample::default(); 8];
        let saved = imu.save();
        for k in 0..20 {
            imu.steps(0.01 * f64::from(1 + k % 3), &[truth; 8], &mut samples);
            assert!(imu.ledger().count() > 0);
        }
        imu.restore(&saved).unwrap();
        imu.restart(Stream { seed: 1, run: 1 });
        let stim300 = preset::preset("stim300").unwrap().spec().unwrap();
        assert!(stim300.component("gyro.bias.white.x").is_some());
    });
    assert_eq!(counted.count_total, 0, "{counted:?}");
}
