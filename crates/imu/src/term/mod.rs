//! Terms: how a coefficient vector becomes an output error.
//!
//! To add a term, write its file and name it in the two places below.

use core::fmt;

use fearless_simd::{Simd, dispatch};

use crate::random::{Level, STEPS};
use crate::truth::Seen;
use crate::{Input, Instrument, Unit};

mod anisoelastic;
mod anisoinertia;
mod asymmetry;
mod bias;
mod cross_coupling;
mod cubic;
mod g_sensitivity;
mod g_squared;
mod lever_arm;
mod misalignment;
mod mounting;
mod non_orthogonality;
mod quadratic;
mod scale_factor;
mod size_effect;
mod thermal;
mod thermal_2;
mod thermal_3;
mod thermal_rate;
mod thermal_scale_factor;
mod vibration_rectification;
mod vibropendulous;

pub use mounting::mounting_coefficients;

/// Every term, in the order of the documentation tables.
pub static TERMS: &[&dyn Term] = &[
    &bias::Bias,
    &scale_factor::ScaleFactor,
    &asymmetry::Asymmetry,
    &quadratic::Quadratic,
    &cubic::Cubic,
    &misalignment::Misalignment,
    &non_orthogonality::NonOrthogonality,
    &mounting::Mounting,
    &thermal::Thermal,
    &thermal_2::Thermal2,
    &thermal_3::Thermal3,
    &thermal_rate::ThermalRate,
    &thermal_scale_factor::ThermalScaleFactor,
    &g_sensitivity::GSensitivity,
    &g_squared::GSquared,
    &anisoelastic::Anisoelastic,
    &anisoinertia::Anisoinertia,
    &cross_coupling::CrossCoupling,
    &vibropendulous::Vibropendulous,
    &size_effect::SizeEffect,
    &lever_arm::LeverArm,
    &vibration_rectification::VibrationRectification,
];

/// Most coefficients that a term may have.
pub const MAX_COEFFICIENTS: usize = 9;

/// Labels of a term with one coefficient per axis.
const AXES: &[&str] = &["x", "y", "z"];

/// Labels of a 3 × 3 matrix of coefficients, row (output) by row.
const MATRIX: &[&str] = &["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

/// Labels of a matrix that takes the products of two axes to the three outputs.
const PRODUCTS: &[&str] = &["x_yz", "x_zx", "x_xy", "y_yz", "y_zx", "y_xy", "z_yz", "z_zx", "z_xy"];

/// The coefficients of a term, the first [`Term::len`] in use and the others zero.
pub type Coefficients = [f64; MAX_COEFFICIENTS];

/// An error term: linear in its coefficients, possibly non-linear in the input.
pub trait Term: Sync {
    /// Name in files and column headers, `scale_factor`.
    fn name(&self) -> &'static str;

    /// One line for people who know the field.
    fn doc(&self) -> &'static str;

    /// The equation, as text.
    fn formula(&self) -> &'static str;

    /// Where the term is defined.
    fn source(&self) -> &'static str;

    /// The instruments that can have it.
    fn instruments(&self) -> &'static [Instrument] {
        &Instrument::ALL
    }

    /// Unit of the coefficients on `instrument`.
    fn unit(&self, instrument: Instrument) -> Unit;

    /// Label of each coefficient; their number is the number of coefficients.
    fn labels(&self) -> &'static [&'static str] {
        AXES
    }

    /// Output error per axis (rad/s or m/s²) of coefficients `c` under `input`; linear in `c`.
    fn output(&self, input: &Input, c: &Coefficients) -> [f64; 3];

    /// Adds the output error to `sum`, which is kept where it is: a result that travels through memory in
    /// pieces of different widths costs more than the term itself.
    fn add_output(&self, input: &Input, c: &Coefficients, sum: &mut [f64; 3]) {
        let [x, y, z] = self.output(input, c);
        (sum[0], sum[1], sum[2]) = (sum[0] + x, sum[1] + y, sum[2] + z);
    }

    /// Adds the output errors of several steps, each with its own coefficients (of each in turn, its values
    /// in the steps), to those per axis in `sums`: one call for all of them, in lanes.
    fn add_outputs(
        &self,
        level: Level,
        inputs: &Seen<'_>,
        c: &[[f64; STEPS]; MAX_COEFFICIENTS],
        sums: &mut [[f64; STEPS]; 3],
    ) {
        let [x, y, z] = sums;
        dispatch!(level, simd => {
            add_axis::<_, _, 0>(simd, self, *inputs, c, x);
            add_axis::<_, _, 1>(simd, self, *inputs, c, y);
            add_axis::<_, _, 2>(simd, self, *inputs, c, z);
        });
    }

    /// Number of coefficients.
    fn len(&self) -> usize {
        self.labels().len()
    }

    /// Whether there is no coefficient at all (no term is so).
    fn is_empty(&self) -> bool {
        self.labels().is_empty()
    }

    /// The 3 × k matrix that takes coefficients to the output error under `input`.
    fn regressor(&self, input: &Input) -> Regressor {
        let mut r = Regressor { columns: [[0.0; 3]; MAX_COEFFICIENTS], len: self.len() };
        for j in 0..r.len {
            let mut unit = [0.0; MAX_COEFFICIENTS];
            unit[j] = 1.0;
            r.columns[j] = self.output(input, &unit);
        }
        r
    }
}

