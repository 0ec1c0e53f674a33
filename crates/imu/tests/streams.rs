//! Draws as draws: their distribution, their tails, their independence.

use schuler_imu::random::{STEPS, best_level, fill_normals};
use schuler_imu::{Imu, Instrument, Process, Source, Spec, Stream, TERMS, Truth, process_kind};
use statrs::distribution::{ContinuousCDF, Normal};

fn normals(key: [u32; 2], address: u64, octets: u64) -> Vec<f64> {
    let addresses: Vec<u64> = (address..address + 64).collect();
    let mut rows = vec![[0.0; STEPS]; addresses.len()];
    let mut out = Vec::new();
    for octet in 0..octets {
        fill_normals(best_level(), key, octet, &addresses, &mut rows);
        out.extend_from_slice(rows.as_flattened());
    }
    out
}

/// Kolmogorov-Smirnov: sqrt(n) D below 2.65, which a true normal exceeds once in 600 000 (2 exp(-2 x²)).
#[test]
fn draws_are_normal() {
    let normal = Normal::standard();
    for seed in 0..4 {
        let mut x = normals([seed, 99], 0, 1000);
        x.sort_by(f64::total_cmp);
        let n = x.len() as f64;
        let distance = x
            .iter()
            .enumerate()
            .map(|(i, x)| {
                let p = normal.cdf(*x);
                (p - i as f64 / n).max((i + 1) as f64 / n - p)
            })
            .fold(0.0, f64::max);
        assert!(distance * n.sqrt() < 2.65, "{}", distance * n.sqrt());
    }
}

/// Moments and the number beyond k sigma, on each side, within 5 sigma of what a normal has.
#[test]
fn tails_are_those_of_a_normal() {
    let normal = Normal::standard();
    let mut beyond = [[0_u64; 2]; 6];
    let mut moments = [0.0; 4];
    let mut n = 0.0;
    for key in 0..80 {
        for x in normals([key, 5], 1 << 40, 1000) {
            n += 1.0;
            let mut power = 1.0;
            for m in &mut moments {
                power *= x;
                *m += power;
            }
            if x.abs() > 1.0 {
                for k in 1..6 {
                    beyond[k][usize::from(x > 0.0)] += u64::from(x.abs() > k as f64);
                }
            }
        }
    }
    // Variances of x, x², x³, x⁴: 1, 2, 15, 96.
    for (k, (sum, (mean, variance))) in
        moments.iter().zip([(0.0, 1.0), (1.0, 2.0), (0.0, 15.0), (3.0, 96.0_f64)]).enumerate()
    {
        let z = (sum - n * mean) / (n * variance).sqrt();
        assert!(z.abs() < 5.0, "moment {}: {z} sigma", k + 1);
    }
    for k in 1..6 {
        let expected = n * normal.sf(k as f64);
        for count in beyond[k] {
            let z = (count as f64 - expected) / expected.sqrt();
            assert!(z.abs() < 5.0, "beyond {k} sigma: {count}, expected {expected:.1}");
        }
    }
}

/// White noise of every coefficient of every term, in two runs and of two seeds, at several lags.
#[test]
fn streams_are_independent() {
    const N: usize = 4000;
    let kind = process_kind("white").unwrap();
    let white = Process::new(kind, &[("density", 1.0.into())]).unwrap();
    let mut series: Vec<Vec<f64>> = Vec::new();
    for stream in [Stream { seed: 1, run: 0 }, Stream { seed: 1, run: 1 }, Stream { seed: 2, run: 0 }] {
        for instrument in Instrument::ALL {
            let terms = TERMS.iter().filter(|t| t.instruments().contains(&instrument) && t.len() < 9);
            let spec =
                Spec::from_sources(terms.map(|t| Source::new(instrument, *t, white).unwrap())).unwrap();
            let mut imu = Imu::new(&spec, stream).unwrap();
            let first = series.len();
            series.resize(first + spec.components().count(), Vec::with_capacity(N));
            let truth = Truth::rates([0.5, 1.5, -0.7], [1.0, 2.0, 3.0])
                .with_omega_dot([1.0, -2.0, 0.5])
                .with_temperature(300.0, 1.0)
                .with_vibration([1.0; 3]);
            for _ in 0..N {
                imu.step(1.0, &truth);
                for (s, (_, e)) in series[first..].iter_mut().zip(imu.ledger()) {
                    // Of whatever axis shows it most.
                    s.push(e.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a }));
                }
            }
        }
    }
    for s in &mut series {
        let scale = (s.iter().map(|x| x * x).sum::<f64>() / N as f64).sqrt();
        s.iter_mut().for_each(|x| *x /= scale);
    }
    let (mut pairs, mut beyond_4) = (0, 0);
    for (i, a) in series.iter().enumerate() {
        for (j, b) in series.iter().enumerate().skip(i) {
            for lag in if i == j { 1..4 } else { 0..2 } {
                let sum: f64 = a[lag..].iter().zip(b).map(|(a, b)| a * b).sum();
                let z = sum / ((N - lag) as f64).sqrt();
                pairs += 1;
                beyond_4 += usize::from(z.abs() > 4.0);
                assert!(z.abs() < 5.5, "series {i} and {j}, lag {lag}: {z} sigma");
            }
        }
    }
    // 6.3e-5 of all pairs lie beyond 4 sigma.
    let expected = 6.3e-5 * f64::from(pairs);
    println!("{} series, {pairs} pairs, {beyond_4} beyond 4 sigma, {expected:.1} expected", series.len());
    assert!((beyond_4 as f64) < expected + 4.0 * expected.sqrt() + 1.0);
}
