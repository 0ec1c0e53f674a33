use schuler_allan::{Curve, Estimator, Fit, Fitter, Grid, Phase, Term, Verdict, to_sources};
use schuler_imu::{Imu, Instrument::Gyro, PROCESSES, Process, Source, Spec, Stream, Truth, process_kind};

/// Four days at 2.5 Hz: long enough for seven noises to stand beside each other.
const TAU0: f64 = 0.4;
const SAMPLES: usize = 864_000;

/// Fits of the three gyro axes of a simulated log at rest.
fn fits(sources: Vec<Source>, run: u64) -> Vec<Fit> {
    let mut imu = Imu::new(&Spec::from_sources(sources).unwrap(), Stream { seed: 4, run }).unwrap();
    let mut axes: [Vec<f64>; 3] = Default::default();
    let rest = Truth::rates([0.0; 3], [0.0; 3]);
    for _ in 0..SAMPLES {
        let omega = imu.step(TAU0, &rest).omega();
        for (axis, rate) in axes.iter_mut().zip(omega) {
            axis.push(rate);
        }
    }
    let curves: Vec<Curve> = axes
        .iter()
        .map(|rate| {
            let phase = Phase::from_rate(rate, TAU0).unwrap();
            Curve::estimate(&phase, Estimator::Overlapping, &Grid::PerOctave(2)).unwrap()
        })
        .collect();
    let fitter = Fitter::new(&curves[0]).unwrap();
    curves.iter().map(|c| fitter.fit(c).unwrap()).collect()
}

/// Fit, simulate what was found, fit again: what the second log was made with lies within what its fit says, for a
/// list of all seven noises.
#[test]
fn a_fitted_model_simulated_and_fitted_again_stays_within_its_intervals() {
    let seven = [
        ("quantization", vec![("q", 1.15e-6)]),
        ("white", vec![("density", 1e-6)]),
        ("flicker", vec![("instability", 2.3e-7), ("tau_min", TAU0), ("tau_max", TAU0 * SAMPLES as f64)]),
        ("random_walk", vec![("density", 5e-9)]),
        ("ramp", vec![("rate", 1e-10)]),
        ("gauss_markov", vec![("sigma", 8e-7), ("tau", 60.0)]),
        ("sinusoid", vec![("amplitude", 3e-6), ("frequency", 0.11)]),
    ];
    let sources = seven.map(|(process, given)| {
        let given: Vec<_> = given.into_iter().map(|(name, value)| (name, value.into())).collect();
        Source::named(Gyro, "bias", process, &given).unwrap()
    });
    let first = fits(sources.to_vec(), 0);
    let second = fits(to_sources(&first, Gyro).unwrap(), 1);
    let (mut intervals, mut missed) = (0, Vec::new());
    for (one, two) in first.iter().zip(&second) {
        assert!(!two.misfit, "chi2 {} at {}", two.chi2, two.freedom);
        for p in one.parameters.iter().filter(|p| p.verdict == Verdict::Seen) {
            let again = two.parameter(p.term).unwrap_or_else(|| panic!("{p:?} is not found again"));
            intervals += 1;
            let (low, high) = again.interval;
            if !(low..=high).contains(&p.value) {
                missed.push(format!("{p:?}\n{again:?}"));
            }
        }
    }
    // All seven on three axes but for what a log may hide; one in twenty misses by chance.
    assert!(intervals >= 18, "{intervals} of 21 seen");
    assert!(missed.len() <= 3, "{} of {intervals}: {missed:#?}", missed.len());
}

/// The simulator's processes have the Allan variances of the fit.
#[test]
fn terms_and_processes_are_the_same_laws() {
    let c = 0.7;
    for (name, given, term) in [
        ("quantization", vec![("q", c)], Term::Quantization),
        ("white", vec![("density", c)], Term::White),
        ("random_walk", vec![("density", c)], Term::RandomWalk),
        ("ramp", vec![("rate", c)], Term::Ramp),
        ("gauss_markov", vec![("sigma", c), ("tau", 20.0)], Term::Markov { tau: 20.0 }),
        ("sinusoid", vec![("amplitude", c), ("frequency", 0.3)], Term::Sinusoid { f0: 0.3 }),
        ("flicker", vec![("instability", c), ("tau_min", 0.01), ("tau_max", 1e5)], Term::Flicker),
    ] {
        assert!(PROCESSES.iter().any(|p| p.name() == name));
        let given: Vec<_> = given.into_iter().map(|(name, value)| (name, value.into())).collect();
        let process = Process::new(process_kind(name).unwrap(), &given).unwrap();
        let source = Source::new(Gyro, schuler_imu::term("bias").unwrap(), process).unwrap();
        let evolution = source.components().next().unwrap().evolution();
        for tau in [0.1, 1.0, 17.0, 300.0] {
            let (got, want) = (c * c * term.allan_variance(tau), evolution.allan_variance(tau));
            // Flicker over a band ripples by 1 % in deviation.
            let tolerance = if term == Term::Flicker { 0.02 } else { 1e-9 };
            assert!((got / want - 1.0).abs() < tolerance, "{name} at {tau} s: {got}, simulator {want}");
        }
    }
}
