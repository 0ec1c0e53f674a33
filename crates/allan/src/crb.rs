use nalgebra::{Cholesky, DMatrix};

use crate::Term;

/// Frequencies up to this one are summed singly; above, in groups that grow in proportion.
const SINGLY: usize = 2048;

/// Cramér-Rao bound of the relative standard deviation of each coefficient (not power) of a log of `n` rate
/// samples at `tau0` seconds, all other random terms unknown too.
///
/// From the Fisher information of the spectrum at f_k = k/T, k = 1 .. n/2, where T = n tau0:
/// I_ij = sum over k of (d ln S/d ln c_i)(d ln S/d ln c_j). Terms that are not random get `None`: they add no
/// spectrum, and their bound does not limit the others.
#[must_use]
pub fn cramer_rao(terms: &[Term], powers: &[f64], n: usize, tau0: f64) -> Vec<Option<f64>> {
    let random: Vec<usize> = (0..terms.len()).filter(|i| terms[*i].is_random()).collect();
    let mut information = DMatrix::<f64>::zeros(random.len(), random.len());
    let last = n / 2;
    let mut k = 1;
    while k <= last {
        let group = if k < SINGLY { 1 } else { (k / 512).min(last + 1 - k) };
        let f = (k as f64 + (group - 1) as f64 / 2.0) / (n as f64 * tau0);
        let parts: Vec<f64> =
            random.iter().map(|i| powers[*i] * terms[*i].spectrum(f, tau0).unwrap_or(0.0)).collect();
        let whole: f64 = parts.iter().sum();
        for i in 0..random.len() {
            for j in 0..random.len() {
                // A coefficient enters as its square: d ln S / d ln c = 2 share.
                information[(i, j)] += group as f64 * 4.0 * parts[i] * parts[j] / (whole * whole);
            }
        }
        k += group;
    }
    let bound = Cholesky::new(information).map(|c| c.inverse());
    let mut out = vec![None; terms.len()];
    for (place, i) in random.iter().enumerate() {
        out[*i] = Some(bound.as_ref().map_or(f64::INFINITY, |b| b[(place, place)].sqrt()));
    }
    out
}
