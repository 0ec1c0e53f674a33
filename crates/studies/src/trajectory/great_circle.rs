//! Around the Earth on a great circle, over the poles too.

use schuler_frames::{B, Dcm, E, Euler, Geodetic, Rot, T, Vec3, wgs84};

use super::{Impossible, Jet, Kinematics, Trajectory};

/// A flight at constant height along which the normal of the ellipsoid turns at a constant rate about a fixed axis.
///
/// The speed is that asked for at the start and varies by up to 0.7 % around the Earth, as the radii do. Roll and pitch are
/// constant against an x axis along the circle, so the body turns at a constant rate too, and nothing happens at a pole.
#[derive(Clone, Debug, PartialEq)]
pub struct GreatCircle {
    /// Normal at the start, and the direction in which it goes.
    normal: Vec3<E>,
    along: Vec3<E>,
    h: f64,
    /// Rate of the normal, rad/s.
    rate: f64,
    c_eb: Rot<E, B>,
    /// Axes of the circle (along, right, down) to body.
    c_bq: Rot<B, B>,
    duration: Option<f64>,
}

impl GreatCircle {
    /// From `position` with the first heading `heading` (rad) at `speed` (m/s), with constant roll and pitch (rad).
    ///
    /// # Errors
    /// Faster than anything.
    pub fn new(
        position: Geodetic,
        heading: f64,
        speed: f64,
        roll: f64,
        pitch: f64,
    ) -> Result<Self, Impossible> {
        Impossible::speed(speed)?;
        let c_et = position.c_et();
        let (s, c) = libm::sincos(heading);
        let (normal, along) = (c_et * Vec3::<T>::new(0.0, 0.0, -1.0), c_et * Vec3::<T>::new(c, s, 0.0));
        let sin_lat = libm::sin(position.lat);
        let (north, east) = (wgs84::r_m(sin_lat) + position.h, wgs84::r_n(sin_lat) + position.h);
        let rate = speed / libm::hypot(north * c, east * s);
        // Columns along, right, down.
        let (right, down) = (along.cross(normal), -normal);
        let c_eq = Rot::<E, B>::from_dcm(Dcm::claim([0, 1, 2].map(|k| [along[k], right[k], down[k]])));
        let c_qb: Rot<B, B> = Rot::from_euler(Euler::new(roll, pitch, 0.0));
        Ok(GreatCircle {
            normal,
            along,
            h: position.h,
            rate,
            c_eb: c_eq,
            c_bq: c_qb.inverse(),
            duration: None,
        })
    }

    /// The way to `end` (its latitude and longitude), where it ends.
    ///
    /// # Errors
    /// Faster than anything; an end at the start or opposite of it.
    pub fn to(start: Geodetic, end: Geodetic, speed: f64, roll: f64, pitch: f64) -> Result<Self, Impossible> {
        let up = Vec3::<T>::new(0.0, 0.0, -1.0);
        let (from, to) = (start.c_et() * up, end.c_et() * up);
        let way = start.c_et().inverse() * (to - from * from.dot(to));
        let across = libm::hypot(way[0], way[1]);
        if across < 1e-9 {
            let problem = "the end lies at the start, or opposite of it";
            return Err(Impossible::new(problem, "two places between which one shortest way leads"));
        }
        let mut circle = GreatCircle::new(start, libm::atan2(way[1], way[0]), speed, roll, pitch)?;
        if speed == 0.0 {
            return Err(Impossible::new("a speed of zero", "more than zero"));
        }
        circle.duration = Some(libm::atan2(across, from.dot(to)) / circle.rate);
        Ok(circle)
    }
}

impl Trajectory for GreatCircle {
    fn at(&self, t: f64) -> Kinematics {
        let w = self.rate;
        let (s, c) = libm::sincos(w * t);
        let (sin, cos) = (Jet([s, w * c, -0.5 * w * w * s]), Jet([c, -w * s, -0.5 * w * w * c]));
        let n = [0, 1, 2].map(|k| cos * self.normal[k] + sin * self.along[k]);
        // R_N = a / sqrt(1 - e² n_z²)
        let r_n = Jet::constant(wgs84::A) / (n[2] * n[2] * -wgs84::E2 + 1.0).sqrt();
        let r_e = [n[0] * (r_n + self.h), n[1] * (r_n + self.h), n[2] * (r_n * (1.0 - wgs84::E2) + self.h)];

        let [x, y, z] = n.map(|x| x.value());
        let position = Geodetic::new(libm::atan2(z, libm::hypot(x, y)), libm::atan2(y, x), self.h);
        let c_te = position.c_et().inverse();
        let turned: Rot<B, B> = Rot::from_rotation_vector(Vec3::new(0.0, -w * t, 0.0));
        Kinematics {
            position,
            v_t: c_te * Vec3::<E>::claim(r_e.map(|x| x.rate())),
            a_t: c_te * Vec3::<E>::claim(r_e.map(|x| x.acceleration())),
            c_tb: c_te * (self.c_eb * turned * self.c_bq.inverse()),
            omega_eb_b: self.c_bq * Vec3::<B>::new(0.0, -w, 0.0),
            alpha_eb_b: Vec3::ZERO,
        }
    }

    fn duration(&self) -> Option<f64> {
        self.duration
    }

    fn fastest(&self, _: f64) -> f64 {
        2.0 * self.rate
    }
}
