use nalgebra::DMatrix;

use crate::Term;

/// Covariances between overlapping Allan variances at several averaging times, as a quadratic form in the powers
/// of the terms: Cov(s_i², s_j²) = sum over p, q of power_p power_q table\[p, q\]\[i, j\].
///
/// For Gaussian noise Cov = 2 / (4 tau_i² tau_j² M_i M_j) times the sum over all pairs of second differences of their
/// squared covariance, which depends on the lag alone; a deterministic term enters only by its product with a
/// random one. No approximation but the sum over lags, which is exact near its kinks and geometric between.
///
/// Differences that start every m/8 samples lose next to nothing of noise that is correlated over an averaging time. Of
/// quantization they lose what they leave out: its differences correlate only where they share a sample, so that of two
/// estimates the denser one counts, and products with it grow by its stride.
#[derive(Debug, Clone)]
pub(crate) struct CovarianceTable {
    terms: Vec<Term>,
    /// Upper triangle of term pairs, row by row.
    tables: Vec<DMatrix<f64>>,
}

/// The overlapping estimates that covariances are for.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub factors: Vec<usize>,
    /// Differences start every so many samples: 1 for full overlap.
    pub strides: Vec<usize>,
    pub n_phase: usize,
    pub tau0: f64,
}

impl CovarianceTable {
    /// Table for all pairs of `terms`.
    pub fn new(layout: &Layout, terms: &[Term]) -> Self {
        Self { terms: Vec::new(), tables: Vec::new() }.with(layout, terms)
    }

    /// The table with more terms; only pairs that hold a new one are computed.
    pub fn with(&self, layout: &Layout, more: &[Term]) -> Self {
        let old = self.terms.len();
        let terms: Vec<Term> = self.terms.iter().chain(more).copied().collect();
        let n = layout.factors.len();
        let pairs = terms.len() * (terms.len() + 1) / 2;
        let mut tables = vec![DMatrix::zeros(n, n); pairs];
        let mut c = vec![0.0; terms.len()];
        for i in 0..n {
            for j in i..n {
                let (mi, mj) = (layout.factors[i], layout.factors[j]);
                let (count_i, count_j) = (layout.n_phase - 2 * mi, layout.n_phase - 2 * mj);
                let (tau_i, tau_j) = (mi as f64 * layout.tau0, mj as f64 * layout.tau0);
                let scale = 2.0 / (4.0 * (tau_i * tau_j).powi(2) * count_i as f64 * count_j as f64);
                // A new sinusoid needs no sum.
                let sparse = layout.strides[i].min(layout.strides[j]) as f64;
                let sums = more.iter().any(|t| summed(*t, Term::White));
                for (lag, weight) in if sums { lags(mi, mj, count_i, count_j) } else { Vec::new() } {
                    let pairs_at_lag = (count_i as i64).min(count_j as i64 - lag) - 0.max(-lag);
                    let w = scale * weight * pairs_at_lag as f64;
                    // Sinusoids are not summed.
                    for (c, term) in c.iter_mut().zip(&terms).filter(|(_, t)| summed(**t, Term::White)) {
                        *c = difference_covariance(*term, mi, mj, lag, layout.tau0);
                    }
                    let mut k = 0;
                    for p in 0..terms.len() {
                        for q in p..terms.len() {
                            if q >= old && summed(terms[p], terms[q]) {
                                let quantized = [terms[p], terms[q]].contains(&Term::Quantization);
                                let stride = if quantized { sparse } else { 1.0 };
                                tables[k][(i, j)] += stride * w * c[p] * c[q];
                            }
                            k += 1;
                        }
                    }
                }
                let mut k = 0;
                for p in 0..terms.len() {
                    for q in p..terms.len() {
                        if q >= old {
                            tables[k][(i, j)] += with_sinusoid(terms[p], terms[q], tau_i, tau_j, layout);
                        }
                        k += 1;
                    }
                }
                for table in &mut tables {
                    table[(j, i)] = table[(i, j)];
                }
            }
        }
        let mut k = 0;
        let mut known = self.tables.iter();
        for p in 0..terms.len() {
            for q in p..terms.len() {
                if q < old
                    && let Some(table) = known.next()
                {
                    tables[k].clone_from(table);
                }
                k += 1;
            }
        }
        Self { terms, tables }
    }

