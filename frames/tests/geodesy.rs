//! Geodetic, Earth-fixed and local coordinates.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use proptest::prelude::*;
use schuler_frames::{C_ENU_T, E, Enu, Geodetic, T, Vec3, c_ie, position_error, wgs84, with_position_error};

use crate::vectors;

/// tests/data/normal_field: positions by the definition at 60 digits.
#[test]
fn ecef_against_table() {
    for row in crate::table("normal_field/points.csv") {
        let (p, r) = (Geodetic::new(row[0], row[1], row[2]), Vec3::<E>::new(row[3], row[4], row[5]));
        // Two units in the last place of the distance: 2e-9 m on the ground, 4e-9 m at 1e7 m.
        let tolerance = 2.3e-16 * r.norm() * 2.0;
        assert!((p.as_ecef() - r).norm() < tolerance, "{p:?}");
        let q = Geodetic::from_ecef(r);
        assert!((q.h - p.h).abs() < tolerance, "{p:?} {q:?}");
        assert!((q.lat - p.lat).abs() * r.norm() < tolerance, "{p:?} {q:?}");
        assert!((q.lon - p.lon).abs() * r.norm() * p.lat.cos() < tolerance, "{p:?} {q:?}");
    }
}

#[test]
fn local_axes_point_north_east_and_down() {
    for (lat, lon) in [(0.0, 0.0), (0.8, -2.0), (-1.2, 3.0), (1.5, 0.5)] {
        let p = Geodetic::new(lat, lon, 100.0);
        let r = p.as_ecef();
        let along = |q: Geodetic| {
            let d = q.as_ecef() - r;
            d * (1.0 / d.norm())
        };
        let c_et = p.c_et();
        let north = along(Geodetic { lat: lat + 1e-7, ..p });
        let east = along(Geodetic { lon: lon + 1e-7, ..p });
        let down = along(Geodetic { h: p.h - 1.0, ..p });
        for (axis, want) in [
            (Vec3::<T>::new(1.0, 0.0, 0.0), north),
            (Vec3::new(0.0, 1.0, 0.0), east),
            (Vec3::new(0.0, 0.0, 1.0), down),
        ] {
            assert!((c_et * axis - want).norm() < 2e-7);
        }
    }
}

/// Latitudes and longitudes all over the Earth (the poles as often as all else), heights -10 km to 10 000 km.
fn positions() -> impl Strategy<Value = Geodetic> {
    let lat = prop_oneof![
        -FRAC_PI_2..FRAC_PI_2,
        (-18..0i32, any::<bool>())
            .prop_map(|(k, north)| (FRAC_PI_2 - 10f64.powi(k)) * if north { 1.0 } else { -1.0 }),
    ];
    let h = prop_oneof![-1e4..1e4, 1e4..1e7];
    (lat, -PI..PI, h).prop_map(|(lat, lon, h)| Geodetic::new(lat, lon, h))
}

/// A few units in the last place of the distance from the centre: 6e-9 m on the ground, 1.4e-8 m at 10 000 km.
fn rounding(r: Vec3<E>) -> f64 {
    4.0 * f64::EPSILON * r.norm()
}

