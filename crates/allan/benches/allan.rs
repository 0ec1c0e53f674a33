//! Overlapping deviation and pyramid against the plain loop, in one run.
use divan::{Bencher, black_box, counter::ItemsCount};
use schuler_allan::{Curve, Estimator, Grid, Phase, Pyramid};

fn main() {
    divan::main();
}

/// White enough, without a dependency: Lehmer numbers.
fn rate(n: usize) -> Vec<f64> {
    let mut s: u64 = 1_234_567_890;
    (0..n)
        .map(|_| {
            s = s * 16807 % 2_147_483_647;
            s as f64 / 2_147_483_647.0 - 0.5
        })
        .collect()
}

/// What one writes first: one sum, one loop.
fn plain(x: &[f64], m: usize) -> f64 {
    let mut sum = 0.0;
    for k in 0..x.len() - 2 * m {
        let d = x[k + 2 * m] - 2.0 * x[k + m] + x[k];
        sum += d * d;
    }
    sum
}

const IN_CACHE: usize = 16_384;
const M: [usize; 3] = [1, 16, 1000];

#[divan::bench(args = M)]
fn overlapping_plain_loop(bencher: Bencher, m: usize) {
    let phase = Phase::from_rate(&rate(IN_CACHE), 0.01).expect("good samples");
    bencher
        .counter(ItemsCount::new(IN_CACHE))
        .bench_local(|| plain(black_box(phase.samples()), black_box(m)));
}

#[divan::bench(args = M)]
fn overlapping(bencher: Bencher, m: usize) {
    let phase = Phase::from_rate(&rate(IN_CACHE), 0.01).expect("good samples");
    let grid = Grid::Factors(vec![m]);
    bencher
        .counter(ItemsCount::new(IN_CACHE))
        .bench_local(|| Curve::estimate(black_box(&phase), Estimator::Overlapping, &grid));
}

#[divan::bench(args = [100_000, 1_000_000, 10_000_000, 100_000_000], sample_count = 5, sample_size = 1)]
fn pyramid_all_octaves(bencher: Bencher, n: usize) {
    let block = rate(100_000);
    bencher.counter(ItemsCount::new(n)).bench_local(|| {
        let mut pyramid = Pyramid::new(0.01).expect("good interval");
        for _ in 0..n / block.len() {
            pyramid.push(black_box(&block)).expect("good samples");
        }
        pyramid.curve()
    });
}
