//! Laws that every process obeys, without chance: its exact step against its linear model, its Allan
//! variance and its spectrum, and a step against two of half its length.

use schuler_imu::Evolution;
use schuler_imu::process::Step;

use super::examples::{on_bias, processes};

/// Mean and covariance of (x1, x2).
#[derive(Clone, Copy)]
pub struct Moments {
    pub mean: [f64; 2],
    pub cov: [[f64; 2]; 2],
}

/// Moments at t = 0 of part `part`, from the linear model.
pub fn start(e: &Evolution, part: usize) -> Moments {
    let m = e.linear_model();
    if m.n == 0 {
        // White noise, and quantization with its first error of the integral.
        let x = e.kind.initial(&e.arguments, part, [1.0, 0.0])[0];
        return Moments { mean: [0.0; 2], cov: [[x * x, 0.0], [0.0, 0.0]] };
    }
    let states = m.n / e.kind.parts(&e.arguments);
    let at = |i: usize| (i < states).then_some(part * states + i);
    let pick = |i: usize, j: usize| at(i).zip(at(j)).map_or(0.0, |(i, j)| m.p0[i][j]);
    Moments {
        mean: [0, 1].map(|i| at(i).map_or(0.0, |i| m.x0[i])),
        cov: [0, 1].map(|i| [0, 1].map(|j| pick(i, j))),
    }
}

/// Joint mean and covariance of (x1, x2, y) after a step.
pub fn after(s: &Step, m: &Moments) -> ([f64; 3], [[f64; 3]; 3]) {
    let rows = [s.phi[0], s.phi[1], s.mean];
    let mean = rows.map(|r| r[0] * m.mean[0] + r[1] * m.mean[1]);
    let mut cov = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            for k in 0..2 {
                for l in 0..2 {
                    cov[i][j] += rows[i][k] * m.cov[k][l] * rows[j][l];
                }
            }
            cov[i][j] += (0..3).map(|k| s.noise[i][k] * s.noise[j][k]).sum::<f64>();
        }
    }
    (mean, cov)
}

/// Two steps of which the second is `b`: moments of (x1, x2, mean of both means).
fn twice(a: &Step, b: &Step) -> Step2 {
    let mul = |p: [f64; 2]| [0, 1].map(|j| p[0] * a.phi[0][j] + p[1] * a.phi[1][j]);
    let carry = mul(b.mean);
    let rows = [mul(b.phi[0]), mul(b.phi[1]), [0, 1].map(|j| 0.5 * (a.mean[j] + carry[j]))];
    // Noise of both steps side by side.
    let mut noise = [[0.0; 6]; 3];
    for k in 0..3 {
        for r in 0..2 {
            noise[r][k] = b.phi[r][0] * a.noise[0][k] + b.phi[r][1] * a.noise[1][k];
            noise[r][3 + k] = b.noise[r][k];
        }
        let carried = b.mean[0] * a.noise[0][k] + b.mean[1] * a.noise[1][k];
        noise[2][k] = 0.5 * (a.noise[2][k] + carried);
        noise[2][3 + k] = 0.5 * b.noise[2][k];
    }
    Step2 { rows, noise }
}

struct Step2 {
    rows: [[f64; 2]; 3],
    noise: [[f64; 6]; 3],
}

/// Mean and variance of the difference of two consecutive interval means that follow `n` others.
pub fn difference(e: &Evolution, dt: f64, n: usize) -> (f64, f64) {
    let (mut mean, mut variance) = (0.0, 0.0);
    for part in 0..e.kind.parts(&e.arguments) {
        let s = e.kind.step(&e.arguments, part, dt);
        let mut m = start(e, part);
        for _ in 0..n {
            m = state(&after(&s, &m));
        }
        // y2 - y1 = (mean phi - mean) x + mean (noise of the state) - (noise of y1) + (noise of y2)
        let row = [0, 1].map(|j| s.mean[0] * s.phi[0][j] + s.mean[1] * s.phi[1][j] - s.mean[j]);
        mean += row[0] * m.mean[0] + row[1] * m.mean[1];
        for i in 0..2 {
            for j in 0..2 {
                variance += row[i] * m.cov[i][j] * row[j];
            }
        }
        for k in 0..3 {
            let d = s.mean[0] * s.noise[0][k] + s.mean[1] * s.noise[1][k] - s.noise[2][k];
            variance += d * d + s.noise[2][k] * s.noise[2][k];
        }
    }
    (mean, variance)
}

