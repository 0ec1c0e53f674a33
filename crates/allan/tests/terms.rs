use std::f64::consts::PI;

use schuler_allan::Term;

/// sigma²(tau) = 4 times the integral over f > 0 of S(f) sin⁴(π f tau)/(π f tau)², by Simpson over ln f.
fn by_spectrum(term: Term, tau: f64) -> f64 {
    let (low, high, steps) = ((1e-7 / tau).ln(), (2e3 / tau).ln(), 2_000_000);
    let h = (high - low) / f64::from(steps);
    let at = |k: i32| {
        let f = (low + h * f64::from(k)).exp();
        let x = PI * f * tau;
        4.0 * term.spectrum(f, 1e-9).unwrap() * x.sin().powi(4) / (x * x) * f
    };
    let inner: f64 = (1..steps).map(|k| if k % 2 == 1 { 4.0 } else { 2.0 } * at(k)).sum();
    (at(0) + inner + at(steps)) * h / 3.0
}

#[test]
fn closed_forms_are_the_integrals_of_the_spectra() {
    // White noise has energy beyond the last frequency: 1/(pi² 2000) of the whole there.
    for (term, tolerance) in [
        (Term::White, 1e-4),
        (Term::Flicker, 1e-6),
        (Term::RandomWalk, 1e-6),
        (Term::Markov { tau: 3.0 }, 1e-6),
        (Term::Markov { tau: 0.2 }, 1e-6),
    ] {
        let (got, want) = (term.allan_variance(1.7), by_spectrum(term, 1.7));
        assert!((got / want - 1.0).abs() < tolerance, "{term:?}: {got}, integral {want}");
    }
}

/// The Markov curve peaks at 1.89262 correlation times with 0.617364 sigma (independent computation).
#[test]
fn a_markov_curve_peaks_where_it_should() {
    let deviation = |x: f64| Term::Markov { tau: 100.0 }.allan_variance(100.0 * x).sqrt();
    assert!((deviation(1.89262) - 0.617364).abs() < 1e-6);
    assert!(deviation(1.85) < deviation(1.89262) && deviation(1.94) < deviation(1.89262));
    // No step where the series takes over.
    let (below, above) = (deviation(1e-3 * (1.0 - 1e-6)), deviation(1e-3 * (1.0 + 1e-6)));
    assert!((above / below - 1.0).abs() < 2e-6);
}

#[test]
fn coefficients_of_the_standard() {
    assert!((Term::Quantization.allan_variance(2.0) - 0.75).abs() < 1e-15);
    assert!((Term::Flicker.allan_variance(5.0).sqrt() - 0.664_282).abs() < 1e-6);
    assert!((Term::Ramp.allan_variance(4.0) - 8.0).abs() < 1e-15);
}
