//! Gravity: published constants, independent tables, laws of the potential.

use core::f64::consts::FRAC_PI_2;

use schuler_frames::{E, Geodetic, Gravity, I, Vec3, earth, somigliana, wgs84};

const MODELS: [Gravity; 2] = [Gravity::Normal, Gravity::Somigliana];

/// tests/data/static_theory/site_constants.csv: 40-digit arithmetic from the same literals.
#[test]
fn site_constants() {
    let close = |name: &str, got: f64, want: f64| {
        assert!((got - want).abs() <= 1e-15 * want.abs(), "{name}: {got} for {want}");
    };
    for row in crate::table("static_theory/site_constants.csv") {
        let (lat, h) = (row[0].to_radians(), row[1]);
        let (s, c) = lat.sin_cos();
        close("g", Gravity::Somigliana.gravity_t(Geodetic::new(lat, 0.0, h))[2], row[2]);
        close("R_M + h", wgs84::r_m(s) + h, row[3]);
        close("R_N + h", wgs84::r_n(s) + h, row[4]);
        let omega = earth::omega_ie_t(s, c).as_vec3();
        close("omega sin L", -omega[2], row[9]);
        close("omega cos L", omega[0], row[10]);
        let (_, dh) = somigliana::gradient(s, c, h, wgs84::w(s));
        close("dg/dh", dh, row[11]);
    }
}

#[test]
fn somigliana_gradient_is_the_derivative() {
    let gamma = |lat: f64, h: f64| Gravity::Somigliana.gravity_t(Geodetic::new(lat, 0.0, h))[2];
    for (lat, h) in [(0.3, 0.0), (-0.8, 12_000.0), (1.5, -400.0), (0.0, 5e4)] {
        let (s, c) = f64::sin_cos(lat);
        let (dl, dh) = somigliana::gradient(s, c, h, wgs84::w(s));
        // Central differences; the remainder is of the order of step² and rounding 1e-15 / step.
        let (e, m) = (1e-5, 10.0);
        assert!((dl - (gamma(lat + e, h) - gamma(lat - e, h)) / (2.0 * e)).abs() < 3e-10);
        assert!((dh - (gamma(lat, h + m) - gamma(lat, h - m)) / (2.0 * m)).abs() < 3e-16);
    }
}

/// tests/data/normal_field: gradient of the closed-form potential at 60 digits.
#[test]
fn normal_field_against_table() {
    for row in crate::table("normal_field/points.csv") {
        let g = Gravity::Normal.gravity_t(Geodetic::new(row[0], row[1], row[2]));
        for (axis, want) in [(0, row[6]), (1, 0.0), (2, row[7])] {
            assert!((g[axis] - want).abs() < 8e-15, "{row:?}: {g:?}");
        }
    }
}

/// The same table: derivatives of the components, to 1e-8 of 0.05 m/s² per rad and 1e-9 of 3e-6 1/s².
#[test]
fn gradient_of_the_normal_field_against_table() {
    for row in crate::table("normal_field/points.csv") {
        let (dlat, dh) = Gravity::Normal.gradient_t(Geodetic::new(row[0], row[1], row[2]));
        for (got, want, tolerance) in [
            (dlat[0], row[8], 5e-10),
            (dlat[2], row[9], 5e-10),
            (dh[0], row[10], 3e-15),
            (dh[2], row[11], 3e-15),
        ] {
            assert!((got - want).abs() < tolerance, "{got} for {want} at {row:?}");
        }
    }
}

/// On the ellipsoid both models are the same theory; the printed gamma_e and k have 11 to 12 digits.
#[test]
fn models_agree_on_the_ellipsoid() {
    for lat in [-90.0f64, -60.0, -1.0, 0.0, 1e-6, 30.0, 45.0, 80.0, 89.999, 90.0] {
        let p = Geodetic::new(lat.to_radians(), 2.0, 0.0);
        let (n, s) = (Gravity::Normal.gravity_t(p), Gravity::Somigliana.gravity_t(p));
        assert!((n - s).norm() < 1e-10, "lat {lat}: {n:?} {s:?}");
    }
}

