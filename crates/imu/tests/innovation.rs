//! One normal for each interval mean is as good as the three of the exact step: without chance, the
//! covariances of all interval means agree, and the innovations settle.

use schuler_imu::Evolution;
use schuler_imu::process::{Innovation, SETTLED, Step};

use super::examples::{on_bias, processes};

const N: usize = 12;
/// Step lengths, s: equal ones, then shorter and longer by far.
const LENGTHS: [f64; N] = [0.1, 0.1, 0.1, 0.1, 2e-3, 2e-3, 2e-3, 5.0, 0.1, 0.3, 40.0, 0.1];

fn parts() -> Vec<(String, Evolution, usize)> {
    let mut parts = Vec::new();
    for (name, process) in processes() {
        let e = on_bias(process).components().next().unwrap().evolution();
        parts.extend((0..e.kind.parts(&e.arguments)).map(|part| (name.clone(), e, part)));
    }
    parts
}

/// Combinations of `M` independent normals.
type Row<const M: usize> = [f64; M];

fn combine<const M: usize>(a: [f64; 2], x: &[Row<M>; 2]) -> Row<M> {
    std::array::from_fn(|j| a[0] * x[0][j] + a[1] * x[1][j])
}

/// Covariance of two combinations.
fn dot<const M: usize>(a: &Row<M>, b: &Row<M>) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// All interval means from three normals a step.
fn from_steps(steps: &[Step; N]) -> [Row<{ 3 * N }>; N] {
    let mut x = [[0.0; 3 * N]; 2];
    std::array::from_fn(|k| {
        let s = &steps[k];
        let mut rows = [combine(s.phi[0], &x), combine(s.phi[1], &x), combine(s.mean, &x)];
        for (row, noise) in rows.iter_mut().zip(s.noise) {
            (0..3).for_each(|j| row[3 * k + j] += noise[j]);
        }
        x = [rows[0], rows[1]];
        rows[2]
    })
}

/// All interval means from one normal a step.
fn from_innovations(steps: &[Step; N]) -> [Row<N>; N] {
    let (mut x, mut covariance) = ([[0.0; N]; 2], [0.0; 3]);
    std::array::from_fn(|k| {
        let s = &steps[k];
        let now = s.innovation(&covariance);
        let mut y = combine(s.mean, &x);
        y[k] += now.s;
        x = [combine(s.phi[0], &x), combine(s.phi[1], &x)];
        (0..2).for_each(|r| x[r][k] += now.k[r]);
        covariance = now.covariance;
        y
    })
}

#[test]
fn interval_means_have_the_covariance_of_the_exact_step() {
    for (name, e, part) in parts() {
        let steps = LENGTHS.map(|dt| e.kind.step(&e.arguments, part, dt));
        let (exact, found) = (from_steps(&steps), from_innovations(&steps));
        for i in 0..N {
            for j in 0..=i {
                let scale = (dot(&exact[i], &exact[i]) * dot(&exact[j], &exact[j])).sqrt();
                let (a, b) = (dot(&exact[i], &exact[j]), dot(&found[i], &found[j]));
                assert!(
                    (a - b).abs() <= 1e-12 * scale,
                    "{name} part {part}, means {i} and {j}: {b:e}, {a:e}"
                );
            }
        }
    }
}

/// From states that are known, and from states left uncertain by much shorter or longer steps.
#[test]
fn innovations_settle() {
    let after = |step: &Step, mut covariance: [f64; 3], n: u32| {
        let mut now = Innovation::default();
        for _ in 0..n {
            now = step.innovation(&covariance);
            covariance = now.covariance;
        }
        now
    };
    for (name, e, part) in parts() {
        let step_of = |dt: f64| e.kind.step(&e.arguments, part, dt);
        for dt in [1e-6, 1e-3, 0.1, 1.0, 7.0, 300.0] {
            for before in [0.0, 1e-3, 1e3] {
                let start = if before > 0.0 {
                    after(&step_of(before * dt), [0.0; 3], 50).covariance
                } else {
                    [0.0; 3]
                };
                let step = step_of(dt);
                let [soon, late] = [SETTLED + 1, 5 * SETTLED].map(|n| after(&step, start, n));
                let same = |a: f64, b: f64| (a - b).abs() <= 1e-13 * b.abs();
                let all = same(soon.s, late.s) && same(soon.k[0], late.k[0]) && same(soon.k[1], late.k[1]);
                assert!(all, "{name} part {part}, dt {dt}, before {before}: {soon:?} {late:?}");
            }
        }
    }
}