fn state((mean, cov): &([f64; 3], [[f64; 3]; 3])) -> Moments {
    Moments { mean: [mean[0], mean[1]], cov: [0, 1].map(|i| [cov[i][0], cov[i][1]]) }
}

fn evolution(p: &schuler_imu::Process) -> Evolution {
    on_bias(*p).components().next().unwrap().evolution()
}

fn close(found: f64, expected: f64, scale: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance * scale.max(expected.abs()),
        "{what}: {found:e}, expected {expected:e}"
    );
}

const STEPS: [f64; 6] = [1e-6, 1e-3, 0.1, 1.0, 7.0, 300.0];

#[test]
fn a_step_is_two_of_half_its_length() {
    for (name, p) in processes() {
        let e = evolution(&p);
        for part in 0..e.kind.parts(&e.arguments) {
            for dt in STEPS {
                let whole = e.kind.step(&e.arguments, part, dt);
                let half = e.kind.step(&e.arguments, part, 0.5 * dt);
                let both = twice(&half, &half);
                let rows = [whole.phi[0], whole.phi[1], whole.mean];
                for i in 0..3 {
                    for j in 0..2 {
                        close(both.rows[i][j], rows[i][j], 1e-300, 2e-12, &format!("{name} row {i} {dt}"));
                    }
                    for j in 0..=i {
                        let of = |n: &dyn Fn(usize, usize) -> f64, k: usize| {
                            (0..k).map(|k| n(i, k) * n(j, k)).sum::<f64>()
                        };
                        let found = of(&|r, k| both.noise[r][k], 6);
                        let expected = of(&|r, k| whole.noise[r][k], 3);
                        let scale = (0..3).map(|k| whole.noise[i][k].powi(2)).sum::<f64>().sqrt()
                            * (0..3).map(|k| whole.noise[j][k].powi(2)).sum::<f64>().sqrt();
                        close(found, expected, scale, 1e-11, &format!("{name} covariance {i}{j} {dt}"));
                    }
                }
            }
        }
    }
}

/// The step's joint moments against the linear model, integrated numerically with the integral of
/// the coefficient as a further state.
#[test]
fn the_step_follows_from_the_linear_model() {
    for (name, p) in processes().filter(|(name, _)| !name.starts_with("quantization")) {
        let e = evolution(&p);
        let model = e.linear_model();
        let parts = e.kind.parts(&e.arguments);
        for dt in [0.01, 0.3, 2.0] {
            // Joint covariance of the sum of all parts' means and its variance, from the steps.
            let (mut mean, mut variance) = (0.0, 0.0);
            for part in 0..parts {
                let s = e.kind.step(&e.arguments, part, dt);
                let (m, c) = after(&s, &state(&after(&s, &start(&e, part))));
                mean += m[2];
                variance += c[2][2];
            }
            let (expected_mean, expected_variance) = second_mean(&model, dt);
            close(mean, expected_mean, 1e-12, 1e-9, &format!("{name} mean {dt}"));
            close(variance, expected_variance, 1e-12, 1e-8, &format!("{name} variance {dt}"));
        }
    }
}

/// Mean and variance of the coefficient's mean from dt to 2 dt, by Runge-Kutta on the moments.
fn second_mean(model: &schuler_imu::process::LinearModel, dt: f64) -> (f64, f64) {
    let n = model.n;
    let steps = 2000;
    let h = dt / f64::from(steps);
    let mut x = vec![0.0; n + 1];
    let mut p = vec![vec![0.0; n + 1]; n + 1];
    x[..n].copy_from_slice(&model.x0[..n]);
    (0..n).for_each(|i| p[i][..n].copy_from_slice(&model.p0[i][..n]));
    let a = |i: usize, j: usize| match (i < n, j < n) {
        (true, true) => model.a[i][j],
        (false, true) => model.c[j],
        _ => 0.0,
    };
    let q = |i: usize, j: usize| match (i < n, j < n) {
        (true, true) => model.q[i][j],
        (false, false) => model.white,
        _ => 0.0,
    };
    let dx = |x: &[f64]| -> Vec<f64> { (0..=n).map(|i| (0..=n).map(|j| a(i, j) * x[j]).sum()).collect() };
    let dp = |p: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let half = |i: usize, j: usize| (0..=n).map(|k| a(i, k) * p[k][j]).sum::<f64>();
        (0..=n).map(|i| (0..=n).map(|j| half(i, j) + half(j, i) + q(i, j)).collect()).collect()
    };
    let axpy =
        |x: &[f64], k: &[f64], h: f64| -> Vec<f64> { x.iter().zip(k).map(|(x, k)| x + h * k).collect() };
    let axpy2 = |p: &[Vec<f64>], k: &[Vec<f64>], h: f64| -> Vec<Vec<f64>> {
        p.iter().zip(k).map(|(p, k)| axpy(p, k, h)).collect()
    };
    for interval in 0..2 {
        if interval == 1 {
            // The integral begins again.
            x[n] = 0.0;
            for i in 0..=n {
                p[i][n] = 0.0;
                p[n][i] = 0.0;
            }
        }
        for _ in 0..steps {
            let k1 = dx(&x);
            let k2 = dx(&axpy(&x, &k1, 0.5 * h));
            let k3 = dx(&axpy(&x, &k2, 0.5 * h));
            let k4 = dx(&axpy(&x, &k3, h));
            for i in 0..=n {
                x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
            let k1 = dp(&p);
            let k2 = dp(&axpy2(&p, &k1, 0.5 * h));
            let k3 = dp(&axpy2(&p, &k2, 0.5 * h));
            let k4 = dp(&axpy2(&p, &k3, h));
            for i in 0..=n {
                for j in 0..=n {
                    p[i][j] += h / 6.0 * (k1[i][j] + 2.0 * k2[i][j] + 2.0 * k3[i][j] + k4[i][j]);
                }
            }
        }
    }
    (x[n] / dt, p[n][n] / (dt * dt))
}

