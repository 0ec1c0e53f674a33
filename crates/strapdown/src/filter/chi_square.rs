//! The chi-square distribution, for gates and consistency bands.

use core::f64::consts::FRAC_1_SQRT_2;

/// Probability that the sum of squares of `dof` independent standard normals exceeds `x`.
///
/// Closed forms (Abramowitz and Stegun 26.4.4, 26.4.5): for even `dof` the sum of e^(-x/2) (x/2)^k / k! below dof/2,
/// for odd `dof` erfc(√(x/2)) and the sum of the like terms with half-integer k.
pub fn exceedance(x: f64, dof: usize) -> f64 {
    if x.is_nan() || x <= 0.0 {
        return if x.is_nan() { x } else { 1.0 };
    }
    let half = 0.5 * x;
    // Terms e^(-x/2) (x/2)^k / Γ(k + 1) from the last to the first, so that none vanishes for many degrees of freedom.
    let mut k = 0.5 * dof as f64 - 1.0;
    let mut term = libm::exp(k * libm::log(half) - half - libm::lgamma(k + 1.0));
    // So far below the mean that the last term, the smallest of those that count, vanishes.
    if term == 0.0 && half < k {
        return 1.0;
    }
    let mut sum = if dof.is_multiple_of(2) { 0.0 } else { libm::erfc(libm::sqrt(x) * FRAC_1_SQRT_2) };
    while k > -0.25 {
        sum += term;
        term *= k / half;
        k -= 1.0;
    }
    sum
}

/// The value that the sum of squares of `dof` independent standard normals exceeds with probability `p`: by bisection
/// of [`exceedance`], to rounding. Zero for `p >= 1`, infinite for `p <= 0`.
///
/// ```
/// use schuler_strapdown::filter::chi_square;
/// assert!((chi_square::quantile(0.05, 3) - 7.814728).abs() < 1e-6);
/// // Many degrees of freedom: normal with mean 30000 and deviation √60000, about.
/// assert!((chi_square::quantile(0.5, 30_000) - 29_999.333).abs() < 1e-2);
/// ```
pub fn quantile(p: f64, dof: usize) -> f64 {
    if p.is_nan() || p >= 1.0 {
        return if p.is_nan() { p } else { 0.0 };
    }
    if p <= 0.0 {
        return f64::INFINITY;
    }
    let (mut low, mut high) = (0.0, 1.0 + dof as f64);
    while exceedance(high, dof) > p {
        low = high;
        high *= 2.0;
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if exceedance(middle, dof) > p {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
