//! Quantiles that bound samples of normal noise.

use std::f64::consts::SQRT_2;

/// Two-sided 99 % quantile of the standard normal distribution.
pub const Z99: f64 = 2.575_829_303_548_901;

/// The value that the largest of `n` independent |standard normal|s stays below with probability `p`.
///
/// P(max < z) = erf(z/√2)^n, solved for z by bisection.
pub fn largest_of(n: f64, p: f64) -> f64 {
    // ln(1 - erfc) keeps its digits where erf is 1 to rounding.
    let wanted = p.ln() / n;
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..200 {
        let z = 0.5 * (low + high);
        let tail = libm::erfc(z / SQRT_2);
        if (-tail).ln_1p() < wanted { low = z } else { high = z }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::largest_of;

    /// 1 %, 50 % and 99 % quantiles of max|e|/sigma for 1000, 6000 and 10000 samples, to two decimals, from
    /// an independent evaluation of P = erf(z/√2)^n.
    #[test]
    fn largest_of_many() {
        for (n, low, median, high) in
            [(1e3, 2.83, 3.39, 4.42), (6e3, 3.36, 3.86, 4.79), (1e4, 3.50, 3.98, 4.89)]
        {
            for (p, z) in [(0.01, low), (0.5, median), (0.99, high)] {
                assert!((largest_of(n, p) - z).abs() < 0.0075, "{n} {p} {}", largest_of(n, p));
            }
        }
        // One sample: the two-sided quantile itself.
        assert!((largest_of(1.0, 0.99) - super::Z99).abs() < 1e-12);
    }
}
