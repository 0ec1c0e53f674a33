//! Exact gravitation of the level ellipsoid.
//!
//! In the ellipsoidal coordinates (u, beta) confocal with the ellipsoid (linear eccentricity E,
//! p² = (u² + E²) cos² beta, z = u sin beta) the potential is
//!
//! V = (GM / E) atan(E / u) + (OMEGA² a² / 2) (q / q0) (sin² beta - 1/3),
//! q = ((1 + 3 u² / E²) atan(E / u) - 3 u / E) / 2, q0 = q at u = b.
//!
//! Source: Heiskanen and Moritz, Physical Geodesy (1967), chapter 2. The closed form
//! of q cancels eleven digits on the Earth, so it is evaluated by its power series in (E / u)²
//! = 0.0067, which has converged to the last bit after eight terms:
//! q = sum over n ≥ 1 of (-1)^(n+1) 2n / ((2n + 1)(2n + 3)) (E / u)^(2n+1).

use crate::wgs84::{A, B, E2, GM, OMEGA};

/// Square of the linear eccentricity E² = a² e², m².
const LINEAR_E2: f64 = A * A * E2;
const TERMS: usize = 8;

/// Coefficients of q / t³ and of -u (dq/du) / t³ in powers of t², t = E / u.
const SERIES: ([f64; TERMS], [f64; TERMS]) = {
    let (mut q, mut dq) = ([0.0; TERMS], [0.0; TERMS]);
    let mut i = 0;
    let mut sign = 1.0;
    while i < TERMS {
        let n = (i + 1) as f64;
        dq[i] = sign * 2.0 * n / (2.0 * n + 3.0);
        q[i] = dq[i] / (2.0 * n + 1.0);
        sign = -sign;
        i += 1;
    }
    (q, dq)
};

const fn horner(c: &[f64; TERMS], x: f64) -> f64 {
    let mut sum = 0.0;
    let mut i = TERMS;
    while i > 0 {
        i -= 1;
        sum = sum * x + c[i];
    }
    sum
}

/// OMEGA² a² b³ / (q0 / t0³): what turns a value of the series into K = OMEGA² a² q / q0 times u³.
const SCALE: f64 = OMEGA * OMEGA * A * A * B * B * B / horner(&SERIES.0, LINEAR_E2 / (B * B));

/// Gravitation at a Cartesian position whose z axis is the axis of the ellipsoid, m to m/s².
///
/// Components are formed without a division by p or cos beta, so nothing happens at the poles.
pub(super) fn gravitation([x, y, z]: [f64; 3]) -> [f64; 3] {
    let zz = z * z;
    let d = x * x + y * y + zz - LINEAR_E2;
    let uu = 0.5 * (d + libm::sqrt(d * d + 4.0 * LINEAR_E2 * zz));
    let u = libm::sqrt(uu);
    let vv = uu + LINEAR_E2;
    let (sin, sin2) = (z / u, zz / uu);
    let cos2 = (x * x + y * y) / vv;

    let t2 = LINEAR_E2 / uu;
    let scale = SCALE / (uu * u);
    // dV/dbeta = k sin beta cos beta
    let k = scale * horner(&SERIES.0, t2);
    let dv_du = -GM / vv - 0.5 * scale / u * horner(&SERIES.1, t2) * (sin2 - 1.0 / 3.0);

    let metric = 1.0 / (uu + LINEAR_E2 * sin2);
    let radial = (dv_du * u - k * sin2) * metric;
    let axial = sin * (dv_du * vv + k * cos2 * u) * metric;
    [radial * x, radial * y, axial]
}
