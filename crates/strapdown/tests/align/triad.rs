//! TRIAD against the reference table and against its own limits.

use schuler_frames::{B, Euler, Geodetic, Gravity, Rate, Rot, T, Vec3, earth, phi_between, wgs84};
use schuler_strapdown::align::{Limits, TriadError, Vectors, triad};
use schuler_strapdown::static_base::Site;

/// 1 deg/h in rad/s; 1 µg = 9.80665e-6 m/s².
const DEGPH: f64 = std::f64::consts::PI / 648_000.0;
const UG: f64 = 9.80665e-6;

/// tests/data/static_theory/align_triad.csv: exact attitudes for constant sensor errors, computed with independent
/// code (its README says how).
#[test]
fn exact_errors_of_the_reference_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/static_theory/align_triad.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let mut cases = 0;
    for line in text.lines().skip(1) {
        let v: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let position = Geodetic::new(v[0].to_radians(), 0.0, 0.0);
        let truth: Rot<T, B> =
            Rot::from_euler(Euler::new(v[1].to_radians(), v[2].to_radians(), v[3].to_radians()));
        let (eps, nabla) = (Vec3::new(v[4], v[5], v[6]) * DEGPH, Vec3::new(v[7], v[8], v[9]) * UG);
        let gravity = Gravity::Somigliana;
        let f_b = truth.inverse() * -gravity.gravity_t(position) + nabla;
        let (s, c) = position.lat.sin_cos();
        let omega = truth.inverse() * earth::omega_ie_t(s, c).as_vec3() + eps;
        let found = triad(f_b, Rate::claim(omega), position, gravity).unwrap();
        let phi = phi_between(found, truth) - Vec3::new(v[10], v[11], v[12]);
        assert!(phi.norm() < 1e-12, "{line}: {phi:?}");
        // First order: phi_N = nabla_E / g, phi_E = -nabla_N / g, phi_D = eps_E / (Ω cos L) - tan L nabla_E / g.
        let (nabla_t, eps_t) = (truth * nabla, truth * eps);
        let g = gravity.gravity_t(position).norm();
        let first = Vec3::<T>::new(
            nabla_t[1] / g,
            -nabla_t[0] / g,
            eps_t[1] / (wgs84::OMEGA * c) - s / c * nabla_t[1] / g,
        );
        let residue = (phi_between(found, truth) - first).norm();
        assert!(residue < 5.0 * first.norm().powi(2), "{line}: residue {residue}");
        cases += 1;
    }
    assert!(cases >= 20, "{cases} cases");
}

#[test]
fn vectors_that_give_no_attitude_are_refused() {
    let north = |lat: f64| Geodetic::new(lat, 0.0, 0.0);
    let up = Vec3::<B>::new(0.0, 0.0, -9.8);
    let rate = |x: f64, z: f64| Rate::claim(Vec3::<B>::new(x, 0.0, z));
    let go = |f, omega, lat| triad(f, omega, north(lat), Gravity::Somigliana);
    assert_eq!(go(Vec3::ZERO, rate(5e-5, -5e-5), 0.8), Err(TriadError::NoForce { norm: 0.0 }));
    assert!(matches!(go(up * f64::NAN, rate(5e-5, -5e-5), 0.8), Err(TriadError::NoForce { .. })));
    let pole = std::f64::consts::FRAC_PI_2;
    assert_eq!(go(up, rate(5e-5, -5e-5), pole), Err(TriadError::Pole { lat: pole }));
    assert_eq!(go(up, rate(0.0, -7e-5), 0.8), Err(TriadError::NoHeading { sine: 0.0 }));
    assert_eq!(go(up, rate(0.0, 0.0), 0.8), Err(TriadError::NoHeading { sine: 0.0 }));
    assert!(matches!(go(up, rate(f64::NAN, 0.0), 0.8), Err(TriadError::NoHeading { .. })));
    assert!(go(up, rate(5e-5, -5e-5), 0.8).is_ok());
}

/// What each order makes of small sensor errors, to first order, for a body that leans.
#[test]
fn orders_differ_as_their_laws_say() {
    let position = Geodetic::new(0.8, 0.0, 50.0);
    let gravity = Gravity::Somigliana;
    let (s, c) = position.lat.sin_cos();
    let (g, o) = (gravity.gravity_t(position).norm(), wgs84::OMEGA);
    let truth: Rot<T, B> = Rot::from_euler(Euler::new(0.3, -0.2, 2.0));
    let omega_t = earth::omega_ie_t(s, c).as_vec3();
    let f_t = -gravity.gravity_t(position);
    for axis in 0..6 {
        let mut errors = [0.0; 6];
        errors[axis] = if axis < 3 { 1e-4 * o } else { 1e-4 * g };
        let [eps_n, eps_e, eps_d, nabla_n, nabla_e, nabla_d] = errors;
        let (eps, nabla) = (Vec3::<T>::new(eps_n, eps_e, eps_d), Vec3::<T>::new(nabla_n, nabla_e, nabla_d));
        let tan = s / c;
        let about_east = [
            (Vectors::ForceFirst, -nabla_n / g),
            (Vectors::RateFirst, -(s * eps_n + c * eps_d) / o),
            (Vectors::Inverse, 0.5 * (tan * nabla_d / g - nabla_n / g - eps_d / (o * c))),
        ];
        let limit = Limits::new(Site::new(position, gravity)).bias(eps, nabla);
        for (order, phi_e) in about_east {
            let back = truth.inverse();
            let found = order
                .attitude(back * (f_t + nabla), Rate::claim(back * (omega_t + eps)), position, gravity)
                .unwrap();
            let expected = Vec3::<T>::new(limit[0], phi_e, limit[2]);
            let residue = (phi_between(found, truth) - expected).norm();
            // Second order of errors of 1e-4.
            assert!(residue < 1e-7, "{order:?} axis {axis}: {residue:e}");
        }
    }
}

/// No order needs the latitude for the heading: at a wrong one only what is known of the vertical Earth rate changes, which
/// the first two do not use.
#[test]
fn heading_does_not_depend_on_the_latitude_that_is_used() {
    let gravity = Gravity::Somigliana;
    let truth: Rot<T, B> = Rot::from_euler(Euler::new(0.1, 0.05, -1.2));
    let place = Geodetic::new(0.6, 0.0, 0.0);
    let (s, c) = place.lat.sin_cos();
    let f_b = truth.inverse() * -gravity.gravity_t(place);
    let omega = Rate::claim(truth.inverse() * earth::omega_ie_t(s, c).as_vec3());
    for wrong in [-0.3, 0.4, 0.9] {
        let found = triad(f_b, omega, Geodetic::new(wrong, 0.0, 0.0), gravity).unwrap();
        assert!(phi_between(found, truth).norm() < 1e-14, "{wrong}");
    }
}
