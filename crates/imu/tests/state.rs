//! Saved states: bit for bit, refused where they do not belong, and as text.

use schuler_imu::readout::{Bandwidth, Channel, Faults, Lsb, Timing};
use schuler_imu::{Error, Imu, Readout, Sample, Spec, Stream, Truth};

use super::examples::{on_bias, processes};

/// Every process, and a readout with everything that has a memory.
fn spec() -> Spec {
    let mut spec = Spec::from_sources(processes().map(|(_, p)| on_bias(p))).unwrap();
    let gyro = Channel {
        bandwidth: Some(Bandwidth { natural_frequency: 20.0, damping: 0.7 }),
        timing: Timing { delay: 0.013, jitter: 0.001 },
        lsb: Some(Lsb { size: [1e-4; 3], carry: true }),
        faults: Faults { drop: 0.1, repeat: 0.1, stick: 0.1, stuck_samples: 3 },
        ..Channel::default()
    };
    spec.readout = Some(Readout { gyro, accel: Channel::default() });
    spec
}

fn run(imu: &mut Imu) -> Vec<Sample> {
    (0..40)
        .map(|k| imu.step(0.01 * f64::from(1 + k / 10), &Truth::rates([f64::from(k), 1.0, 2.0], [0.0; 3])))
        .collect()
}

#[test]
fn a_restored_state_repeats_bit_for_bit() {
    let mut imu = Imu::new(&spec(), Stream { seed: 1, run: 2 }).unwrap();
    run(&mut imu);
    let saved = imu.save();
    let first = run(&mut imu);
    imu.restore(&saved).unwrap();
    assert_eq!(run(&mut imu), first);
    // In another sensor of the same specification and run, at the same place of the block of draws or not.
    let mut other = Imu::new(&spec(), Stream { seed: 1, run: 2 }).unwrap();
    other.restore(&saved).unwrap();
    assert_eq!(run(&mut other), first);
    assert_eq!(saved.step(), 40);
}

#[test]
fn a_state_of_another_sensor_is_refused() {
    let imu = Imu::new(&spec(), Stream::default()).unwrap();
    let mut perfect = Imu::new(&Spec::new(), Stream::default()).unwrap();
    assert!(matches!(perfect.restore(&imu.save()), Err(Error::ForeignState { .. })));
}

#[test]
fn a_restarted_imu_is_a_new_one() {
    let (spec, stream) = (spec(), Stream { seed: 7, run: 8 });
    let mut imu = Imu::new(&spec, Stream::default()).unwrap();
    run(&mut imu);
    imu.restart(stream);
    assert_eq!(run(&mut imu), run(&mut Imu::new(&spec, stream).unwrap()));
}

#[cfg(feature = "serde")]
#[test]
fn a_state_survives_text() {
    let mut imu = Imu::new(&spec(), Stream { seed: 1, run: 2 }).unwrap();
    run(&mut imu);
    let text = serde_json::to_string(&imu.save()).unwrap();
    let state: schuler_imu::State = serde_json::from_str(&text).unwrap();
    assert_eq!(state, imu.save());
    let first = run(&mut imu);
    imu.restore(&state).unwrap();
    assert_eq!(run(&mut imu), first);
    let foreign = text.replace("\"version\":2", "\"version\":1");
    let error = serde_json::from_str::<schuler_imu::State>(&foreign).unwrap_err().to_string();
    assert!(error.contains("version 1, but 2 is needed"), "{error}");
}