/// Adds the output error of one axis. Steps do not meet, so the width of the lanes, which the compiler
/// fills where one axis comes after the other, does not change a bit.
#[inline(always)]
fn add_axis<S: Simd, T: Term + ?Sized, const AXIS: usize>(
    _: S,
    term: &T,
    inputs: Seen<'_>,
    c: &[[f64; STEPS]; MAX_COEFFICIENTS],
    sum: &mut [f64; STEPS],
) {
    let mut errors = [0.0; STEPS];
    for i in 0..STEPS {
        let mut own = Coefficients::default();
        for (own, c) in own.iter_mut().zip(c) {
            *own = c[i];
        }
        errors[i] = term.output(&inputs.at(i), &own)[AXIS];
    }
    for i in 0..STEPS {
        sum[i] += errors[i];
    }
}

/// The 3 × k matrix of a term under one input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regressor {
    columns: [[f64; 3]; MAX_COEFFICIENTS],
    len: usize,
}

impl Regressor {
    /// Column of each coefficient: output error per axis and unit of the coefficient.
    pub fn columns(&self) -> &[[f64; 3]] {
        &self.columns[..self.len]
    }
}

/// The term called `name`, if there is one.
pub fn term(name: &str) -> Option<&'static dyn Term> {
    TERMS.iter().copied().find(|t| t.name() == name)
}

impl fmt::Debug for dyn Term {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}

impl PartialEq for dyn Term {
    fn eq(&self, o: &dyn Term) -> bool {
        self.name() == o.name()
    }
}

/// Product per axis.
#[inline(always)]
fn by_axis(c: &Coefficients, x: [f64; 3]) -> [f64; 3] {
    [c[0] * x[0], c[1] * x[1], c[2] * x[2]]
}

/// Product of the 3 × 3 matrix `c`, row by row, with `x`.
#[inline(always)]
fn by_matrix(c: &Coefficients, x: [f64; 3]) -> [f64; 3] {
    let row = |i: usize| c[i] * x[0] + c[i + 1] * x[1] + c[i + 2] * x[2];
    [row(0), row(3), row(6)]
}

/// Products yz, zx, xy of the components of `v`.
#[inline(always)]
fn products([x, y, z]: [f64; 3]) -> [f64; 3] {
    [y * z, z * x, x * y]
}

/// The matrix [ω×][ω×] + [ω̇×] that takes a lever arm to the acceleration of its end, 1/s².
#[inline(always)]
fn lever_gradient(input: &Input) -> [[f64; 3]; 3] {
    let ([x, y, z], [ax, ay, az]) = (input.omega, input.omega_dot);
    [
        [-y * y - z * z, x * y - az, x * z + ay],
        [x * y + az, -x * x - z * z, y * z - ax],
        [x * z - ay, y * z + ax, -x * x - y * y],
    ]
}
