//! Confidence intervals and bands of 99 %.

use schuler_strapdown::filter::chi_square;

/// Normal quantile of 99.5 %: half of what is outside a 99 % interval.
pub const Z: f64 = 2.575_829_303_548_901;

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

/// Ranks (from 1 on) of the quantile `p` of `n` values and of the ends of its 99 % interval: the number of values below is
/// binomial. An end beyond the first or last value is that value.
pub fn quantile_ranks(p: f64, n: u64) -> [u64; 3] {
    let (mean, deviation) = (p * n as f64, (p * (1.0 - p) * n as f64).sqrt());
    [0.0, -Z, Z].map(|z| {
        let rank = mean + z * deviation;
        // The quantile itself is the smallest value with at least the share p at or below it.
        (if z > 0.0 { rank.ceil() + 1.0 } else { rank.ceil() }).clamp(1.0, n as f64) as u64
    })
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

    #[test]
    fn ranks() {
        assert_eq!(quantile_ranks(0.5, 1000), [500, 460, 542]);
        assert_eq!(quantile_ranks(0.99, 20), [20, 19, 20]);
    }
}
