//! The kernels of gathering: several IMU steps at a time, in the widest lanes of the machine.

use fearless_simd::{Simd, SimdBase, SimdFloat, SimdSplit, f64x8};

/// IMU steps that are gathered together.
pub(crate) const STEPS: usize = 8;

/// IMU steps that wait until there are [`STEPS`] of them; by component, one lane a step.
#[derive(Clone, Debug)]
pub(crate) struct Waiting {
    pub count: usize,
    /// Quaternion of the attitude before the first step and after each.
    q: [[f64; STEPS + 1]; 4],
    /// Velocity gained, m/s, body axes.
    dv: [[f64; STEPS]; 3],
    pub dt: [f64; STEPS],
    half_dt: [f64; STEPS],
    /// Time of the middle of each step since the first began, and of the end of the last.
    middle: [f64; STEPS],
    elapsed: f64,
    /// Attitude in the middle of each step, by rows, velocity gained in t, and half of it: as [`middles`] finds them.
    pub c: [[[f64; STEPS]; 3]; 3],
    pub a: [[f64; STEPS]; 3],
    half_a: [[f64; STEPS]; 3],
}

impl Waiting {
    /// None, the attitude being `q`.
    pub fn new(q: [f64; 4]) -> Self {
        Waiting {
            count: 0,
            // Lanes not in use have an attitude too.
            q: q.map(|q| [q; STEPS + 1]),
            dv: [[0.0; STEPS]; 3],
            dt: [0.0; STEPS],
            half_dt: [0.0; STEPS],
            middle: [0.0; STEPS],
            elapsed: 0.0,
            c: [[[0.0; STEPS]; 3]; 3],
            a: [[0.0; STEPS]; 3],
            half_a: [[0.0; STEPS]; 3],
        }
    }

    /// Begins anew with the attitude `q`.
    #[inline]
    pub fn begin(&mut self, q: [f64; 4]) {
        self.clear();
        for (row, q) in self.q.iter_mut().zip(q) {
            row[0] = q;
        }
    }

    /// One more step of `dt`, at whose end the attitude is `q`. There is room, because full ones are gathered.
    #[inline]
    pub fn push(&mut self, q: [f64; 4], dv: [f64; 3], dt: f64) {
        let k = self.count % STEPS;
        for (row, q) in self.q.iter_mut().zip(q) {
            row[k + 1] = q;
        }
        for (row, dv) in self.dv.iter_mut().zip(dv) {
            row[k] = dv;
        }
        self.dt[k] = dt;
        self.half_dt[k] = 0.5 * dt;
        self.middle[k] = self.elapsed + 0.5 * dt;
        self.elapsed += dt;
        self.count = k + 1;
    }

    /// All are gathered: the last attitude is the first of those to come.
    #[inline]
    pub fn done(&mut self) {
        for row in &mut self.q {
            row[0] = row[self.count];
        }
        self.clear();
    }

    /// Lanes of steps to come gain nothing in no time.
    #[inline]
    fn clear(&mut self) {
        self.count = 0;
        self.elapsed = 0.0;
        self.dt = [0.0; STEPS];
        self.dv = [[0.0; STEPS]; 3];
    }
}