proptest! {
    #![proptest_config(crate::laws())]

    #[test]
    fn ecef_comes_back(p in positions()) {
        let r = p.as_ecef();
        let q = Geodetic::from_ecef(r);
        prop_assert!((q.as_ecef() - r).norm() < rounding(r), "{q:?} {p:?}");
        prop_assert!((q.h - p.h).abs() < rounding(r), "{q:?} {p:?}");
        prop_assert!((q.lat - p.lat).abs() * r.norm() < rounding(r), "{q:?} {p:?}");
    }

    /// Independent: `map_3d`. Its way back is exact to 1e-6 m in this range only.
    #[test]
    fn map_3d_agrees(p in positions(), d in vectors::<T>(1e5)) {
        let wgs84 = map_3d::Ellipsoid::WGS84;
        let (x, y, z) = map_3d::geodetic2ecef(p.lat, p.lon, p.h, wgs84);
        let r = p.as_ecef();
        prop_assert!((r - Vec3::new(x, y, z)).norm() < rounding(r));

        let q = r + p.c_et() * d;
        let [x, y, z] = q.as_array();
        let (n, e, down) = map_3d::ecef2ned(x, y, z, p.lat, p.lon, p.h, wgs84);
        let tolerance = 3.0 * rounding(q);
        prop_assert!((p.local_ned(q) - Vec3::new(n, e, down)).norm() < tolerance);
        let (e, n, u) = map_3d::ecef2enu(x, y, z, p.lat, p.lon, p.h, wgs84);
        prop_assert!((C_ENU_T * p.local_ned(q) - Vec3::<Enu>::new(e, n, u)).norm() < tolerance);
        prop_assert!((p.ecef_of_local(p.local_ned(q)) - q).norm() < tolerance);

        if p.h < 3e4 {
            let [x, y, z] = r.as_array();
            let (lat, lon, h) = map_3d::ecef2geodetic(x, y, z, wgs84);
            let back = Geodetic::from_ecef(r);
            prop_assert!((back.h - h).abs() < 1e-6 && (back.lat - lat).abs() < 1e-13);
            prop_assert!((back.lon - lon).abs() < 1e-14);
        }
    }

    #[test]
    fn position_errors_come_back(lat in -1.5..1.5f64, lon in -PI..PI, h in -1e3..1e5, error in vectors::<T>(1e4)) {
        let truth = Geodetic::new(lat, lon, h);
        let computed = with_position_error(truth, error);
        // Latitude and longitude resolve 4e-16 rad, 3e-9 m.
        prop_assert!((position_error(computed, truth) - error).norm() < 1e-8);
        // A whole turn of longitude more is the same place.
        let turned = Geodetic { lon: computed.lon + TAU, ..computed };
        prop_assert!((position_error(turned, truth) - error).norm() < 2e-8);
    }

    /// Errors by the radii are the exact local coordinates to first order: the rest is d² / (2 R) times
    /// the largest slope, tan L of the meridians that converge.
    #[test]
    fn position_errors_are_local_metres(lat in -1.2..1.2f64, lon in -PI..PI, h in -1e3..1e4, error in vectors::<T>(10.0)) {
        let truth = Geodetic::new(lat, lon, h);
        let exact = truth.local_ned(with_position_error(truth, error).as_ecef());
        let second_order = error.norm_squared() / 6.3e6 * (1.0 + lat.tan().abs());
        prop_assert!((exact - error).norm() < 1e-8 + second_order, "{exact:?} {error:?}");
    }
}

/// `map_3d` turns between ECEF and ECI by the angle it is given, as ours does.
#[test]
fn map_3d_turns_the_same_way() {
    let r = Vec3::<E>::new(1e6, -5e6, 3e6);
    let theta = 1.2;
    let (x, y, z) = map_3d::ecef2eci(theta, r[0], r[1], r[2]);
    assert!((c_ie(theta) * r - Vec3::new(x, y, z)).norm() < 4e-9);
}

/// Positions on the axis and on the equator, where the answer is known.
#[test]
fn poles_and_equator() {
    for h in [-1e4, 0.0, 1e7] {
        for side in [1.0, -1.0] {
            let p = Geodetic::from_ecef(Vec3::new(0.0, 0.0, side * (wgs84::B + h)));
            assert_eq!((p.lat, p.lon), (side * FRAC_PI_2, 0.0));
            assert!((p.h - h).abs() < 4e-9);
        }
        let p = Geodetic::from_ecef(Vec3::new(0.0, -(wgs84::A + h), 0.0));
        assert_eq!((p.lat, p.lon), (0.0, -FRAC_PI_2));
        assert!((p.h - h).abs() < 4e-9);
    }
}
