use std::path::Path;

use schuler_imu::{Imu, Motion, Stream, TERMS, Truth, preset};

use super::{Profile, run};
use crate::{
    Context, Record, Scenario, Silent,
    record::Cell,
    scenario::{ImuStudy, Study},
};

fn load(text: &str) -> Scenario {
    Scenario::load("a.yaml", text, &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn study(scenario: &Scenario) -> &ImuStudy {
    match &scenario.study {
        Study::Imu(study) => study,
        _ => panic!("an IMU study"),
    }
}

fn record(text: &str) -> Record {
    let scenario = load(text);
    run(&scenario, study(&scenario), &Context { data: None, progress: &Silent }).expect("runs")
}

/// Mean rate over an interval of 0.05 s.
fn omega(truth: &Truth) -> [f64; 3] {
    match truth.motion {
        Motion::Increments { dtheta, .. } => dtheta.map(|x| x * 20.0),
        Motion::Rates { omega, .. } => omega,
    }
}

fn numbers<'a>(record: &'a Record, column: &str) -> &'a [f64] {
    record.tables.iter().find_map(|table| table.numbers(column)).expect("a column")
}

const AT_REST: &str = "
schuler: 1
study: imu
title: A test
motion: zero_truth
duration: 10 s
output: { formats: [csv] }
";

/// The config that claims to have every term has it, and its motion lets each act: the largest contribution is no
/// less than a thousandth of the largest error.
#[test]
fn the_config_of_every_term_excites_every_term() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs/imu_every_term.yaml");
    let scenario = Scenario::from_file(file, &[]).expect("valid");
    let study = study(&scenario);
    let profile = Profile::new(study);
    let mut imu = Imu::new(&study.imu.spec, Stream { seed: scenario.seed, run: 0 }).expect("an IMU");
    let mut largest = vec![[0.0f64; 2]; TERMS.len()];
    let mut errors = [0.0f64; 2];
    for k in (0..study.samples).step_by(7) {
        let sample = imu.step(1.0 / study.imu.rate, &profile.truth(k));
        for (c, contribution) in imu.ledger() {
            let term = TERMS.iter().position(|t| *t == c.term()).expect("a term");
            let size = contribution.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let largest = &mut largest[term][c.instrument() as usize];
            *largest = largest.max(size);
        }
        for (error, axes) in errors.iter_mut().zip([sample.omega_error, sample.f_error]) {
            *error = axes.iter().fold(*error, |m, x| m.max(x.abs()));
        }
    }
    for (term, largest) in TERMS.iter().zip(largest) {
        for instrument in term.instruments() {
            let i = *instrument as usize;
            assert!(largest[i] > 1e-3 * errors[i], "{} on the {instrument}: {}", term.name(), largest[i]);
        }
    }
}

/// Every preset by its name; its sources come first, those of the file are added.
#[test]
fn presets_and_sources_add() {
    for preset in preset::presets() {
        let imu = format!(
            "imu: {{ preset: {}, rate: 100 Hz, gyro: [{{ bias: {{ white: {{ density: 1 deg/sqrt(h) }} }} }}] }}",
            preset.name
        );
        let scenario = load(&format!("{AT_REST}{imu}"));
        let spec = &study(&scenario).imu.spec;
        let own = preset.spec().expect("valid");
        assert!(spec.sources().zip(own.sources()).all(|(a, b)| a == b), "{}", preset.name);
        assert_eq!(spec.sources().count(), own.sources().count() + 1);
        assert!(spec.sources().last().expect("one").name().to_string().starts_with("gyro.bias.white"));
    }
}