/// The attitude half way between two near ones, the sum of their quaternions made a unit, and the velocity gained there.
#[inline(always)]
pub(crate) fn middles<S: Simd>(simd: S, waiting: &mut Waiting) {
    let load = |row: &[f64]| f64x8::<S>::from_slice(simd, row);
    let from = |k: usize| load(&waiting.q[k][..STEPS]);
    let to = |k: usize| load(&waiting.q[k][1..]);
    let (a, b) = ([from(0), from(1), from(2), from(3)], [to(0), to(1), to(2), to(3)]);
    // q and -q are the same attitude.
    let sign = f64x8::splat(simd, 1.0).copysign(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
    let (w, x, y, z) = (a[0] + sign * b[0], a[1] + sign * b[1], a[2] + sign * b[2], a[3] + sign * b[3]);
    let one = f64x8::splat(simd, 1.0);
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
    let dv = [load(&waiting.dv[0]), load(&waiting.dv[1]), load(&waiting.dv[2])];
    for i in 0..3 {
        for j in 0..3 {
            c[i][j].store_slice(&mut waiting.c[i][j]);
        }
        let a = c[i][0] * dv[0] + c[i][1] * dv[1] + c[i][2] * dv[2];
        a.store_slice(&mut waiting.a[i]);
        (a * 0.5).store_slice(&mut waiting.half_a[i]);
    }
}

/// Sums over the steps, by lane; whole ones are those over the lanes.
#[derive(Clone, Debug)]
pub(crate) struct Sums<X> {
    /// Velocity gained, its integral, and the integral of that.
    pub gained: [X; 3],
    pub moved: [X; 3],
    pub third: [X; 3],
    /// Integral of the attitude, and the integral of that.
    pub turned: [[X; 3]; 3],
    pub turning: [[X; 3]; 3],
}

impl<X: Copy> Sums<X> {
    pub fn of(x: X) -> Self {
        Sums { gained: [x; 3], moved: [x; 3], third: [x; 3], turned: [[x; 3]; 3], turning: [[x; 3]; 3] }
    }

    /// Sets all to `x`, each where it is.
    #[inline]
    pub fn fill(&mut self, x: X) {
        for three in [&mut self.gained, &mut self.moved, &mut self.third] {
            three.fill(x);
        }
        for nine in [&mut self.turned, &mut self.turning] {
            nine.as_flattened_mut().fill(x);
        }
    }
}

impl Sums<[f64; STEPS]> {
    /// Over all lanes, in the same order whatever the machine.
    #[inline(always)]
    pub fn total<S: Simd>(&self, simd: S) -> Sums<f64> {
        let mut total = Sums::of(0.0);
        for i in 0..3 {
            total.gained[i] = whole(simd, &self.gained[i]);
            total.moved[i] = whole(simd, &self.moved[i]);
            total.third[i] = whole(simd, &self.third[i]);
            for j in 0..3 {
                total.turned[i][j] = whole(simd, &self.turned[i][j]);
                total.turning[i][j] = whole(simd, &self.turning[i][j]);
            }
        }
        total
    }
}

#[inline(always)]
fn whole<S: Simd>(simd: S, x: &[f64; STEPS]) -> f64 {
    let (low, high) = f64x8::from_slice(simd, x).split();
    let (low, high) = (low + high).split();
    let two = low + high;
    two[0] + two[1]
}

/// Adds the steps that wait, whose middles are known.
#[inline(always)]
pub(crate) fn add<S: Simd>(simd: S, sums: &mut Sums<[f64; STEPS]>, steps: &Waiting) {
    let load = |x: &[f64; STEPS]| f64x8::<S>::from_slice(simd, x);
    // Time from the middle of each step to the end of all.
    let (after, dt) = (steps.elapsed, load(&steps.dt));
    let rest = f64x8::splat(simd, after) - load(&steps.middle);
    // Half the mean of its square over the step.
    let half_square = rest * rest * 0.5 + dt * dt * (1.0 / 24.0);
    for i in 0..3 {
        let a = load(&steps.a[i]);
        let (gained, moved, third) = (load(&sums.gained[i]), load(&sums.moved[i]), load(&sums.third[i]));
        (third + (moved + gained * (0.5 * after)) * after + a * half_square).store_slice(&mut sums.third[i]);
        (moved + gained * after + a * rest).store_slice(&mut sums.moved[i]);
        (gained + a).store_slice(&mut sums.gained[i]);
        for j in 0..3 {
            let c = load(&steps.c[i][j]) * dt;
            let (turned, turning) = (load(&sums.turned[i][j]), load(&sums.turning[i][j]));
            (turning + turned * after + c * rest).store_slice(&mut sums.turning[i][j]);
            (turned + c).store_slice(&mut sums.turned[i][j]);
        }
    }
}

/// Attitude, velocity and position error that a unit of each source state has made so far, by axis.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const N: usize> {
    pub phi: [[f64; N]; 3],
    pub dv: [[f64; N]; 3],
    pub dr: [[f64; N]; 3],
    /// Sensor error along body axes that a unit of the state at the start makes in the mean of the next step.
    pub push: [[f64; N]; 3],
    /// One for a state of the gyro, zero for one of the accelerometer.
    pub gyro: [f64; N],
    /// How a state of a block of one fades in a step.
    pub decay: [f64; N],
}

