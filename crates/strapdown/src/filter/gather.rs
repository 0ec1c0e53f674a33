//! The kernel that follows source states through the steps one by one, where that is needed.

use fearless_simd::{Simd, SimdBase, f64x8};

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
        first += LANES;
    }
}

/// As many states as there are lanes; lanes beyond the states in use carry zeros.
#[inline(always)]
fn piece<S: Simd, const N: usize>(simd: S, columns: &mut Columns<N>, steps: &Waiting, first: usize) {
    let load = |x: &[f64; N]| load(simd, &x[first..]);
    let of = |x: &[[f64; N]; 3]| [load(&x[0]), load(&x[1]), load(&x[2])];
    let (mut phi, mut dv, mut dr) = (of(&columns.phi), of(&columns.dv), of(&columns.dr));
    let push = of(&columns.push);
    let (gyro, decay) = (load(&columns.gyro), load(&columns.decay));
    let mut faded = f64x8::splat(simd, 1.0);
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
        store(phi[i], &mut columns.phi[i][first..]);
        store(dv[i], &mut columns.dv[i][first..]);
        store(dr[i], &mut columns.dr[i][first..]);
        store(push[i] * faded, &mut columns.push[i][first..]);
    }
}

/// Source states that are worked on together.
pub(super) const LANES: usize = 8;

/// The first lanes of `x`, filled up with zeros where it is shorter.
#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, x: &[f64]) -> f64x8<S> {
    if let Some(x) = x.first_chunk::<LANES>() {
        return f64x8::from_slice(simd, x);
    }
    let mut room = [0.0; LANES];
    room[..x.len()].copy_from_slice(x);
    f64x8::from_slice(simd, &room)
}

/// Writes as many lanes as there is room for.
#[inline(always)]
pub(super) fn store<S: Simd>(value: f64x8<S>, x: &mut [f64]) {
    if let Some(x) = x.first_chunk_mut::<LANES>() {
        return value.store_slice(x);
    }
    let mut room = [0.0; LANES];
    value.store_slice(&mut room);
    for (x, value) in x.iter_mut().zip(room) {
        *x = value;
    }
}