/// A warm-up from 20 to 40 degC with 5 s, calibrated at 30 degC, on 1 deg/h/K: the mean of 10 K - 20 K exp(-t/5 s)
/// over an interval of 0.1 s, by the integral of the exponential.
#[test]
fn a_warm_up_moves_a_thermal_bias() {
    let record = record(&format!(
        "{AT_REST}
imu:
  rate: 10 Hz
  calibration_temperature: 303.15 K
  temperature: {{ warm_up: {{ start: 20 degC, end: 40 °C, tau: 5 s }} }}
  gyro: [{{ thermal: {{ constant: {{ value: 1 deg/h/K }} }} }}]
"
    ));
    let errors = numbers(&record, "domega_y_radps");
    for (k, error) in errors.iter().enumerate() {
        let (a, b) = (0.1 * k as f64, 0.1 * (k + 1) as f64);
        let mean = 10.0 - 20.0 * 5.0 * ((-a / 5.0).exp() - (-b / 5.0).exp()) / 0.1;
        let expected = mean.to_radians() / 3600.0;
        assert!((error - expected).abs() < 1e-15, "{k}: {error} is not {expected}");
    }
    assert_eq!(errors.len(), 100);
}

/// A bias of 3.3 deg/s through a range of 3 deg/s in counts of 0.02 deg: each sample of 0.1 s is 0.3 deg, and flagged.
/// The accelerometers' 0.25 m/s in counts of 0.1 m/s with the remainder carried sum up to within half a count.
#[test]
fn a_readout_shows_in_samples_and_flags() {
    let record = record(&format!(
        "{AT_REST}
imu:
  rate: 10 Hz
  gyro: [{{ bias: {{ constant: {{ value: 3.3 deg/s }} }} }}]
  accel: [{{ bias: {{ constant: {{ value: 2.5 m/s^2 }} }} }}]
  readout:
    gyro: {{ range: 3 deg/s, lsb: {{ size: 0.02 deg }} }}
    accel: {{ lsb: {{ size: 0.1 m/s, carry: true }} }}
"
    ));
    for omega in numbers(&record, "omega_x_radps") {
        assert!((omega - 3f64.to_radians()).abs() < 1e-15);
    }
    assert!(numbers(&record, "gyro_saturated_z_count").iter().all(|flag| *flag == 1.0));
    assert!(numbers(&record, "accel_saturated_z_count").iter().all(|flag| *flag == 0.0));
    let f = numbers(&record, "f_x_mps2");
    assert!(f.iter().all(|f| (f - 2.0).abs() < 1e-12 || (f - 3.0).abs() < 1e-12));
    assert!((f.iter().sum::<f64>() * 0.1 - 25.0).abs() <= 0.05 + 1e-12);
    assert!(record.notes.iter().any(|note| note.contains("gyro: saturated 100, 100, 100")));
}

/// One sample in ten is lost: the share within four deviations of a binomial share of 1000, in the flags and in the
/// samples, which then are zero.
#[test]
fn lost_samples_are_flagged() {
    let record = record(&format!(
        "{AT_REST}
imu:
  rate: 100 Hz
  gyro: [{{ bias: {{ constant: {{ value: 1 deg/s }} }} }}]
  readout: {{ gyro: {{ faults: {{ drop: 10 % }} }} }}
"
    ));
    let dropped = numbers(&record, "gyro_dropped_count");
    let share = dropped.iter().sum::<f64>() / dropped.len() as f64;
    assert!((share - 0.1).abs() < 4.0 * (0.09f64 / 1000.0).sqrt(), "{share}");
    for (flag, omega) in dropped.iter().zip(numbers(&record, "omega_x_radps")) {
        assert_eq!(*flag == 1.0, *omega == 0.0);
    }
}