impl<const N: usize> Columns<N> {
    pub const NONE: Self = Columns {
        phi: [[0.0; N]; 3],
        dv: [[0.0; N]; 3],
        dr: [[0.0; N]; 3],
        push: [[0.0; N]; 3],
        gyro: [0.0; N],
        decay: [1.0; N],
    };

    /// An interval begins, in whose first step the states make `push`.
    #[inline]
    pub fn begin(&mut self, push: &[[f64; N]; 3]) {
        (self.phi, self.dv, self.dr) = ([[0.0; N]; 3], [[0.0; N]; 3], [[0.0; N]; 3]);
        self.push = *push;
    }
}

/// The steps that wait, whose middles are known, of the first `len` states: with C the sensor axes and `a` the velocity gained,
///
/// ```text
/// d = C push dt,   gyro: phi := phi - d,   accelerometer: dv := dv + d
/// dv := dv + a × (phi in the middle),   dr := dr + dt (dv in the middle)
/// ```
#[inline(always)]
pub(crate) fn gather<S: Simd, const N: usize>(
    simd: S,
    columns: &mut Columns<N>,
    steps: &Waiting,
    len: usize,
) {
    let mut first = 0;
    while first < len {
        piece::<S, N>(simd, columns, steps, first);
        first += S::f64s::LEN;
    }
}

/// As many states as there are lanes; lanes beyond the states in use carry zeros.
#[inline(always)]
fn piece<S: Simd, const N: usize>(simd: S, columns: &mut Columns<N>, steps: &Waiting, first: usize) {
    let load = |x: &[f64; N]| load::<S>(simd, &x[first..]);
    let of = |x: &[[f64; N]; 3]| [load(&x[0]), load(&x[1]), load(&x[2])];
    let (mut phi, mut dv, mut dr) = (of(&columns.phi), of(&columns.dv), of(&columns.dr));
    let push = of(&columns.push);
    let (gyro, decay) = (load(&columns.gyro), load(&columns.decay));
    let mut faded = S::f64s::splat(simd, 1.0);
    // Halves of what a step makes, once to its middle and once from there.
    for k in 0..steps.count.min(STEPS) {
        let c = |i: usize, j: usize| steps.c[i][j][k];
        let (dt, a) = (steps.dt[k], [steps.half_a[0][k], steps.half_a[1][k], steps.half_a[2][k]]);
        let half = faded * steps.half_dt[k];
        let of_gyro = half * gyro;
        let of_accel = half - of_gyro;
        faded *= decay;
        let mut direct = push;
        let mut middle = push;
        for i in 0..3 {
            let d = push[0] * c(i, 0) + push[1] * c(i, 1) + push[2] * c(i, 2);
            let turn = d * of_gyro;
            direct[i] = d * of_accel;
            middle[i] = phi[i] - turn;
            phi[i] = middle[i] - turn;
        }
        for i in 0..3 {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            let gained = middle[l] * a[j] - middle[j] * a[l] + direct[i];
            let halfway = dv[i] + gained;
            dr[i] += halfway * dt;
            dv[i] = halfway + gained;
        }
    }
    for i in 0..3 {
        store::<S>(phi[i], &mut columns.phi[i][first..]);
        store::<S>(dv[i], &mut columns.dv[i][first..]);
        store::<S>(dr[i], &mut columns.dr[i][first..]);
        store::<S>(push[i] * faded, &mut columns.push[i][first..]);
    }
}

/// The first lanes of `x`, filled up with zeros where it is shorter.
#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, x: &[f64]) -> S::f64s {
    let lanes = S::f64s::LEN;
    if x.len() >= lanes {
        return S::f64s::from_slice(simd, &x[..lanes]);
    }
    let mut room = [0.0; STEPS];
    room[..x.len()].copy_from_slice(x);
    S::f64s::from_slice(simd, &room[..lanes])
}

#[inline(always)]
pub(super) fn store<S: Simd>(value: S::f64s, x: &mut [f64]) {
    let lanes = S::f64s::LEN;
    if x.len() >= lanes {
        return value.store_slice(&mut x[..lanes]);
    }
    let mut room = [0.0; STEPS];
    value.store_slice(&mut room[..lanes]);
    let len = x.len();
    x.copy_from_slice(&room[..len]);
}
