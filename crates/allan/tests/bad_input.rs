use schuler_allan::{AllanError, Curve, Estimator, Grid, Phase, Pyramid, sample_interval, split_at_gaps};

fn message(e: AllanError) -> String {
    e.to_string()
}

#[test]
fn samples_that_cannot_be_used_are_named() {
    let nan = message(Phase::from_rate(&[1.0, 2.0, f64::NAN, 3.0], 0.01).unwrap_err());
    assert!(nan.contains("sample 2 is NaN"), "{nan}");
    let constant = message(Phase::from_rate(&[0.1; 50], 0.01).unwrap_err());
    assert!(constant.contains("all 50 samples equal 0.1"), "{constant}");
    let short = message(Phase::from_rate(&[1.0, 2.0], 0.01).unwrap_err());
    assert!(short.contains("needs at least 3"), "{short}");
    let interval = message(Phase::from_rate(&[1.0, 2.0, 1.0], 0.0).unwrap_err());
    assert!(interval.contains("0.01 s for 100 Hz"), "{interval}");
    let phase = Phase::from_rate(&[1.0, 2.0, 1.0, 5.0], 1.0).unwrap();
    assert!(Curve::estimate(&phase, Estimator::Overlapping, &Grid::Factors(vec![100])).is_err());
}

#[test]
fn the_stream_says_the_same() {
    let mut pyramid = Pyramid::new(0.01).unwrap();
    pyramid.push(&[0.5; 2000]).unwrap();
    assert_eq!(pyramid.curve(), Err(AllanError::Constant { count: 2000, value: 0.5 }));
    let bad = pyramid.push(&[0.5, f64::INFINITY]);
    assert_eq!(bad, Err(AllanError::NotFinite { index: 2001, value: f64::INFINITY }));
    let mut early = Pyramid::new(0.01).unwrap();
    assert!(early.push(&[0.5, f64::NAN]).is_err());
    assert!(Pyramid::new(0.01).unwrap().curve().is_err());
    assert!(Pyramid::new(f64::NAN).is_err());
}

#[test]
fn time_stamps_are_judged() {
    let even: Vec<f64> = (0..100).map(|i| f64::from(i) * 0.01).collect();
    assert!((sample_interval(&even).unwrap() - 0.01).abs() < 1e-15);

    // Stamps rounded to a millisecond at 300 Hz: 3 and 4 ms alternate, which is more than jitter.
    let rounded: Vec<f64> = (0..100).map(|i| (f64::from(i) / 300.0 * 1e3).round() / 1e3).collect();
    let uneven = message(sample_interval(&rounded).unwrap_err());
    assert!(uneven.contains("not uniform"), "{uneven}");
    let fine: Vec<f64> = (0..100).map(|i| (f64::from(i) / 300.0 * 1e6).round() / 1e6).collect();
    assert!((sample_interval(&fine).unwrap() - 1.0 / 300.0).abs() < 1e-8);

    let mut gap = even.clone();
    for t in &mut gap[60..] {
        *t += 0.05;
    }
    let refused = message(sample_interval(&gap).unwrap_err());
    assert!(refused.contains("1 gap(s)") && refused.contains("row 60"), "{refused}");
    assert_eq!(split_at_gaps(&gap).unwrap(), [0..60, 60..100]);

    let mut back = even.clone();
    back[10] = 0.0;
    assert!(message(sample_interval(&back).unwrap_err()).contains("must increase"));
    assert!(sample_interval(&[0.0, f64::NAN, 1.0]).is_err());
    assert!(sample_interval(&[0.0, 1.0]).is_err());
}