/// Laws of a table that starts and stops in 2 s of each 10 s: it turns by rate times (10 s - 2 s) and back, its
/// acceleration is 5 deg/s^2 with the sign of the change, and the steps of the rate sum to it.
#[test]
fn a_table_speeds_up_and_slows_down() {
    let scenario = load(
        "
schuler: 1
study: imu
title: Rate table
start: { position: { lat: 50 deg, lon: 0 deg, h: 100 m } }
motion: { rate_table: { rate: 10 deg/s, tilt: 30 deg, acceleration: 5 deg/s^2, vibration: [1 m/s^2, 2 m/s^2, 0 m/s^2] } }
duration: 60 s
imu: { rate: 20 Hz, temperature: { table: [[0 s, 20 degC], [60 s, 80 degC]] } }
",
    );
    let profile = Profile::new(study(&scenario));
    let earth = -7.292115e-5 * 10f64.to_radians().cos();
    for axis in 0..3 {
        let (mut angle, mut before) = ([0.0; 2], 0.0);
        for k in 400 * axis..400 * (axis + 1) {
            let truth = profile.truth(k as u64);
            let omega = omega(&truth);
            let turn = omega[axis] - earth;
            angle[usize::from(k % 400 >= 200)] += turn * 0.05;
            let sign = if k % 400 < 200 { 1.0 } else { -1.0 };
            let expected = match k % 200 {
                0..40 => sign * 5f64.to_radians(),
                40..160 => 0.0,
                _ => -sign * 5f64.to_radians(),
            };
            assert!((truth.omega_dot[axis] - expected).abs() < 1e-12, "{k}");
            if k % 200 != 0 {
                let middle = 0.5 * (truth.omega_dot[axis] + before);
                let last = self::omega(&profile.truth(k as u64 - 1));
                assert!((omega[axis] - last[axis] - 0.05 * middle).abs() < 1e-12, "{k}");
            }
            before = truth.omega_dot[axis];
            assert_eq!(truth.vibration, [1.0, 4.0, 0.0]);
            assert!((truth.temperature - 293.15 - (k as f64 + 0.5) * 0.05).abs() < 1e-10);
        }
        assert!((angle[0] - 80f64.to_radians()).abs() < 1e-12);
        assert!((angle[1] + 80f64.to_radians()).abs() < 1e-12);
    }
}

/// Closed forms of the textbook at 1 s and 4 s, and known ramps that add as they are: R and -R leave nothing, where
/// variances would have added to R tau.
#[test]
fn allan_deviations_of_sources_and_of_their_sum() {
    let record = record(&format!(
        "{}
imu:
  rate: 10 Hz
  accel:
    - bias: {{ white: {{ density: 0.3 m/s/sqrt(s) }} }}
    - bias: {{ ramp: {{ rate: 2 m/s^3 }} }}
    - bias: {{ ramp: {{ rate: -2 m/s^3 }} }}
",
        AT_REST.replace("formats: [csv]", "formats: [csv], allan: true")
    ));
    let table = record.tables.iter().find(|t| t.name == "allan").expect("a table");
    let (times, deviations) =
        (table.numbers("t_s").expect("times"), table.numbers("adev_f_z_mps2").expect("numbers"));
    let source = table.column("source").expect("sources");
    let at = |name: &str, tau: f64| {
        let row = (0..table.len())
            .find(|&row| source.cell(row) == Cell::Word(name) && (times[row] - tau).abs() < 1e-9)
            .unwrap_or_else(|| panic!("{name} at {tau}"));
        deviations[row]
    };
    for (name, tau, expected) in [
        ("accel.bias.white", 1.0, 0.3),
        ("accel.bias.white", 4.0, 0.15),
        ("accel.bias.ramp", 1.0, 2f64.sqrt()),
        ("accel.bias.ramp#2", 4.0, 4.0 * 2f64.sqrt()),
        ("sum", 1.0, 0.3),
        ("sum", 4.0, 0.15),
    ] {
        assert!((at(name, tau) / expected - 1.0).abs() < 1e-12, "{name} at {tau}: {}", at(name, tau));
    }
    assert!(table.numbers("adev_omega_x_radps").expect("numbers").iter().all(|d| *d == 0.0));
    let figures: Vec<&str> = record.figures.iter().map(|(stem, _)| stem.as_str()).collect();
    assert!(figures.contains(&"accel_allan") && !figures.contains(&"gyro_allan"));
}
