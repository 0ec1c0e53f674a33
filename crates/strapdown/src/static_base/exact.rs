//! The exact linear solution at rest: Schuler, Foucault and Earth rates on the ellipsoid.

use super::{Drivers, ModalSum, Response, Site};

/// Exact answer of the linear error equations of a navigator at rest with its height held.
///
/// With `psi = phi - (cos L dlon, -dlat, -sin L dlon)` the equations fall apart (s, c = sin L, cos L,
/// U the cross matrix of the polar axis (c, 0, -s), x = R_M dlat, y = R_N c dlon, a = 2 Omega s):
///
/// ```text
/// psi' = -Omega U psi - eps
/// x'' + (g/R_M) x + a y' =  g psi_E + nabla_N
/// y'' + (g/R_N) y - a x' = -g psi_N + nabla_E
/// ```
///
/// The first is a turn about the polar axis, the other two have a polynomial and a harmonic forcing
/// and the two Schuler-Foucault rates `w1 > w2` of `(p² + g/R_M)(p² + g/R_N) + a² p² = 0`.
/// The mode of w1 is written from x and that of w2 from y, which stays regular at the equator, where
/// the axes uncouple, and at high latitude. The latitude must not be a pole.
///
/// Ramps are answered by the integral of the answer to a constant.
pub fn exact(site: &Site, drivers: &Drivers) -> Response {
    let constant = answer(site, drivers);
    let ramp = Drivers { eps: drivers.eps_rate, nabla: drivers.nabla_rate, ..Drivers::default() };
    if ramp == Drivers::default() { constant } else { constant.sum(&answer(site, &ramp).integral()) }
}

fn answer(site: &Site, d: &Drivers) -> Response {
    let Site { sin_lat: s, cos_lat: c, g, r_m, r_n, omega_ie: o } = *site;
    let (wm2, wn2, a) = (g / r_m, g / r_n, 2.0 * o * s);

    // psi = p0 + p1 t + pc cos(o t) + ps sin(o t)
    let u = |v: [f64; 3]| [s * v[1], -s * v[0] - c * v[2], c * v[1]];
    let polar = |v: [f64; 3]| {
        let k = c * v[0] - s * v[2];
        [c * k, 0.0, -s * k]
    };
    let phi0 = d.phi0.as_array();
    let psi0 = [phi0[0] - c * d.dlon0, phi0[1] + d.dlat0, phi0[2] + s * d.dlon0];
    let eps = d.eps.as_array();
    let (u_psi, uu_psi, u_eps, uu_eps) = (u(psi0), u(u(psi0)), u(eps), u(u(eps)));
    let (p_psi, p_eps) = (polar(psi0), polar(eps));
    let psi: [ModalSum; 3] = core::array::from_fn(|k| ModalSum {
        poly: [p_psi[k] + u_eps[k] / o, -p_eps[k], 0.0, 0.0],
        cos: [-uu_psi[k] - u_eps[k] / o, 0.0, 0.0],
        sin: [-u_psi[k] + uu_eps[k] / o, 0.0, 0.0],
    });

    // Forcing of the two horizontal channels.
    let nabla = |axis: usize| ModalSum::polynomial([d.nabla[axis], 0.0, 0.0, 0.0]);
    let fx = nabla(0).plus(g, &psi[1]);
    let fy = nabla(1).plus(-g, &psi[0]);

    // Particular solution.
    let (x1, y1) = (fx.poly[1] / wm2, fy.poly[1] / wn2);
    let (x0, y0) = ((fx.poly[0] - a * y1) / wm2, (fy.poly[0] + a * x1) / wn2);
    let (m, n, k) = (wm2 - o * o, wn2 - o * o, a * o);
    let q = m * n - k * k;
    let mut x = ModalSum {
        poly: [x0, x1, 0.0, 0.0],
        cos: [(n * fx.cos[0] - k * fy.sin[0]) / q, 0.0, 0.0],
        sin: [(n * fx.sin[0] + k * fy.cos[0]) / q, 0.0, 0.0],
    };
    let mut y = ModalSum {
        poly: [y0, y1, 0.0, 0.0],
        cos: [(m * fy.cos[0] + k * fx.sin[0]) / q, 0.0, 0.0],
        sin: [(m * fy.sin[0] - k * fx.cos[0]) / q, 0.0, 0.0],
    };

    // Free oscillations that meet the initial position and velocity errors.
    let (w1, w2) = site.schuler_foucault_rates();
    let gap = libm::hypot(wm2 - wn2, a * libm::sqrt(2.0 * (wm2 + wn2) + a * a));
    let kappa = -2.0 * a * w1 / (wm2 - wn2 + a * a + gap); // y per x of mode 1
    let mu = 2.0 * a * w2 / (wm2 - wn2 - a * a + gap); // x per y of mode 2
    let (dx0, dy0) = (r_m * d.dlat0 - x0 - x.cos[0], r_n * c * d.dlon0 - y0 - y.cos[0]);
    let (dvx0, dvy0) = (d.dv0[0] - x1 - o * x.sin[0], d.dv0[1] - y1 - o * y.sin[0]);
    let det = w2 - mu * kappa * w1;
    let (a1, d2) = ((w2 * dx0 + mu * dvy0) / det, (kappa * w1 * dx0 + dvy0) / det);
    let det = w1 - kappa * mu * w2;
    let (b1, c2) = ((dvx0 - mu * w2 * dy0) / det, (w1 * dy0 - kappa * dvx0) / det);
    (x.cos[1], x.sin[1]) = (a1, b1);
    (y.cos[1], y.sin[1]) = (kappa * b1, -kappa * a1);
    (y.cos[2], y.sin[2]) = (c2, d2);
    (x.cos[2], x.sin[2]) = (-mu * d2, mu * c2);

    Response {
        rates: [o, w1, w2],
        position: [x, y],
        phi: [psi[0].plus(1.0 / r_n, &y), psi[1].plus(-1.0 / r_m, &x), psi[2].plus(-s / (c * r_n), &y)],
    }
}
