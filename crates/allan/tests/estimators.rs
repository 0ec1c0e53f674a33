use schuler_allan::{Curve, Estimator, Grid, Phase};

use crate::support::series::{allantools_series, lehmer, table};

fn at(phase: &Phase, estimator: Estimator, m: usize) -> f64 {
    Curve::estimate(phase, estimator, &Grid::Factors(vec![m])).unwrap().points[0].deviation()
}

fn assert_relative(got: f64, want: f64, tolerance: f64, what: &str) {
    assert!((got / want - 1.0).abs() < tolerance, "{what}: {got:e}, reference {want:e}");
}

#[test]
fn nbs_1000_points_agree_with_an_independent_program() {
    let phase = Phase::from_rate(&lehmer(1_234_567_890, 1000), 1.0).unwrap();
    let rows = table("static_theory/allan_lcg.csv");
    assert_eq!(rows.len(), 11);
    for row in rows {
        let m = row[0].parse().unwrap();
        for (column, estimator) in [(2, Estimator::NonOverlapping), (3, Estimator::Overlapping)] {
            // The table is printed to 16 digits; non-overlapping starts at the first sample, as ours.
            let want: f64 = row[column].parse().unwrap();
            assert_relative(at(&phase, estimator, m), want, 1e-13, &format!("{estimator:?} m={m}"));
        }
    }
}

/// NIST SP 1065, table 31: seven digits for tau = 1, 10, 100 s.
#[test]
fn nbs_1000_points_agree_with_the_published_table() {
    let phase = Phase::from_rate(&lehmer(1_234_567_890, 1000), 1.0).unwrap();
    for (estimator, published) in [
        (Estimator::NonOverlapping, [2.922319e-01, 9.965736e-02, 3.897804e-02]),
        (Estimator::Overlapping, [2.922319e-01, 9.159953e-02, 3.241343e-02]),
        (Estimator::Modified, [2.922319e-01, 6.172376e-02, 2.170921e-02]),
        (Estimator::Hadamard, [2.943883e-01, 9.581083e-02, 3.237638e-02]),
        (Estimator::Total, [2.922319e-01, 9.134743e-02, 3.406530e-02]),
    ] {
        for (m, want) in [1, 10, 100].into_iter().zip(published) {
            assert_relative(at(&phase, estimator, m), want, 3e-7, &format!("{estimator:?} m={m}"));
        }
    }
}

#[test]
fn every_deviation_agrees_with_allantools() {
    let phase = Phase::from_rate(&allantools_series(), 0.01).unwrap();
    let rows = table("allan/allantools.csv");
    assert!(rows.len() > 100);
    for row in rows {
        let estimator = estimator(&row[0]);
        let (m, want): (usize, f64) = (row[1].parse().unwrap(), row[2].parse().unwrap());
        assert_relative(at(&phase, estimator, m), want, 1e-12, &format!("{} m={m}", row[0]));
    }
}

pub fn estimator(name: &str) -> Estimator {
    match name {
        "adev" => Estimator::NonOverlapping,
        "oadev" => Estimator::Overlapping,
        "mdev" => Estimator::Modified,
        "hdev" => Estimator::HadamardNonOverlapping,
        "ohdev" => Estimator::Hadamard,
        "totdev" => Estimator::Total,
        other => panic!("{other}"),
    }
}

#[test]
fn a_rate_its_increments_and_its_phase_are_the_same_log() {
    let rate = allantools_series();
    let increments: Vec<f64> = rate.iter().map(|r| r * 0.01).collect();
    let mut sum = 0.0;
    let x = std::iter::once(0.0).chain(increments.iter().map(|d| {
        sum += d;
        sum
    }));
    let three = [
        Phase::from_rate(&rate, 0.01).unwrap(),
        Phase::from_increments(&increments, 0.01).unwrap(),
        Phase::from_phase(x.collect(), 0.01).unwrap(),
    ];
    for m in [1, 10, 1000] {
        let [a, b, c] = [0, 1, 2].map(|i| at(&three[i], Estimator::Overlapping, m));
        assert_relative(b, a, 1e-11, "increments");
        assert_relative(c, a, 1e-11, "phase");
    }
}

/// A ramp R t has Allan variance R² tau² / 2 exactly and no Hadamard variance.
#[test]
fn a_ramp_is_seen_by_allan_and_not_by_hadamard() {
    let rate: Vec<f64> = (0..1000).map(|i| 3.0 * (f64::from(i) + 0.5) * 0.1).collect();
    let phase = Phase::from_rate(&rate, 0.1).unwrap();
    for m in [1, 7, 100] {
        let want = 3.0 * m as f64 * 0.1 / 2f64.sqrt();
        for estimator in [Estimator::Overlapping, Estimator::NonOverlapping] {
            assert_relative(at(&phase, estimator, m), want, 1e-9, "ramp");
        }
        assert!(at(&phase, Estimator::Hadamard, m) < 1e-9 * want);
    }
}

#[test]
fn grids_are_what_they_say() {
    assert_eq!(Grid::Octave.factors(100), [1, 2, 4, 8, 16, 32, 64]);
    assert_eq!(Grid::Decade.factors(1000), [1, 10, 100, 1000]);
    assert_eq!(Grid::PerOctave(2).factors(12), [1, 2, 3, 4, 6, 8, 11]);
    assert_eq!(Grid::PerDecade(3).factors(100), [1, 2, 5, 10, 22, 46, 100]);
    assert_eq!(Grid::All.factors(4), [1, 2, 3, 4]);
    assert_eq!(Grid::Factors(vec![8, 2, 2, 900]).factors(100), [2, 8]);
}
