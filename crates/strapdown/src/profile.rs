//! The Earth along the meridian near an anchor, by the sine of the latitude: smooth at the poles.

use schuler_frames::{Geodetic, Gravity, Real, somigliana, wgs84};

/// Radii and gravity as short series in the sine of the latitude and the height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Profile<S> {
    sin_lat: S,
    h: S,
    /// R_M on the ellipsoid, its first and half its second derivative with sin L, m.
    r_m: [S; 3],
    /// The first and half the second derivative of R_N, m.
    r_n_slope: [S; 2],
    /// 1/(R_M + h), 1/(R_N + h).
    per_r_m: S,
    per_r_n: S,
    /// Gravity north over cos L: value, change with sin L, with height.
    g_level: [S; 3],
    /// Gravity down: value, change with sin L and with height, halves of the second derivatives ss and hh, and sh.
    g_d: [S; 6],
}

/// The Earth at one place near the anchor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level<S> {
    pub per_r_n: S,
    /// (R_N - R_M) / (cos² L (R_M + h) (R_N + h)), 1/m.
    pub bulge: S,
    /// Gravity north over cos L, and down, m/s².
    pub g_level: S,
    pub g_d: S,
}

impl Profile<f64> {
    /// About the latitude `lat` (rad) and the height `h` (m).
    pub fn new(lat: f64, h: f64, gravity: Gravity) -> Self {
        let (s, c) = libm::sincos(lat);
        let w = wgs84::w(s);
        let (r_m, r_n) = (wgs84::r_m(s), wgs84::r_n(s));
        let bend = wgs84::A * wgs84::E2;
        // By symmetry all derivatives with latitude vanish at a pole as cos L does. Closer to it than a
        // centimetre their quotients are rounding, and no way from there makes that count.
        let per_c = 1.0 / c.max(1e-9);
        let position = Geodetic::new(lat, 0.0, h);
        let g = gravity.gravity_t(position);
        let (dlat, dh) = gravity.gradient_t(position);
        let level = g[0] * per_c;
        // d(g_N / cos L)/d sin L = (dg_N/dL + g_N tan L) / cos² L; at a pole g_N goes as sin L cos L.
        let level_slope = if c > 1e-4 { (dlat[0] + g[0] * s * per_c) * per_c * per_c } else { level / s };
        let dgamma_dh = |s: f64| somigliana::gradient(s, 1.0, h, wgs84::w(s)).1;
        Profile {
            sin_lat: s,
            h,
            r_m: [r_m, 3.0 * r_m * wgs84::E2 * s * w * w, 1.5 * bend],
            r_n_slope: [r_n * wgs84::E2 * s * w * w, 0.5 * bend],
            per_r_m: 1.0 / (r_m + h),
            per_r_n: 1.0 / (r_n + h),
            g_level: [level, level_slope, dh[0] * per_c],
            g_d: [
                g[2],
                dlat[2] * per_c,
                dh[2],
                wgs84::GAMMA_E * (wgs84::K + 0.5 * wgs84::E2),
                3.0 * g[2] / (wgs84::A * wgs84::A),
                (dgamma_dh(s + 1e-3) - dgamma_dh(s - 1e-3)) / 2e-3,
            ],
        }
    }
}

impl<S: Real> Profile<S> {
    /// The Earth at the sine `sin_lat` of the latitude, `dh` (m) above the anchor.
    #[inline(always)]
    pub fn near(&self, sin_lat: S, dh: S) -> Level<S> {
        let ds = sin_lat - self.sin_lat;
        let r_m_change = (self.r_m[1] + ds * self.r_m[2]) * ds;
        let x = (r_m_change + dh) * self.per_r_m;
        let y = ((self.r_n_slope[0] + ds * self.r_n_slope[1]) * ds + dh) * self.per_r_n;
        let per_r_m = self.per_r_m - self.per_r_m * (x - x * x);
        let per_r_n = self.per_r_n - self.per_r_n * (y - y * y);
        Level {
            per_r_n,
            bulge: (self.r_m[0] + r_m_change) * (wgs84::E2 / (1.0 - wgs84::E2)) * per_r_m * per_r_n,
            g_level: self.g_level[0] + ds * self.g_level[1] + dh * self.g_level[2],
            g_d: self.g_d[0]
                + ds * (self.g_d[1] + ds * self.g_d[3])
                + dh * (self.g_d[2] + dh * self.g_d[4] + ds * self.g_d[5]),
        }
    }
}
