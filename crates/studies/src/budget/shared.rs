//! Sources that behave the same but for their size: one stands for all of them.

use super::source::{Kind, Source};

/// Relative difference below which numbers of two processes are the same.
const SAME: f64 = 1e-12;

/// Which sources are gone through, and how the others follow from them.
pub struct Shared {
    /// Places of those that are.
    pub firsts: Vec<usize>,
    /// For each source the number of its first among those, and how many times as large it is.
    pub of: Vec<(usize, f64)>,
}

impl Shared {
    /// Of all sources of a budget. All that they do is linear in their size.
    pub fn new(sources: &[Source]) -> Shared {
        let mut shared = Shared { firsts: Vec::new(), of: Vec::with_capacity(sources.len()) };
        for (k, source) in sources.iter().enumerate() {
            let known = shared.firsts.iter().enumerate();
            let found = known.filter_map(|(n, first)| Some((n, ratio(&sources[*first], source)?))).next();
            shared.of.push(found.unwrap_or_else(|| {
                shared.firsts.push(k);
                (shared.firsts.len() - 1, 1.0)
            }));
        }
        shared
    }
}

/// How many times as large as the one the other is; `None` unless they are errors of the same coefficient under the same process,
/// same time constants, all second moments in one proportion.
fn ratio(one: &Source, other: &Source) -> Option<f64> {
    let (Kind::Sensor(a), Kind::Sensor(b)) = (&one.kind, &other.kind) else { return None };
    let coefficient = a.instrument() == b.instrument()
        && a.term().name() == b.term().name()
        && a.coefficient() == b.coefficient();
    if !coefficient || one.rounding().is_some() || other.rounding().is_some() {
        return None;
    }
    let (a, b) = (a.evolution().linear_model(), b.evolution().linear_model());
    if a.n != b.n || a.a != b.a {
        return None;
    }
    // Outputs may be scaled in C or in the states.
    let norm = |c: &[f64]| c.iter().map(|c| c * c).sum::<f64>();
    let gain = if a.n == 0 { 1.0 } else { (norm(&b.c[..b.n]) / norm(&a.c[..a.n])).sqrt() };
    let same = |x: f64, y: f64| (x - y).abs() <= SAME * x.abs();
    if !(0..a.n).all(|i| same(gain * a.c[i], b.c[i])) {
        return None;
    }
    let mut pairs = vec![(a.white, b.white)];
    for i in 0..a.n {
        for j in 0..a.n {
            let second = |m: &schuler_imu::process::LinearModel| m.p0[i][j] + m.x0[i] * m.x0[j];
            pairs.push((second(&a), gain * gain * second(&b)));
            pairs.push((a.q[i][j], gain * gain * b.q[i][j]));
        }
    }
    let (x, y) = *pairs.iter().find(|(x, _)| *x != 0.0)?;
    let square = y / x;
    let alike = square > 0.0 && pairs.iter().all(|(x, y)| same(square * x, *y));
    alike.then(|| square.sqrt())
}