    /// Covariance for these powers, one per term of the table.
    pub fn at(&self, powers: &[f64]) -> DMatrix<f64> {
        let n = self.tables[0].nrows();
        let mut v = DMatrix::zeros(n, n);
        let mut k = 0;
        for p in 0..self.terms.len() {
            for q in p..self.terms.len() {
                let weight = powers[p] * powers[q] * if p == q { 1.0 } else { 2.0 };
                if weight != 0.0 {
                    v.zip_apply(&self.tables[k], |a, b| *a += weight * b);
                }
                k += 1;
            }
        }
        v
    }
}

/// Is the pair summed over lags? Two deterministic terms do not scatter.
fn summed(p: Term, q: Term) -> bool {
    let line = |t| matches!(t, Term::Sinusoid { .. });
    (p.is_random() || q.is_random()) && !line(p) && !line(q)
}

/// Share of a sinusoid with a random term, per unit of both powers. Only noise at its own frequency beats with it:
/// Var(A²)/A⁴ = 8 S(f0) / (A² T), fully correlated between averaging times.
fn with_sinusoid(p: Term, q: Term, tau_i: f64, tau_j: f64, layout: &Layout) -> f64 {
    let (line, noise, f0) = match (p, q) {
        (Term::Sinusoid { f0 }, noise) => (p, noise, f0),
        (noise, Term::Sinusoid { f0 }) => (q, noise, f0),
        _ => return 0.0,
    };
    let length = layout.n_phase as f64 * layout.tau0;
    noise.spectrum(f0, layout.tau0).map_or(0.0, |s| {
        // The quadratic form counts the pair twice.
        4.0 * line.allan_variance(tau_i) * line.allan_variance(tau_j) * s / length
    })
}

/// Covariance of x[k+2a] - 2 x[k+a] + x[k] with x[l+2b] - 2 x[l+b] + x[l] at l - k = `lag`, power 1.
fn difference_covariance(term: Term, a: usize, b: usize, lag: i64, tau0: f64) -> f64 {
    let (a, b) = (a as i64, b as i64);
    if term == Term::Ramp {
        // Second differences of a parabola are constant.
        return ((a * b) as f64 * tau0 * tau0).powi(2);
    }
    let mut sum = 0.0;
    for (i, wi) in [(0, 1.0), (1, -2.0), (2, 1.0)] {
        for (j, wj) in [(0, 1.0), (1, -2.0), (2, 1.0)] {
            sum += wi * wj * term.phase_covariance((lag + j * b - i * a) as f64 * tau0);
        }
    }
    sum
}

