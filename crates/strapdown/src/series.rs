//! Gravity and the vertical near a Cartesian place, as series in the way from it.

use schuler_frames::{E, Frame, Geodetic, Real, T, Vec3, wgs84};

/// Offset of the points from whose gravity the derivatives are formed, m. Rounding of the second
/// derivatives then moves gravity by 1e-15 m/s² at a kilometre, and the curvature left out of the first by 1e-12.
const OFFSET: f64 = 300.0;

/// Gravity to second order and the vertical to first order in the way from a centre, and the height.
///
/// What is left out of gravity is of third order, 4 g (way/R)³: 6e-11 m/s² at 750 m. As the
/// centre lies in the middle of the way, it has opposite signs before and behind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Series<F: Frame, S> {
    /// The way from the anchor to the centre of the series, m.
    centre: Vec3<F, S>,
    /// Gravity at the centre, m/s².
    g: Vec3<F, S>,
    /// Its change along x, y and z, 1/s².
    slope: [Vec3<F, S>; 3],
    /// Halves of the second derivatives xx, yy, zz, and xy, yz, zx whole.
    bend: [Vec3<F, S>; 6],
    vertical: Option<Plumb<F, S>>,
}

/// The vertical and the height near the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plumb<F: Frame, S> {
    /// Unit normal of the ellipsoid at the centre, up.
    up: Vec3<F, S>,
    /// Its change along x, y and z, 1/m.
    slope: [Vec3<F, S>; 3],
    /// Height of the centre, m.
    h: S,
}

impl<F: Frame> Series<F, f64> {
    /// About the place `centre` from `anchor` (m), in the field `gravity` (m to m/s²).
    pub fn new(
        anchor: Vec3<F>,
        centre: Vec3<F>,
        gravity: impl Fn(Vec3<F>) -> Vec3<F>,
        vertical: bool,
    ) -> Self {
        let place = anchor + centre;
        let axis = [Vec3::new(OFFSET, 0.0, 0.0), Vec3::new(0.0, OFFSET, 0.0), Vec3::new(0.0, 0.0, OFFSET)];
        let g = gravity(place);
        let ahead = axis.map(|a| gravity(place + a));
        let behind = axis.map(|a| gravity(place - a));
        const PER: f64 = 1.0 / OFFSET;
        let slope = core::array::from_fn(|k| (ahead[k] - behind[k]) * (0.5 * PER));
        let pure = |k: usize| (ahead[k] + behind[k] - g * 2.0) * (0.5 * PER * PER);
        // Both corners along the diagonal, so that the third order cancels here too.
        let mixed = |k: usize, l: usize| {
            let diagonal = gravity(place + axis[k] + axis[l]) + gravity(place - axis[k] - axis[l]) - g * 2.0;
            diagonal * (0.5 * PER * PER) - pure(k) - pure(l)
        };
        let bend = [pure(0), pure(1), pure(2), mixed(0, 1), mixed(1, 2), mixed(2, 0)];
        Series { centre, g, slope, bend, vertical: vertical.then(|| Plumb::new(place)) }
    }
}

impl<F: Frame> Plumb<F, f64> {
    /// The ellipsoid is the same body in i and in e: turned about its own axis.
    fn new(place: Vec3<F>) -> Self {
        let position = Geodetic::from_ecef(Vec3::<E>::claim(place.as_array()));
        let c_et = position.c_et().as_dcm();
        let axis = |x, y, z| Vec3::<F>::claim((c_et * Vec3::<T>::new(x, y, z)).as_array());
        let (north, east, up) = (axis(1.0, 0.0, 0.0), axis(0.0, 1.0, 0.0), axis(0.0, 0.0, -1.0));
        let s = libm::sin(position.lat);
        let per_north = north * (1.0 / (wgs84::r_m(s) + position.h));
        let per_east = east * (1.0 / (wgs84::r_n(s) + position.h));
        let slope = core::array::from_fn(|k| per_north * north[k] + per_east * east[k]);
        Plumb { up, slope, h: position.h }
    }
}

impl<F: Frame, S: Real> Series<F, S> {
    /// Gravity at `way` (m) from the anchor, m/s².
    #[inline(always)]
    pub fn gravity(&self, way: Vec3<F, S>) -> Vec3<F, S> {
        let [x, y, z] = (way - self.centre).as_array();
        let [xx, yy, zz, xy, yz, zx] = self.bend;
        let along_x = self.slope[0] + xx * x + xy * y;
        let along_y = self.slope[1] + yy * y + yz * z;
        let along_z = self.slope[2] + zz * z + zx * x;
        self.g + along_x * x + along_y * y + along_z * z
    }

    /// Height (m) and the unit vector up at `way` (m) from the anchor; only where a vertical channel is not free.
    #[inline(always)]
    pub fn height_and_up(&self, way: Vec3<F, S>) -> (S, Vec3<F, S>) {
        let plumb =
            self.vertical.as_ref().expect("invariant: a series for a vertical channel has its plumb line");
        let from = way - self.centre;
        let [x, y, z] = from.as_array();
        let change = plumb.slope[0] * x + plumb.slope[1] * y + plumb.slope[2] * z;
        (plumb.h + (plumb.up + change.scaled(0.5)).dot(from), plumb.up + change)
    }
}
