//! Somigliana's normal gravity and its derivatives, as kernels without division or square root.

use crate::Real;
use crate::wgs84::{A, E2, F, GAMMA_E, K, M};

/// Magnitude of gravity, m/s², from sin² L, height h (m) and [`w`](crate::wgs84::w) = 1 / sqrt(1 - e² sin² L):
///
/// gamma_e (1 + k sin² L) w [1 - (2 / a)(1 + f + m - 2 f sin² L) h + 3 h² / a²].
///
/// Source: NIMA TR8350.2, chapter 4.
#[inline(always)]
pub fn gamma<S: Real>(sin2: S, h: S, w: S) -> S {
    surface(sin2, w) * height_factor(sin2, h)
}

/// (d gamma/dL, d gamma/dh): change of gravity with latitude, m/s² per rad, and with height, 1/s².
/// Analytic derivatives of [`gamma`].
#[inline(always)]
pub fn gradient<S: Real>(sin_lat: S, cos_lat: S, h: S, w: S) -> (S, S) {
    let sin2 = sin_lat * sin_lat;
    let surface = surface(sin2, w);
    // d w / d sin² = e² w³ / 2
    let dsurface = (w * K + (sin2 * K + 1.0) * w * w * w * (0.5 * E2)) * GAMMA_E;
    let dsin2 = dsurface * height_factor(sin2, h) + surface * h * (4.0 * F / A);
    let dh = surface * (sin2 * (4.0 * F / A) + h * (6.0 / (A * A)) - 2.0 * (1.0 + F + M) / A);
    (dsin2 * sin_lat * cos_lat * 2.0, dh)
}

#[inline(always)]
fn surface<S: Real>(sin2: S, w: S) -> S {
    (sin2 * K + 1.0) * w * GAMMA_E
}

#[inline(always)]
fn height_factor<S: Real>(sin2: S, h: S) -> S {
    (sin2 * (4.0 * F / A) + h * (3.0 / (A * A)) - 2.0 * (1.0 + F + M) / A) * h + 1.0
}
