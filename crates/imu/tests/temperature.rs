//! Temperature profiles and thermal terms.

use schuler_imu::{Imu, Instrument, Source, Spec, Stream, Temperature, Truth};

const PROFILES: [Temperature<'static>; 4] = [
    Temperature::Constant(300.0),
    Temperature::Ramp { start: 280.0, rate: 0.02 },
    Temperature::WarmUp { start: 280.0, end: 320.0, tau: 300.0 },
    Temperature::Table(&[(10.0, 280.0), (100.0, 300.0), (400.0, 290.0)]),
];

/// Mean against Simpson's rule, rate against the difference of the ends.
#[test]
fn mean_and_rate_are_those_of_the_profile() {
    for profile in PROFILES {
        profile.validate().unwrap();
        for (t, dt) in [(0.0, 5.0), (50.0, 20.0), (200.0, 1.0), (500.0, 100.0)] {
            let n = 200;
            let weight = |k: i32| if k == 0 || k == n { 1.0 } else { 2.0 + 2.0 * f64::from(k % 2) };
            let point = |k: i32| profile.at(t + dt * f64::from(k) / f64::from(n));
            let mean = (0..=n).map(|k| weight(k) * point(k)).sum::<f64>() / f64::from(3 * n);
            assert!((profile.mean(t, dt) - mean).abs() < 1e-9, "{profile:?} {t}");
            let rate = (profile.at(t + dt) - profile.at(t)) / dt;
            assert!((profile.rate(t, dt) - rate).abs() < 1e-12, "{profile:?} {t}");
        }
    }
    assert_eq!(PROFILES[3].at(0.0), 280.0);
    assert_eq!(PROFILES[3].at(55.0), 290.0);
    assert_eq!(PROFILES[3].at(1e4), 290.0);
}

/// db = c1 (T - T0) + rate coefficient times dT/dt, by hand at the calibration temperature of 290 K.
#[test]
fn thermal_terms_follow_the_profile() {
    let source = |term: &str, c: f64| {
        Source::named(Instrument::Accel, term, "constant", &[("value", c.into())]).unwrap()
    };
    let mut spec =
        Spec::from_sources([source("thermal", 2.0), source("thermal_2", 0.1), source("thermal_rate", 50.0)])
            .unwrap();
    spec.calibration_temperature = 290.0;
    let mut imu = Imu::new(&spec, Stream::default()).unwrap();
    let truth = Truth::rates([0.0; 3], [0.0; 3]).at_temperature(&PROFILES[1], 995.0, 10.0);
    // 280 + 0.02 * 1000 = 300 K: 2 * 10 + 0.1 * 100 + 50 * 0.02 = 31.
    assert!(imu.step(10.0, &truth).f_error.iter().all(|e| (e - 31.0).abs() < 1e-9));
}

#[test]
fn nonsense_is_refused() {
    let text = |t: Temperature<'_>| t.validate().unwrap_err().to_string();
    assert_eq!(
        text(Temperature::WarmUp { start: 280.0, end: 300.0, tau: 0.0 }),
        "temperature: `tau` is 0, but must be a time constant above 0 s"
    );
    assert_eq!(
        text(Temperature::Constant(-3.0)),
        "temperature: `constant` is -3, but must be a temperature above 0 K"
    );
    assert_eq!(
        text(Temperature::Table(&[(1.0, 280.0), (1.0, 290.0)])),
        "temperature: `table` is 1, but must be a finite time after the one before"
    );
    assert!(text(Temperature::Table(&[])).contains("one point"));
}
