//! IMU steps that wait to be gathered, several at a time, in the widest lanes of the machine.

use fearless_simd::{Simd, SimdBase, SimdFloat, f64x8};

/// IMU steps that are gathered together.
pub(crate) const STEPS: usize = 8;

/// IMU steps that wait until there are [`STEPS`] of them, a row each.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Waiting {
    /// Row i of the attitude in the middle of each step and component i of the velocity gained in t, each times half the
    /// length of the step (the velocity: half of it): as [`middles`] finds them.
    pub half: [[[f64; 4]; STEPS]; 3],
    /// Velocity gained along body axes, and the length of the step.
    gained: [[f64; 4]; STEPS],
    /// Quaternion of the attitude before the first step and after each.
    q: [[f64; 4]; STEPS + 1],
    pub count: usize,
}

impl Waiting {
    /// None, the attitude being `q`.
    pub fn new(q: [f64; 4]) -> Self {
        Waiting {
            half: [[[0.0; 4]; STEPS]; 3],
            gained: [[0.0; 4]; STEPS],
            // Rows not in use have an attitude too.
            q: [q; STEPS + 1],
            count: 0,
        }
    }

    /// Begins anew with the attitude `q`.
    #[inline]
    pub fn begin(&mut self, q: [f64; 4]) {
        self.count = 0;
        self.q[0] = q;
    }

    /// One more step of `dt`, at whose end the attitude is `q`. There is room, because full ones are gathered.
    #[inline]
    pub fn push(&mut self, q: [f64; 4], gained: [f64; 3], dt: f64) {
        let k = self.count % STEPS;
        self.q[k + 1] = q;
        self.gained[k] = [gained[0], gained[1], gained[2], dt];
        self.count = k + 1;
    }

    /// Length of a step.
    #[inline(always)]
    pub fn dt(&self, k: usize) -> f64 {
        self.gained[k][3]
    }

    /// All are gathered: what the last left is the first of those to come.
    #[inline]
    pub fn done(&mut self) {
        self.q[0] = self.q[self.count];
        self.count = 0;
    }
}

/// Components of eight rows, a lane a row.
#[inline(always)]
fn columns<S: Simd>(simd: S, rows: &[[f64; 4]]) -> [f64x8<S>; 4] {
    let rows = rows.as_flattened();
    let load = |k: usize| f64x8::<S>::from_slice(simd, &rows[8 * k..8 * k + 8]);
    let (a, b, c, d) = (load(0), load(1), load(2), load(3));
    let (wy, xz) = ([a.unzip_low(b), c.unzip_low(d)], [a.unzip_high(b), c.unzip_high(d)]);
    let (w, y) = (wy[0].unzip_low(wy[1]), wy[0].unzip_high(wy[1]));
    let (x, z) = (xz[0].unzip_low(xz[1]), xz[0].unzip_high(xz[1]));
    [w, x, y, z]
}

/// The rows of eight lanes of four components.
#[inline(always)]
pub(crate) fn store_rows<S: Simd>([w, x, y, z]: [f64x8<S>; 4], rows: &mut [[f64; 4]; STEPS]) {
    let rows = rows.as_flattened_mut();
    let (wy, xz) = ([w.zip_low(y), w.zip_high(y)], [x.zip_low(z), x.zip_high(z)]);
    for k in 0..2 {
        wy[k].zip_low(xz[k]).store_slice(&mut rows[16 * k..16 * k + 8]);
        wy[k].zip_high(xz[k]).store_slice(&mut rows[16 * k + 8..16 * k + 16]);
    }
}

/// The attitude half way between two near ones, the sum of their quaternions made a unit, and the velocity gained there.
#[inline(always)]
pub(crate) fn middles<S: Simd>(simd: S, waiting: &mut Waiting) {
    let (a, b) = (columns(simd, &waiting.q[..STEPS]), columns(simd, &waiting.q[1..]));
    // q and -q are the same attitude.
    let one = f64x8::splat(simd, 1.0);
    let sign = one.copysign(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
    let (w, x, y, z) = (a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2], a[3] + sign * b[3]);
    let k = f64x8::splat(simd, 2.0) / (w * w + x * x + y * y + z * z);
    let (x2, y2, z2) = (k * x, k * y, k * z);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let c = [
        [one - yy - zz, xy - wz, xz + wy],
        [xy + wz, one - xx - zz, yz - wx],
        [xz - wy, yz + wx, one - xx - yy],
    ];
    let half = f64x8::splat(simd, 0.5);
    let [dx, dy, dz, dt] = columns(simd, &waiting.gained);
    let (dx, dy, dz, dt) = (dx * half, dy * half, dz * half, dt * half);
    for i in 0..3 {
        let gained = c[i][0] * dx + c[i][1] * dy + c[i][2] * dz;
        store_rows([c[i][0] * dt, c[i][1] * dt, c[i][2] * dt, gained], &mut waiting.half[i]);
    }
}
