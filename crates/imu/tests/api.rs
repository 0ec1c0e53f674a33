//! Specification, injector and ledger as a user meets them.

use schuler_imu::{
    Imu, Instrument, PROCESSES, Process, Source, Spec, Stream, TERMS, Truth, Value, process_kind, term,
};

fn source(instrument: Instrument, t: &str, p: &str, given: &[(&str, Value<'_>)]) -> Source {
    Source::named(instrument, t, p, given).unwrap()
}

fn spec() -> Spec {
    use Instrument::{Accel, Gyro};
    Spec::from_sources([
        source(Gyro, "bias", "constant", &[("value", (&[0.1, 0.2, 0.3]).into())]),
        source(Gyro, "bias", "white", &[("density", 0.01.into())]),
        source(Gyro, "scale_factor", "constant", &[("sigma", 0.5.into())]),
        source(Gyro, "bias", "constant", &[("value", 1.0.into())]),
        source(Accel, "misalignment", "random_walk", &[("density", 0.1.into())]),
        source(Accel, "bias", "gauss_markov", &[("sigma", 0.1.into()), ("tau", 10.0.into())]),
        source(Accel, "quadratic", "ramp", &[("rate", (&[0.0, 1e-3, 0.0]).into())]),
    ])
    .unwrap()
}

const TRUTH: Truth = Truth::rates([1.0, -2.0, 3.0], [4.0, 5.0, -6.0]);

#[test]
fn names_are_unique_and_found_again() {
    let spec = spec();
    let names: Vec<_> = spec.components().map(|c| c.to_string()).collect();
    assert_eq!(names[0], "gyro.bias.constant.x");
    assert_eq!(names[9], "gyro.bias.constant#2.x");
    assert_eq!(names[13], "accel.misalignment.random_walk.xz");
    for name in &names {
        assert_eq!(names.iter().filter(|n| *n == name).count(), 1);
        assert_eq!(spec.component(name).unwrap().to_string(), *name);
    }
    assert!(spec.component("gyro.bias.constant").is_none());
    assert!(spec.component("gyro.bias.constant.xx").is_none());
}

#[test]
fn ledger_sums_to_measured_minus_true() {
    let mut imu = Imu::new(&spec(), Stream { seed: 5, run: 6 }).unwrap();
    for k in 0..20 {
        let sample = imu.step(0.01 + 0.001 * f64::from(k), &TRUTH);
        let mut sums = [[0.0; 3]; 2];
        for (c, e) in imu.ledger() {
            (0..3).for_each(|i| sums[c.instrument() as usize][i] += e[i]);
        }
        let measured = [sample.omega(), sample.f()];
        let truth = [[1.0, -2.0, 3.0], [4.0, 5.0, -6.0]];
        for s in 0..2 {
            for i in 0..3 {
                assert!((sums[s][i] - (measured[s][i] - truth[s][i])).abs() < 1e-14 * 20.0);
            }
        }
    }
}

#[test]
fn a_component_alone_has_the_draws_of_the_whole() {
    let spec = spec();
    let stream = Stream { seed: 5, run: 6 };
    let mut whole = Imu::new(&spec, stream).unwrap();
    let mut alone: Vec<_> = spec.components().map(|c| Imu::new(&spec.only(&c), stream).unwrap()).collect();
    for _ in 0..20 {
        whole.step(0.01, &TRUTH);
        for (imu, (c, e)) in alone.iter_mut().zip(whole.ledger()) {
            let sample = imu.step(0.01, &TRUTH);
            let error = if c.instrument() == Instrument::Gyro { sample.omega_error } else { sample.f_error };
            assert_eq!(error, e, "{c}");
        }
    }
}

#[test]
fn minus_one_gives_the_opposite_errors() {
    let stream = Stream { seed: 5, run: 6 };
    let mut plus = Imu::new(&spec(), stream).unwrap();
    let mut minus = Imu::new(&spec().scaled(-1.0), stream).unwrap();
    for _ in 0..20 {
        let (p, m) = (plus.step(0.01, &TRUTH), minus.step(0.01, &TRUTH));
        assert_eq!(p.omega_error, m.omega_error.map(|e| -e));
        assert_eq!(p.f_error, m.f_error.map(|e| -e));
    }
}

#[test]
fn a_restored_state_repeats_its_samples() {
    let mut imu = Imu::new(&spec(), Stream { seed: 5, run: 6 }).unwrap();
    imu.step(0.01, &TRUTH);
    let saved = imu.save();
    let first: Vec<_> = (0..50).map(|_| imu.step(0.02, &TRUTH)).collect();
    imu.step(0.3, &TRUTH);
    imu.restore(&saved).unwrap();
    let again: Vec<_> = (0..50).map(|_| imu.step(0.02, &TRUTH)).collect();
    assert_eq!(first, again);
}

#[test]
fn a_perfect_imu_passes_increments_through() {
    let mut imu = Imu::new(&Spec::new(), Stream::default()).unwrap();
    let (dtheta, dv) = ([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]);
    let sample = imu.step(0.01, &Truth::increments(dtheta, dv));
    assert_eq!((sample.dtheta, sample.dv), (dtheta, dv));
}

#[test]
fn errors_say_what_is_needed() {
    let kind = process_kind("gauss_markov").unwrap();
    let text = |given: &[(&str, Value<'_>)]| Process::new(kind, given).unwrap_err().to_string();
    assert_eq!(
        text(&[("sigma", 1.0.into()), ("tua", 1.0.into())]),
        "process `gauss_markov` has no parameter `tua`; it takes { sigma, tau }"
    );
    assert_eq!(
        text(&[("sigma", 1.0.into())]),
        "process `gauss_markov` got 1 parameter(s) that do not go together; it takes { sigma, tau }"
    );
    assert_eq!(
        text(&[("sigma", (-1.0).into()), ("tau", 1.0.into())]),
        "`sigma` of process `gauss_markov` is -1, but must be a finite number, zero or more"
    );
    let white = Process::new(process_kind("white").unwrap(), &[("density", (&[1.0, 2.0]).into())]).unwrap();
    let error = Source::new(Instrument::Gyro, term("misalignment").unwrap(), white).unwrap_err();
    assert_eq!(
        error.to_string(),
        "term `misalignment` has 6 coefficients (xy, xz, yx, yz, zx, zy), but its process `white` was given lists of 2"
    );
}

#[test]
fn an_unknown_name_is_answered_with_the_known_ones() {
    let text = |t, p| Source::named(Instrument::Gyro, t, p, &[]).unwrap_err().to_string();
    assert!(text("baias", "white").starts_with("there is no term `baias`; terms are bias, "));
    assert!(text("bias", "pink").starts_with("there is no process `pink`; processes are constant, "));
}

#[test]
fn registries_find_their_entries() {
    for t in TERMS {
        assert_eq!(term(t.name()).unwrap().name(), t.name());
    }
    for p in PROCESSES {
        assert_eq!(process_kind(p.name()).unwrap().name(), p.name());
    }
}