/// Lags between differences at distances `a` and `b` with the number of lags each stands for: every lag near the
/// kinks of the covariance, panels growing by a quarter of the distance to the next kink between them.
fn lags(a: usize, b: usize, count_a: usize, count_b: usize) -> Vec<(i64, f64)> {
    let (a, b) = (a as i64, b as i64);
    let reach = 32 * (a + b);
    let (first, last) = (-(count_a as i64 - 1).min(reach), (count_b as i64 - 1).min(reach));
    let mut kinks: Vec<i64> = (0..3).flat_map(|i| (0..3).map(move |j| i * a - j * b)).collect();
    kinks.extend([0, count_b as i64 - count_a as i64]);
    kinks.retain(|k| *k > first && *k < last);
    kinks.extend([first, last]);
    kinks.sort_unstable();
    kinks.dedup();
    let mut out = vec![(first, 1.0)];
    for w in kinks.windows(2) {
        // Lags first+1 ..= last belong to the segment that ends at them.
        let (low, high) = (w[0], w[1]);
        let mut from = low + 1;
        while from < high {
            let distance = (from - low).min(high - from);
            // Odd, so that the middle is a lag.
            let width = ((distance / 4) | 1).min((high - from - 1) | 1);
            out.push((from + width / 2, width as f64));
            from += width;
        }
        out.push((high, 1.0));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cov of two estimates by the definition: the sum over all pairs of differences, lag by lag.
    fn by_definition(terms: &[Term], layout: &Layout, i: usize, j: usize) -> f64 {
        let (mi, mj) = (layout.factors[i], layout.factors[j]);
        let (ci, cj) = (layout.n_phase - 2 * mi, layout.n_phase - 2 * mj);
        let mut sum = 0.0;
        for k in 0..ci as i64 {
            for l in 0..cj as i64 {
                let (mut random, mut fixed) = (0.0, 0.0);
                for t in terms {
                    let c = difference_covariance(*t, mi, mj, l - k, layout.tau0);
                    if t.is_random() { random += c } else { fixed += c }
                }
                sum += 2.0 * ((random + fixed).powi(2) - fixed * fixed);
            }
        }
        let scale = 4.0 * ((mi * mj) as f64 * layout.tau0.powi(2)).powi(2) * ci as f64 * cj as f64;
        sum / scale
    }

    #[test]
    fn the_sum_over_lags_is_that_over_all_pairs() {
        let layout = Layout { factors: vec![1, 2, 8, 32, 100], strides: vec![1; 5], n_phase: 401, tau0: 0.5 };
        let sets: [&[Term]; 4] = [
            &[Term::White],
            &[Term::Flicker, Term::RandomWalk],
            &[Term::Quantization, Term::White, Term::Ramp],
            &[Term::Markov { tau: 20.0 }],
        ];
        for terms in sets {
            let v = CovarianceTable::new(&layout, terms).at(&vec![1.0; terms.len()]);
            for i in 0..5 {
                for j in 0..5 {
                    let want = by_definition(terms, &layout, i, j);
                    let whole = (v[(i, i)] * v[(j, j)]).sqrt();
                    let off = (v[(i, j)] - want).abs() / whole;
                    assert!(off < 0.004, "{terms:?} {i} {j}: {}, definition {want}", v[(i, j)]);
                }
            }
        }
    }

    #[test]
    fn the_diagonal_is_what_the_degrees_of_freedom_say() {
        let layout =
            Layout { factors: vec![1, 16, 512, 8192], strides: vec![1; 4], n_phase: 32_769, tau0: 0.1 };
        for (term, noise) in [
            (Term::Quantization, crate::NoiseType::Quantization),
            (Term::White, crate::NoiseType::White),
            (Term::Flicker, crate::NoiseType::Flicker),
            (Term::RandomWalk, crate::NoiseType::RandomWalk),
        ] {
            let v = CovarianceTable::new(&layout, &[term]).at(&[1.0]);
            for (i, m) in layout.factors.iter().enumerate() {
                let got = 2.0 * term.allan_variance(*m as f64 * layout.tau0).powi(2) / v[(i, i)];
                let want = crate::edf(crate::Estimator::Overlapping, noise, *m, layout.n_phase);
                assert!((got / want - 1.0).abs() < 0.01, "{term:?} m={m}: {got}, {want}");
            }
        }
    }

    /// A sinusoid of amplitude A in white noise: rms error of A² / A² = sqrt(8 N² / (A² T)).
    #[test]
    fn a_sinusoid_scatters_with_the_noise_at_its_frequency() {
        let layout = Layout { factors: vec![4, 8], strides: vec![1; 2], n_phase: 10_001, tau0: 0.1 };
        let (line, n2, a2) = (Term::Sinusoid { f0: 1.0 }, 0.01, 4.0);
        let table = CovarianceTable::new(&layout, &[Term::White, line]);
        let beat = table.at(&[n2, a2])[(0, 1)] - table.at(&[n2, 0.0])[(0, 1)];
        let product = line.allan_variance(0.4) * line.allan_variance(0.8) * a2 * a2;
        assert!((beat / product / (8.0 * n2 / (a2 * 1000.1)) - 1.0).abs() < 1e-9);
    }
}
