//! The place about which a navigator expands radii, gravity and the trigonometry of the latitude.

use schuler_frames::{Geodetic, Gravity, Real, somigliana, wgs84};

use crate::kernel::Sum;

/// A place, and what the Earth looks like near it as short series in the way gone since.
///
/// Radii, gravity, sine, cosine and secant of the latitude change so slowly that a series about a
/// place passed half a second ago is exact to rounding for anything that flies. So a step needs no
/// division, root or trigonometry, and its own arithmetic never feeds back into them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Anchor<S> {
    pub lat: Sum<S>,
    pub lon: Sum<S>,
    pub h: Sum<S>,
    sin_lat: S,
    cos_lat: S,
    /// Coefficients of sec L in powers of the way gone in latitude.
    sec: [S; 4],
    /// 1/(R_M + h), 1/(R_N + h).
    pub per_r_m: S,
    per_r_n: S,
    /// First and half the second derivative of R_M and R_N with latitude.
    r_m_slope: [S; 2],
    r_n_slope: [S; 2],
    /// Gravity north: value, change with latitude, with height.
    g_n: [S; 3],
    /// Gravity down: value, change with latitude and with height, halves of the second derivatives LL, hh and Lh.
    g_d: [S; 6],
}

/// The Earth at one place near the anchor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near<S> {
    pub sin_lat: S,
    pub cos_lat: S,
    pub sec_lat: S,
    pub per_r_m: S,
    pub per_r_n: S,
    pub g_n: S,
    pub g_d: S,
}

impl Anchor<f64> {
    pub fn new(position: Geodetic, gravity: Gravity) -> Self {
        let Geodetic { lat, lon, h } = position;
        let mut anchor = Anchor {
            lat: Sum::new(lat),
            lon: Sum::new(lon),
            h: Sum::new(h),
            sin_lat: 0.0,
            cos_lat: 0.0,
            sec: [0.0; 4],
            per_r_m: 0.0,
            per_r_n: 0.0,
            r_m_slope: [0.0; 2],
            r_n_slope: [0.0; 2],
            g_n: [0.0; 3],
            g_d: [0.0; 6],
        };
        anchor.expand(gravity);
        anchor
    }

    /// Moves the anchor by `(dlat, dlon, dh)` (rad, rad, m) and expands about the new place.
    pub fn move_by(&mut self, [dlat, dlon, dh]: [f64; 3], gravity: Gravity) {
        self.lat.add(dlat);
        self.lon.add(dlon);
        self.h.add(dh);
        self.expand(gravity);
    }

    fn expand(&mut self, gravity: Gravity) {
        let position = Geodetic::new(self.lat.value(), self.lon.value(), self.h.value());
        let h = position.h;
        let (s, c) = libm::sincos(position.lat);
        let (t, w) = (s / c, wgs84::w(s));
        (self.sin_lat, self.cos_lat) = (s, c);
        self.sec = [1.0 / c, t / c, (0.5 + t * t) / c, (5.0 / 6.0 + t * t) * t / c];
        let (r_m, r_n) = (wgs84::r_m(s), wgs84::r_n(s));
        self.per_r_m = 1.0 / (r_m + h);
        self.per_r_n = 1.0 / (r_n + h);
        // The second derivatives to first order in e²: they make centimetres in half a second of flight.
        let half_bend = 0.5 * wgs84::A * wgs84::E2 * (c * c - s * s);
        self.r_m_slope = [3.0 * r_m * wgs84::E2 * s * c * w * w, 3.0 * half_bend];
        self.r_n_slope = [(r_n - r_m) * t, half_bend];
        let g = gravity.gravity_t(position);
        let (dlat, dh) = gravity.gradient_t(position);
        self.g_n = [g[0], dlat[0], dh[0]];
        // The second derivatives move gravity by some 1e-10 m/s² in half a second of flight: the terms
        // of Somigliana's formula in sin² L and of the series in height serve both models.
        let (dlat_above, _) = somigliana::gradient(s, c, h + 1.0, w);
        let (dlat_here, _) = somigliana::gradient(s, c, h, w);
        self.g_d = [
            g[2],
            dlat[2],
            dh[2],
            wgs84::GAMMA_E * (wgs84::K + 0.5 * wgs84::E2) * (c * c - s * s),
            3.0 * g[2] / (wgs84::A * wgs84::A),
            dlat_above - dlat_here,
        ];
    }
}

impl<S: Real> Anchor<S> {
    /// The Earth at `dlat` (rad) and `dh` (m) from the anchor.
    #[inline(always)]
    pub fn near(&self, dlat: S, dh: S) -> Near<S> {
        let (s, c) = (self.sin_lat, self.cos_lat);
        let x = ((self.r_m_slope[0] + dlat * self.r_m_slope[1]) * dlat + dh) * self.per_r_m;
        let y = ((self.r_n_slope[0] + dlat * self.r_n_slope[1]) * dlat + dh) * self.per_r_n;
        Near {
            sin_lat: s + dlat * (c - dlat * (s * 0.5 + dlat * c * (1.0 / 6.0))),
            cos_lat: c - dlat * (s + dlat * (c * 0.5 - dlat * s * (1.0 / 6.0))),
            sec_lat: self.sec[0] + dlat * (self.sec[1] + dlat * (self.sec[2] + dlat * self.sec[3])),
            per_r_m: self.per_r_m - self.per_r_m * (x - x * x),
            per_r_n: self.per_r_n - self.per_r_n * (y - y * y),
            g_n: self.g_n[0] + dlat * self.g_n[1] + dh * self.g_n[2],
            g_d: self.g_d[0]
                + dlat * (self.g_d[1] + dlat * self.g_d[3])
                + dh * (self.g_d[2] + dh * self.g_d[4] + dlat * self.g_d[5]),
        }
    }
}

impl<S> Anchor<S> {
    /// Every number in it in another kind of number, always in the same order.
    #[inline(always)]
    pub fn map<R>(self, f: &mut impl FnMut(S) -> R) -> Anchor<R> {
        Anchor {
            lat: self.lat.map(f),
            lon: self.lon.map(f),
            h: self.h.map(f),
            sin_lat: f(self.sin_lat),
            cos_lat: f(self.cos_lat),
            sec: self.sec.map(&mut *f),
            per_r_m: f(self.per_r_m),
            per_r_n: f(self.per_r_n),
            r_m_slope: self.r_m_slope.map(&mut *f),
            r_n_slope: self.r_n_slope.map(&mut *f),
            g_n: self.g_n.map(&mut *f),
            g_d: self.g_d.map(&mut *f),
        }
    }
}
