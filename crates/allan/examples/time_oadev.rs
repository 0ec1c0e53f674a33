//! Times the overlapping deviation and the pyramid on a series of another program: `time_oadev RATE.npy HZ FACTOR…`,
//! one column of float64. Used by `benches/allantools/compare.py`.
use std::time::Instant;

use schuler_allan::{Curve, Estimator, Grid, Phase, Pyramid};

const REPEATS: usize = 5;

fn best<T>(name: &str, mut work: impl FnMut() -> T) -> T {
    let mut least = f64::INFINITY;
    let mut last = None;
    for _ in 0..REPEATS {
        let start = Instant::now();
        last = Some(work());
        least = least.min(start.elapsed().as_secs_f64());
    }
    println!("time {name} {least:e}");
    last.expect("invariant: at least one repeat")
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, hertz, factors @ ..] = &arguments[..] else {
        return Err("time_oadev RATE.npy HZ FACTOR…".into());
    };
    let bytes = std::fs::read(file)?;
    // Version 1 of the format: ten bytes, the last two the length of the header that follows.
    let start = match bytes[..] {
        [_, _, _, _, _, _, 1, _, a, b, ..] => 10 + usize::from(u16::from_le_bytes([a, b])),
        _ => return Err("no npy file of version 1".into()),
    };
    let rate: Vec<f64> = bytes[start..].as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let tau0 = 1.0 / hertz.parse::<f64>()?;
    let grid = Grid::Factors(factors.iter().map(|m| m.parse()).collect::<Result<_, _>>()?);

    // From the rate on, as allantools does it.
    let curve = best("overlapping", || {
        Curve::estimate(&Phase::from_rate(&rate, tau0)?, Estimator::Overlapping, &grid)
    })?;
    best("pyramid", || {
        let mut pyramid = Pyramid::new(tau0)?;
        pyramid.push(&rate)?;
        pyramid.curve()
    })?;
    for p in curve.points {
        println!("deviation {} {:e}", p.m, p.deviation());
    }
    Ok(())
}
