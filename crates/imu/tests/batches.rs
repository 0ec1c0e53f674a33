//! Many samples at once are the samples one by one, to the last bit.

use schuler_imu::readout::{Bandwidth, Channel, Faults, Lsb, Timing};
use schuler_imu::{
    Imu, Instrument, Octet, Process, Readout, Sample, Source, Spec, Stream, TERMS, Truth, process_kind,
};

use super::examples::{on_bias, processes};

/// Every process on a bias and every term with noise.
fn spec() -> Spec {
    let mut spec = Spec::from_sources(processes().map(|(_, p)| on_bias(p))).unwrap();
    let kind = process_kind("gauss_markov").unwrap();
    let process = Process::new(kind, &[("sigma", 1e-3.into()), ("tau", 2.0.into())]).unwrap();
    for instrument in Instrument::ALL {
        for term in TERMS.iter().filter(|t| t.instruments().contains(&instrument) && t.len() <= 6) {
            spec.push(Source::new(instrument, *term, process).unwrap()).unwrap();
        }
    }
    spec
}

fn readout() -> Readout {
    let gyro = Channel {
        bandwidth: Some(Bandwidth { natural_frequency: 20.0, damping: 0.7 }),
        timing: Timing { delay: 0.013, jitter: 0.001 },
        range: Some([(-30.0, 30.0); 3]),
        lsb: Some(Lsb { size: [1e-4; 3], carry: true }),
        faults: Faults { drop: 0.1, repeat: 0.1, stick: 0.1, stuck_samples: 3 },
        ..Channel::default()
    };
    Readout { gyro, accel: Channel { timing: Timing { delay: 0.005, jitter: 0.0 }, ..gyro } }
}

fn truth(k: usize) -> Truth {
    let x = (k as f64).sin();
    let t = if k.is_multiple_of(3) {
        Truth::increments([0.01 * x, 0.02, -0.03], [0.1, 0.2 * x, 0.3])
    } else {
        Truth::rates([x, 2.0, -3.0 * x], [0.5, -x, 9.8])
    };
    t.with_omega_dot([x, 0.0, 1.0]).with_temperature(300.0 + x, x).with_vibration([1.0, x * x, 0.5])
}

fn bits(samples: &[Sample]) -> Vec<u64> {
    let numbers = samples.iter().flat_map(|s| {
        [s.dtheta, s.dv, s.omega_error, s.f_error].into_iter().flatten().chain([s.dt]).collect::<Vec<f64>>()
    });
    numbers.map(f64::to_bits).collect()
}

/// Chunks of any length, at any place among eight, of changing step; the ledger too.
#[test]
fn a_batch_is_its_samples_one_by_one() {
    for readout in [None, Some(readout())] {
        let mut spec = spec();
        spec.readout = readout;
        let stream = Stream { seed: 3, run: 9 };
        let (mut many, mut one) = (Imu::new(&spec, stream).unwrap(), Imu::new(&spec, stream).unwrap());
        let mut k = 0;
        let chunks = [1, 7, 3, 30, 8, 17, 64, 5, 2, 41, 16, 9, 33, 24, 1, 100, 0, 13];
        let lengths = [0.01, 0.01, 0.01, 0.01, 0.02, 0.01, 0.01, 0.25, 0.25, 0.25, 0.25, 0.25, 0.01];
        for (chunk, dt) in chunks.iter().zip(lengths.iter().cycle()) {
            let truths: Vec<Truth> = (k..k + chunk).map(truth).collect();
            let mut samples = vec![Sample::default(); *chunk];
            many.steps(*dt, &truths, &mut samples);
            let single: Vec<Sample> = truths.iter().map(|t| one.step(*dt, t)).collect();
            assert_eq!(bits(&samples), bits(&single), "{chunk} samples from {k} on");
            assert_eq!(samples, single);
            assert_eq!(many.save(), one.save());
            assert!(many.ledger().eq(one.ledger()));
            assert_eq!(many.readout_errors(), one.readout_errors());
            k += chunk;
        }
    }
}

/// Eight intervals worked out once are the same samples, however often they come: of increments, rates, both mixed; for instruments calibrated otherwise, with a
/// readout, and in the middle of eight steps.
#[test]
fn octets_shared_by_instruments_are_the_samples() {
    let motions: [fn(usize) -> Truth; 3] = [
        |k| Truth { motion: truth(3).motion, ..truth(k) },
        |k| Truth { motion: truth(1).motion, ..truth(k) },
        truth,
    ];
    for (readout, skipped) in [(None, 0), (None, 3), (Some(readout()), 0)] {
        let mut spec = spec();
        spec.readout = readout;
        let stream = Stream { seed: 3, run: 9 };
        let (mut many, mut one) = (Imu::new(&spec, stream).unwrap(), Imu::new(&spec, stream).unwrap());
        for imu in [&mut many, &mut one] {
            (0..skipped).for_each(|k| {
                imu.step(0.01, &truth(k));
            });
        }
        for k in 0..30 {
            let dt = if k == 20 { 0.0 } else { 0.01 };
            let calibration = spec.calibration_temperature + if k % 5 == 4 { 1.0 } else { 0.0 };
            let octet = Octet::new(std::array::from_fn(|row| motions[k % 3](8 * k + row)), dt, calibration);
            let mut increments = [[[[0.0; 8]; 3]; 2]; 3];
            let times = 1 + k % 4 % 3;
            many.octets(&octet, &mut increments[..times]);
            for increments in &increments[..times] {
                for (row, truth) in octet.truths().iter().enumerate() {
                    let sample = one.step(dt, truth);
                    let found = increments.map(|axes| axes.map(|axis| axis[row].to_bits()));
                    assert_eq!(found, [sample.dtheta, sample.dv].map(|x| x.map(f64::to_bits)), "{k}, {row}");
                }
            }
            assert_eq!(many.save(), one.save());
            assert!(many.ledger().eq(one.ledger()));
        }
    }
}
