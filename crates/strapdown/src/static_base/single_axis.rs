//! The formulas of the textbooks: one horizontal axis, no Earth rate but through heading.

use super::{Drivers, ModalSum, Response, Site};

/// Single-axis Schuler answer, north and east each for itself.
///
/// North: `x'' + (g/R_M) x = f`, with `f = nabla_N + g phi_E` and the tilt `phi_E` fed by its
/// initial value, by the east gyro and, through `Omega cos L`, by the heading error; east likewise
/// without heading. So an accelerometer error gives `nabla/w² (1 - cos w t)`, a tilt
/// `R phi (1 - cos w t)`, a gyro error `R eps (t - sin(w t)/w)`, a heading error
/// `R Omega cos L phi_D (t - sin(w t)/w)` and an initial position error itself. It leaves out the
/// Foucault coupling of the axes and the 24 h turn of the tilts: good to some percent for ten
/// minutes, wrong by factors after some hours.
pub fn single_axis(site: &Site, d: &Drivers) -> Response {
    let o_cos = site.omega_ie * site.cos_lat;
    let g = site.g;
    let feed = |tilt: f64, gyro: f64, gyro_rate: f64| [tilt, -gyro, -gyro_rate, 0.0];

    // Tilt as it would be without feedback of position: the forcing of the loop.
    let mut tilt_e = feed(d.phi0[1], d.eps[1], d.eps_rate[1]);
    let tilt_n = feed(d.phi0[0], d.eps[0], d.eps_rate[0]);
    let heading = feed(d.phi0[2], d.eps[2], d.eps_rate[2]);
    for k in 0..3 {
        tilt_e[k + 1] += o_cos * heading[k];
    }
    let north = channel(0, site.r_m, g, tilt_e, d.nabla[0], d.nabla_rate[0], d.dv0[0]);
    let east = channel(1, site.r_n, -g, tilt_n, d.nabla[1], d.nabla_rate[1], d.dv0[1]);
    let x = north.plus(site.r_m * d.dlat0, &ModalSum::polynomial([1.0, 0.0, 0.0, 0.0]));
    let y = east.plus(site.r_n * site.cos_lat * d.dlon0, &ModalSum::polynomial([1.0, 0.0, 0.0, 0.0]));
    Response {
        rates: [0.0, libm::sqrt(g / site.r_m), libm::sqrt(g / site.r_n)],
        position: [x, y],
        phi: [
            ModalSum::polynomial(tilt_n).plus(1.0 / site.r_n, &east),
            ModalSum::polynomial(tilt_e).plus(-1.0 / site.r_m, &north),
            ModalSum::polynomial(heading),
        ],
    }
}

/// `x'' + w² x = nabla + nabla_rate t + g tilt(t)`, `x(0) = 0`, `x'(0) = dv0`, in mode `1 + axis`.
fn channel(
    axis: usize,
    radius: f64,
    g: f64,
    tilt: [f64; 4],
    nabla: f64,
    nabla_rate: f64,
    dv0: f64,
) -> ModalSum {
    let w2 = g.abs() / radius;
    let w = libm::sqrt(w2);
    let f = [nabla + g * tilt[0], nabla_rate + g * tilt[1], g * tilt[2], g * tilt[3]];
    // Particular solution f/w² - f''/w⁴ of a cubic forcing.
    let p = [(f[0] - f[2] / w2) / w2, (f[1] - f[3] / w2) / w2, f[2] / w2, f[3] / w2];
    let mut x = ModalSum::polynomial(p);
    x.cos[1 + axis] = -p[0];
    x.sin[1 + axis] = (dv0 - p[1]) / w;
    x
}
