//! Magnitudes of many runs in bounded memory: exact while they are few, in fine bins when they are many.

use std::collections::BTreeMap;

/// Most different values, or bins, that are kept.
const MOST: usize = 1024;
/// Bits of a number.
const BITS: u32 = 64;

/// Counts of magnitudes. It depends on which values were added and not on their order.
///
/// The numbers are kept whole while there are no more than 1024 different ones; quantiles are then order statistics. Beyond, the
/// last bits are dropped, one after the other and no more than it takes, so that bins of equal ratio remain (a few per mille
/// wide for a million normal numbers), within which a quantile is interpolated.
#[derive(Clone, Debug, Default)]
pub struct Sketch {
    dropped: u32,
    /// By the leading bits, which order magnitudes as numbers do.
    counts: BTreeMap<u64, u64>,
    total: u64,
}

impl Sketch {
    /// Adds the magnitude of a finite number.
    pub fn add(&mut self, x: f64) {
        *self.counts.entry(x.abs().to_bits() >> self.dropped).or_default() += 1;
        self.total += 1;
        while self.counts.len() > MOST && self.dropped < BITS - 1 {
            self.dropped += 1;
            let mut coarse = BTreeMap::new();
            for (bin, count) in &self.counts {
                *coarse.entry(bin >> 1).or_default() += count;
            }
            self.counts = coarse;
        }
    }

    /// Numbers added.
    pub fn total(&self) -> u64 {
        self.total
    }

    /// The value of rank `rank`, from 1 on, in increasing order; NaN beyond the last.
    pub fn of_rank(&self, rank: u64) -> f64 {
        let mut below = 0;
        for (bin, &count) in &self.counts {
            if rank <= below + count && rank > 0 {
                let [low, high] = [*bin, bin + 1].map(|bin| f64::from_bits(bin << self.dropped));
                if self.dropped == 0 {
                    return low;
                }
                return low + (high - low) * ((rank - below) as f64 - 0.5) / count as f64;
            }
            below += count;
        }
        f64::NAN
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(n: u64) -> Vec<f64> {
        // A multiplicative congruential sequence, no two alike.
        let mut x: u64 = 1;
        (0..n)
            .map(|_| {
                x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                ((x >> 11) as f64 / (1u64 << 53) as f64) * 2e3 - 1e3
            })
            .collect()
    }

    /// Few numbers: order statistics to the last bit.
    #[test]
    fn few_numbers_are_exact() {
        let mut values = numbers(1000);
        let mut sketch = Sketch::default();
        values.iter().for_each(|x| sketch.add(*x));
        values.iter_mut().for_each(|x| *x = x.abs());
        values.sort_by(f64::total_cmp);
        for (k, x) in values.iter().enumerate() {
            assert_eq!(sketch.of_rank(k as u64 + 1).to_bits(), x.to_bits());
        }
        assert!(sketch.of_rank(0).is_nan() && sketch.of_rank(1001).is_nan());
    }

    /// Many numbers: a fraction of a per cent, in memory that does not grow, and the same in any order.
    #[test]
    fn many_numbers_are_close_in_any_order() {
        let mut values = numbers(100_000);
        let (mut sketch, mut backward) = (Sketch::default(), Sketch::default());
        values.iter().for_each(|x| sketch.add(*x));
        values.iter().rev().for_each(|x| backward.add(*x));
        assert!(sketch.counts.len() <= MOST && sketch.counts == backward.counts);
        values.iter_mut().for_each(|x| *x = x.abs());
        values.sort_by(f64::total_cmp);
        for rank in [50_000, 90_000, 95_000, 99_000] {
            let (found, expected) = (sketch.of_rank(rank), values[rank as usize - 1]);
            assert!((found / expected - 1.0).abs() < 2e-3, "{rank}: {found} {expected}");
        }
    }
}
