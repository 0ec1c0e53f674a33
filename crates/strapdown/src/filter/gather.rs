//! The kernel of gathering: one IMU step of all source states, in the widest lanes of the machine.

use fearless_simd::{Simd, SimdBase};

/// Attitude, velocity and position error that a unit of each source state has made so far, by axis.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const N: usize> {
    pub phi: [[f64; N]; 3],
    pub dv: [[f64; N]; 3],
    pub dr: [[f64; N]; 3],
    /// Sensor error along body axes that a unit of the state at the start makes in the mean of this step.
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
}

/// One step of `dt` (s): sensor axes `c` in t, velocity gained `a` (m/s, t). Of the first `len` states:
///
/// ```text
/// d = C push dt,   gyro: phi := phi - d,   accelerometer: dv := dv + d
/// dv := dv + a × (phi in the middle),   dr := dr + dt (dv in the middle)
/// ```
#[inline(always)]
pub(crate) fn gather<S: Simd, const N: usize>(
    simd: S,
    columns: &mut Columns<N>,
    c: &[[f64; 3]; 3],
    a: [f64; 3],
    dt: f64,
    len: usize,
) {
    let lanes = S::f64s::LEN;
    let mut first = 0;
    while first < len {
        // Lanes beyond those in use carry zeros; a last piece shorter than the lanes goes through a copy.
        if first + lanes <= N {
            piece::<S, N>(simd, columns, c, a, dt, first);
        } else {
            for s in first..len {
                single(columns, c, a, dt, s);
            }
        }
        first += lanes;
    }
}

#[inline(always)]
fn piece<S: Simd, const N: usize>(
    simd: S,
    columns: &mut Columns<N>,
    c: &[[f64; 3]; 3],
    a: [f64; 3],
    dt: f64,
    first: usize,
) {
    let range = first..first + S::f64s::LEN;
    let load = |x: &[f64; N]| S::f64s::from_slice(simd, &x[range.clone()]);
    let push = [load(&columns.push[0]), load(&columns.push[1]), load(&columns.push[2])];
    let gyro = load(&columns.gyro);
    let mut middle = push;
    let mut direct = push;
    for i in 0..3 {
        let d = (push[0] * c[i][0] + push[1] * c[i][1] + push[2] * c[i][2]) * dt;
        let turn = d * gyro;
        direct[i] = d - turn;
        let phi = load(&columns.phi[i]);
        middle[i] = phi - turn * 0.5;
        (phi - turn).store_slice(&mut columns.phi[i][range.clone()]);
    }
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let gained = middle[k] * a[j] - middle[j] * a[k] + direct[i];
        let dv = load(&columns.dv[i]);
        let dr = load(&columns.dr[i]) + (dv + gained * 0.5) * dt;
        dr.store_slice(&mut columns.dr[i][range.clone()]);
        (dv + gained).store_slice(&mut columns.dv[i][range.clone()]);
    }
    let decay = load(&columns.decay);
    for i in 0..3 {
        (push[i] * decay).store_slice(&mut columns.push[i][range.clone()]);
    }
}

fn single<const N: usize>(columns: &mut Columns<N>, c: &[[f64; 3]; 3], a: [f64; 3], dt: f64, s: usize) {
    let push: [f64; 3] = core::array::from_fn(|i| columns.push[i][s]);
    let (mut middle, mut direct) = ([0.0; 3], [0.0; 3]);
    for i in 0..3 {
        let d = (push[0] * c[i][0] + push[1] * c[i][1] + push[2] * c[i][2]) * dt;
        let turn = d * columns.gyro[s];
        direct[i] = d - turn;
        middle[i] = columns.phi[i][s] - turn * 0.5;
        columns.phi[i][s] -= turn;
    }
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let gained = middle[k] * a[j] - middle[j] * a[k] + direct[i];
        columns.dr[i][s] += (columns.dv[i][s] + gained * 0.5) * dt;
        columns.dv[i][s] += gained;
        columns.push[i][s] *= columns.decay[s];
    }
}
