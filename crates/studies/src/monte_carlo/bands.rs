//! Confidence intervals and bands of 99 %.

use schuler_strapdown::filter::chi_square;
use statrs::distribution::{Binomial, DiscreteCDF};

/// Normal quantile of 99.5 %: half of what is outside a 99 % interval.
pub const Z: f64 = 2.575_829_303_548_901;

/// What is outside on either side.
const TAIL: f64 = 0.005;

/// 99 % band of chi-square of `freedom` degrees over its degrees. Beyond a thousand, and for degrees that are no whole number,
/// by the cube root of Wilson and Hilferty (Proc. Natl. Acad. Sci. 17, 1931), which is then right to 1e-5.
pub fn chi_square_band(freedom: f64) -> [f64; 2] {
    if freedom <= 1000.0 && freedom.fract() == 0.0 {
        return [0.995, 0.005].map(|p| chi_square::quantile(p, freedom as usize) / freedom);
    }
    let v = 2.0 / (9.0 * freedom);
    [-Z, Z].map(|z| (1.0 - v + z * v.sqrt()).max(0.0).powi(3))
}

/// 99 % interval of a probability of which `count` in `n` were seen: that of Wilson (J. Am. Stat. Assoc. 22, 1927).
pub fn share_interval(count: u64, n: u64) -> [f64; 2] {
    let (k, n) = (count as f64, n as f64);
    let share = k / n;
    let middle = share + Z * Z / (2.0 * n);
    let half = Z * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    // Where nothing or all was seen, the end is exact.
    let low = if count == 0 { 0.0 } else { (middle - half) / (1.0 + Z * Z / n) };
    let high = if k == n { 1.0 } else { (middle + half) / (1.0 + Z * Z / n) };
    [low, high]
}

/// Ranks (from 1 on) of a quantile of many values, and of the ends of its 99 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuantileRanks {
    /// The smallest value with at least the share at or below it.
    pub value: u64,
    /// The lower end; `None` where there are too few values for any of them to be one.
    pub low: Option<u64>,
    /// The upper end, in the same way.
    pub high: Option<u64>,
}

impl QuantileRanks {
    /// Those of the quantile `p` of `n` values. How many values B are at or below it is binomial, and value r is above it where
    /// B < r: so the lower end is the last r with P(B < r) ≤ 0.5 %, the upper one the first with P(B ≥ r) ≤ 0.5 %.
    pub fn of(p: f64, n: u64) -> QuantileRanks {
        let below = Binomial::new(p, n).expect("invariant: a share between 0 and 1");
        let (mean, deviation) = (p * n as f64, (p * (1.0 - p) * n as f64).sqrt());
        let near = |rank: f64| rank.round().clamp(0.0, n as f64) as u64;
        let (mut low, mut high) = (near(mean - Z * deviation), near(mean + Z * deviation));
        while low < n && below.cdf(low) <= TAIL {
            low += 1;
        }
        while low > 0 && below.cdf(low - 1) > TAIL {
            low -= 1;
        }
        while high > 0 && below.sf(high - 1) <= TAIL {
            high -= 1;
        }
        while high <= n && (high == 0 || below.sf(high - 1) > TAIL) {
            high += 1;
        }
        QuantileRanks {
            value: (mean.ceil() as u64).clamp(1, n),
            low: (low > 0).then_some(low),
            high: (high <= n).then_some(high),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NIST/SEMATECH e-Handbook, 1.3.6.7.4: 100 degrees of freedom, 67.328 and 140.169; and the two formulas beside each
    /// other.
    #[test]
    fn chi_square() {
        let [low, high] = chi_square_band(100.0);
        assert!((low * 100.0 - 67.328).abs() < 1e-3 && (high * 100.0 - 140.169).abs() < 1e-3);
        let ([a, b], [c, d]) = (chi_square_band(1000.0), chi_square_band(1000.5));
        assert!((a - c).abs() < 1e-4 && (b - d).abs() < 1e-4);
    }

    /// 10 in 100 by the quadratic equation |p - 0.1| = z √(p (1 - p)/100).
    #[test]
    fn shares() {
        for p in share_interval(10, 100) {
            assert!(((p - 0.1f64).abs() - Z * (p * (1.0 - p) / 100.0).sqrt()).abs() < 1e-12);
        }
        assert_eq!(share_interval(0, 50)[0], 0.0);
        assert_eq!(share_interval(50, 50)[1], 1.0);
    }

    /// Of a median by hand: in (X₁, X₈) with 1 - 2/2⁸ = 99.2 %, of seven values with 98.4 % only; of twenty in (X₄, X₁₇), as sums
    /// of binomial coefficients have it. Of q99: all of n are below it with 0.99ⁿ, 0.5 % at n = 527.2.
    #[test]
    fn ranks() {
        let ranks = |p, n| QuantileRanks::of(p, n);
        let ends = |p, n| (ranks(p, n).low, ranks(p, n).high);
        assert_eq!(ends(0.5, 7), (None, None));
        assert_eq!(ends(0.5, 8), (Some(1), Some(8)));
        assert_eq!(ends(0.5, 20), (Some(4), Some(17)));
        assert_eq!((ranks(0.99, 527).high, ranks(0.99, 528).high), (None, Some(528)));
        assert_eq!((ranks(0.5, 20).value, ranks(0.99, 20).value), (10, 20));
        // Many: as the normal distribution has it, but for a rank.
        for (p, n) in [(0.5, 100_000u64), (0.95, 1_000_000)] {
            let (mean, half) = (p * n as f64, Z * (p * (1.0 - p) * n as f64).sqrt());
            let QuantileRanks { low, high, .. } = ranks(p, n);
            let off = [low.unwrap() as f64 - (mean - half), high.unwrap() as f64 - (mean + half)];
            assert!(off.iter().all(|x| x.abs() < 2.5), "{off:?}");
        }
    }

    /// How often an interval misses, summed over all counts: on each side at most 0.5 %, and the next rank inward more.
    #[test]
    fn no_interval_is_wider_than_it_must() {
        for (p, n) in [(0.5, 20u64), (0.9, 64), (0.95, 128), (0.99, 192), (0.99, 1000)] {
            let mut ways = 0.0;
            let below: Vec<f64> = (0..=n)
                .map(|k| {
                    if k > 0 {
                        ways += ((n - k + 1) as f64 / k as f64).ln();
                    }
                    (ways + k as f64 * f64::ln(p) + (n - k) as f64 * f64::ln(1.0 - p)).exp()
                })
                .collect();
            let sum = |range: std::ops::Range<u64>| range.map(|k| below[k as usize]).sum::<f64>();
            let QuantileRanks { low, high, .. } = QuantileRanks::of(p, n);
            assert!(
                low.is_none_or(|low| sum(0..low) <= TAIL) && sum(0..low.unwrap_or(0) + 1) > TAIL,
                "{p} {n}"
            );
            assert!(high.is_none_or(|high| sum(high..n + 1) <= TAIL), "{p} {n}");
            assert!(sum(high.unwrap_or(n + 1) - 1..n + 1) > TAIL, "{p} {n}");
        }
    }
}
