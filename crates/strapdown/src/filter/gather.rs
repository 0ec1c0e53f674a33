//! The kernel that follows source states through the steps one by one, where that is needed.

use fearless_simd::{Simd, SimdBase};

use super::waiting::{STEPS, Waiting};

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
        let half = |i: usize, j: usize| steps.half[i][k][j];
        let (dt, a) = (steps.dt(k), [half(0, 3), half(1, 3), half(2, 3)]);
        let of_gyro = faded * gyro;
        let of_accel = faded - of_gyro;
        faded *= decay;
        let mut direct = push;
        let mut middle = push;
        for i in 0..3 {
            let d = push[0] * half(i, 0) + push[1] * half(i, 1) + push[2] * half(i, 2);
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
