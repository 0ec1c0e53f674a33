//! Geodetic, Earth-fixed and local coordinates.

use schuler_frames::{E, Geodetic, T, Vec3};

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