/// Half the mean square difference of two consecutive interval means, at once and after a while.
#[test]
fn allan_variance_follows_from_the_step() {
    for (name, p) in processes().filter(|(name, _)| !name.contains("phase")) {
        let e = evolution(&p);
        for tau in [1e-4, 0.01, 0.2, 1.0, 5.0, 40.0, 1000.0] {
            for n in [0, 3] {
                let (mean, variance) = difference(&e, tau, n);
                let found = 0.5 * (mean * mean + variance);
                let expected = e.allan_variance(tau);
                close(found, expected, 1e-14, 1e-9, &format!("{name} {tau} {n}"));
            }
        }
    }
}

/// 4 times the integral over f of S(f) sin(pi f tau)^4/(pi f tau)^2 (IEEE Std 952, annex C).
#[test]
fn allan_variance_follows_from_the_spectrum() {
    for (name, p) in processes() {
        let e = evolution(&p);
        if e.kind.name() == "constant" || e.spectrum(1.0).is_none() {
            continue;
        }
        for tau in [0.05, 1.0, 20.0] {
            let integrand = |x: f64| {
                let f = x / (std::f64::consts::PI * tau);
                e.spectrum(f).unwrap() * (x.sin() * x.sin() / x).powi(2)
            };
            // Simpson in x = pi f tau up to 200 periods, then the mean of sin^4 over a falling density.
            let (end, n) = (200.0 * std::f64::consts::PI, 400_000);
            let h = end / f64::from(n);
            let sum: f64 = (1..n)
                .map(|k| (if k % 2 == 1 { 4.0 } else { 2.0 }) * integrand(f64::from(k) * h))
                .sum::<f64>();
            // sin(x)^4/x^2 vanishes at 0 against every density but that of a walk, 1/x^2.
            let zero = integrand(1e-9);
            let end_density = e.spectrum(end / (std::f64::consts::PI * tau)).unwrap();
            let tail = 0.375 * end_density / end;
            let found = 4.0 / (std::f64::consts::PI * tau) * ((sum + zero) * h / 3.0 + tail);
            close(found, e.allan_variance(tau), 0.0, 2e-4, &format!("{name} {tau}"));
        }
    }
}

/// Flat at 0.664283 B within 1 % over the band, for narrow and wide bands.
#[test]
fn flicker_is_flat_over_its_band() {
    let kind = schuler_imu::process_kind("flicker").unwrap();
    for decades in [0.0, 0.5, 1.0, 2.0, 3.3, 5.0, 6.1, 8.0] {
        let band = [2.0, 2.0 * 10f64.powf(decades)];
        let p = schuler_imu::Process::new(
            kind,
            &[("instability", 3.0.into()), ("tau_min", band[0].into()), ("tau_max", band[1].into())],
        )
        .unwrap();
        let e = evolution(&p);
        for k in 0..=200 {
            let tau = band[0] * 10f64.powf(decades * f64::from(k) / 200.0);
            let flat = 3.0 * (2.0 * 2f64.ln() / std::f64::consts::PI).sqrt();
            close(e.allan_variance(tau).sqrt(), flat, 0.0, 0.01, &format!("{decades} decades, tau {tau}"));
        }
    }
}