/// NIMA TR8350.2, chapter 3: normal gravity at the pole, printed to 1e-10.
#[test]
fn gravity_at_the_pole() {
    for model in MODELS {
        let g = model.gravity_t(Geodetic::new(FRAC_PI_2, 0.0, 0.0));
        assert!((g[2] - 9.8321849378).abs() < 1e-10, "{g:?}");
    }
}

/// Gravitation of the normal field is harmonic and free of curl, everywhere above the ellipsoid.
#[test]
fn normal_gravitation_obeys_laplace() {
    for lat in [-1.5, -0.6, 0.0, 0.3, 0.8, 1.2, FRAC_PI_2] {
        for h in [0.0, 5e3, 4e5, 2e7] {
            let r = Geodetic::new(lat, 0.7, h).as_ecef();
            let step = 1e-3 * r.norm();
            let field = |axis: usize, k: f64| {
                let mut xyz = r.as_array();
                xyz[axis] += k * step;
                Gravity::Normal.gravitation_e(Vec3::<E>::claim(xyz)).as_array()
            };
            // Fourth-order central difference: jacobian[k][i] = dg_i / dx_k.
            let jacobian = [0, 1, 2].map(|k| {
                let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|n| field(k, n));
                [0, 1, 2].map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * step))
            });
            let scale = jacobian.iter().flatten().fold(0.0f64, |m, v| m.max(v.abs()));
            let divergence = jacobian[0][0] + jacobian[1][1] + jacobian[2][2];
            let curl = [(1, 2), (2, 0), (0, 1)].map(|(i, k)| jacobian[i][k] - jacobian[k][i]);
            // The remainder of the difference is about 4 (step / r)^4 = 4e-12 of the gradient.
            assert!(divergence.abs() < 5e-11 * scale, "lat {lat} h {h}: {divergence} of {scale}");
            assert!(curl.iter().all(|c| c.abs() < 5e-11 * scale), "lat {lat} h {h}: {curl:?} of {scale}");
        }
    }
}

/// Far away only GM is left: the quadrupole falls as (a / r)², 1.6e-3 of it at the surface.
#[test]
fn normal_gravitation_far_away_is_a_point_mass() {
    let r = Vec3::<E>::new(3e9, -2e9, 4e9);
    let g = Gravity::Normal.gravitation_e(r);
    let n = r.norm();
    let want = r * (-wgs84::GM / (n * n * n));
    assert!((g - want).norm() < 1e-8 * want.norm());
}

/// One physical field in i, e and t, for both models.
#[test]
fn frames_share_one_field() {
    for model in MODELS {
        for (lat, lon, h) in [(0.9, -2.0, 1e3), (-1.5, 1.0, 1e4), (0.0, 3.0, 4e5), (0.4, 0.1, -5e3)] {
            let p = Geodetic::new(lat, lon, h);
            let r = p.as_ecef();
            let g_e = model.gravity_e(r);
            assert!((p.c_et() * model.gravity_t(p) - g_e).norm() < 2e-14);
            // e and i coincide at angle zero: omega × (omega × r) is all that differs.
            let omega = earth::OMEGA_IE_E.as_vec3();
            let centripetal = omega.cross(omega.cross(r));
            let g_i = model.gravitation_i(Vec3::<I>::claim(r.as_array()));
            assert!((Vec3::<E>::claim(g_i.as_array()) - (g_e + centripetal)).norm() < 2e-14);
        }
    }
}

/// NIMA TR8350.2, chapter 4: the series in height follows the exact magnitude to 1e-6 m/s² at aircraft height.
#[test]
fn somigliana_follows_the_exact_magnitude() {
    for lat in [0.0, 0.5, 1.0, 1.5] {
        for h in [-1e3, 1e3, 1e4] {
            let p = Geodetic::new(lat, 0.0, h);
            let difference = Gravity::Normal.gravity_t(p).norm() - Gravity::Somigliana.gravity_t(p).norm();
            assert!(difference.abs() < 1e-6, "lat {lat} h {h}: {difference}");
        }
    }
}
