//! The states of a filter: navigation errors, states of error sources, states of measurements.

use core::fmt;

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use schuler_imu::process::{LinearModel, MAX_STATES};
use schuler_imu::{Component, Instrument, Spec, Truth};

use super::block::{Block, Groups, Inputs, Origin, constant_column};
use super::{FilterError, Form, NavState, NavStates};
use crate::System;

/// What the states of a filter are and how they behave; room for `N` of them.
///
/// The chosen navigation errors come first, in their order, then the states of the error sources in the order of
/// their list (a constant, a random walk or a Gauss-Markov process has one, flicker as many as it has poles, white
/// noise none), then the states of measurements. `N` is the room; what work costs depends on the number in use,
/// [`Model::len`].
///
/// ```
/// use schuler_imu::{Instrument::Gyro, Source, Spec};
/// use schuler_strapdown::filter::{Form, Model, NavStates};
/// let spec = Spec::from_sources([Source::named(Gyro, "bias", "constant", &[("sigma", 5e-8.into())])?])?;
/// let model = Model::<16>::new(Form::Phi, NavStates::LEVEL, &spec).unwrap();
/// assert_eq!(model.len(), 8);
/// assert_eq!(model.name(4).to_string(), "phi_d");
/// assert_eq!(model.name(5).to_string(), "gyro.bias.constant.x");
/// # Ok::<(), schuler_imu::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Model<const N: usize> {
    form: Form,
    nav: NavStates,
    /// Number of each chosen navigation error among the nine.
    full: [usize; 9],
    n: usize,
    blocks: [Option<Block>; N],
    block_count: usize,
    /// Densities of white sensor noise that does not depend on the input, gyro and accelerometer, body axes.
    white: [Matrix3<f64>; 2],
    /// Spectral densities of white noise that drives the nine navigation errors directly.
    pub nav_noise: [f64; 9],
    calibration: f64,
}

impl<const N: usize> Model<N> {
    /// The chosen navigation errors in `form`, and the states of the error sources of `spec`, whose sensors are taken
    /// along body axes. A readout is not modelled.
    ///
    /// # Errors
    /// [`FilterError::Capacity`] with more than `N` states.
    pub fn new(form: Form, nav: NavStates, spec: &Spec) -> Result<Self, FilterError> {
        let mut full = [0; 9];
        for (k, state) in nav.iter().enumerate() {
            full[k] = state as usize;
        }
        let mut model = Model {
            form,
            nav,
            full,
            n: nav.len(),
            blocks: [None; N],
            block_count: 0,
            white: [Matrix3::zeros(); 2],
            nav_noise: [0.0; 9],
            calibration: spec.calibration_temperature,
        };
        model.room_for(model.n)?;
        for component in spec.components() {
            model.add_source(component)?;
        }
        Ok(model)
    }

    /// Adds states that only measurements see, such as their coloured noise or a lever arm: one coefficient that
    /// behaves as `process`. Returns the number of its first state.
    ///
    /// # Errors
    /// [`FilterError::Capacity`] with more than `N` states.
    pub fn add_extra(&mut self, name: &'static str, process: &LinearModel) -> Result<usize, FilterError> {
        let first = self.n;
        self.add_blocks(Origin { source: None, name }, process, None)?;
        Ok(first)
    }

    fn room_for(&self, need: usize) -> Result<(), FilterError> {
        if need > N { Err(FilterError::Capacity { need, capacity: N }) } else { Ok(()) }
    }

    fn add_source(&mut self, component: Component) -> Result<(), FilterError> {
        let process = component.evolution().linear_model();
        let column = constant_column(&component);
        match column {
            Some(column) => {
                let column = Vector3::from(column);
                self.white[component.instrument() as usize] += column * column.transpose() * process.white;
            }
            None if process.white > 0.0 => self.add_block(Block {
                origin: Origin { source: Some(component), name: "" },
                first: self.n,
                len: 0,
                part: 0,
                parts: 0,
                a: [[0.0; 2]; 2],
                q: [[0.0; 2]; 2],
                c: [0.0; 2],
                x0: [0.0; 2],
                p0: [[0.0; 2]; 2],
                white: process.white,
                column: None,
            })?,
            None => {}
        }
        self.add_blocks(Origin { source: Some(component), name: "" }, &process, column)
    }

    fn add_blocks(
        &mut self,
        origin: Origin,
        process: &LinearModel,
        column: Option<[f64; 3]>,
    ) -> Result<(), FilterError> {
        for list in Groups::of(process)?.iter() {
            let len = list.len();
            let pick = |m: &[[f64; MAX_STATES]; MAX_STATES]| {
                core::array::from_fn(|i| {
                    core::array::from_fn(|j| if i < len && j < len { m[list[i]][list[j]] } else { 0.0 })
                })
            };
            let pick_row =
                |v: &[f64; MAX_STATES]| core::array::from_fn(|i| if i < len { v[list[i]] } else { 0.0 });
            self.add_block(Block {
                origin,
                first: self.n,
                len,
                part: list[0],
                parts: process.n,
                a: pick(&process.a),
                q: pick(&process.q),
                c: pick_row(&process.c),
                x0: pick_row(&process.x0),
                p0: pick(&process.p0),
                white: 0.0,
                column,
            })?;
        }
        Ok(())
    }

    fn add_block(&mut self, block: Block) -> Result<(), FilterError> {
        self.room_for((self.n + block.len).max(self.block_count + 1))?;
        self.blocks[self.block_count] = Some(block);
        self.block_count += 1;
        self.n += block.len;
        Ok(())
    }

    /// Number of states in use.
    #[allow(clippy::len_without_is_empty, reason = "a filter without states makes no sense")]
    pub fn len(&self) -> usize {
        self.n
    }

    /// Number of navigation errors: the first states.
    pub fn nav_len(&self) -> usize {
        self.nav.len()
    }

    /// The navigation errors chosen.
    pub fn nav(&self) -> NavStates {
        self.nav
    }

    /// The form of the dynamics.
    pub fn form(&self) -> Form {
        self.form
    }

    /// Number among the nine errors of each navigation state.
    pub(crate) fn full(&self) -> &[usize] {
        &self.full[..self.nav.len()]
    }

    pub(crate) fn blocks(&self) -> impl Iterator<Item = &Block> {
        self.blocks[..self.block_count].iter().flatten()
    }

    /// Number of the state that is `error`, if it was chosen.
    pub fn nav_index(&self, error: NavState) -> Option<usize> {
        self.full().iter().position(|&k| k == error as usize)
    }

    /// Number of the first state of the component of that name (`gyro.bias.constant.x`) or of an added state.
    pub fn index(&self, name: &str) -> Option<usize> {
        (0..self.n).find(|&k| is_written(name, &self.name(k)))
    }

    /// Name of state `k` in reports: `phi_n`, `gyro.bias.constant.x`, `gyro.bias.flicker.x[2]`.
    pub fn name(&self, k: usize) -> impl fmt::Display + use<'_, N> {
        StateName { model: self, k }
    }

    /// Mean of the states at the start: zero, but for sources with a fixed value.
    pub fn x0(&self) -> SVector<f64, N> {
        let mut x = SVector::zeros();
        for block in self.blocks() {
            for (k, state) in block.states().enumerate() {
                x[state] = block.x0[k];
            }
        }
        x
    }

    /// Covariance at the start: standard deviations of the nine navigation errors (those left out are not looked at),
    /// and what the sources say.
    ///
    /// # Errors
    /// [`FilterError::Sigma`] for a deviation that is negative or not finite.
    pub fn p0(&self, nav_sigma: &[f64; 9]) -> Result<SMatrix<f64, N, N>, FilterError> {
        let mut p = SMatrix::zeros();
        for (k, &full) in self.full().iter().enumerate() {
            let sigma = nav_sigma[full];
            if !(sigma >= 0.0 && sigma.is_finite()) {
                return Err(FilterError::Sigma { state: k, sigma });
            }
            p[(k, k)] = sigma * sigma;
        }
        for block in self.blocks() {
            for (i, row) in block.states().enumerate() {
                for (j, column) in block.states().enumerate() {
                    p[(row, column)] = block.p0[i][j];
                }
            }
        }
        Ok(p)
    }

    /// The state of `other` that is the same as state `k`: same navigation error, or same component and number, or same
    /// name.
    pub(crate) fn twin_in<const M: usize>(&self, k: usize, other: &Model<M>) -> Option<usize> {
        if let Some(&full) = self.full().get(k) {
            return other.nav_index(NavState::ALL[full]);
        }
        let block = self.blocks().find(|b| b.states().contains(&k))?;
        let same = |b: &&Block| {
            b.len == block.len
                && b.part == block.part
                && match (&b.origin.source, &block.origin.source) {
                    (Some(a), Some(b)) => a.is(b),
                    (None, None) => b.origin.name == block.origin.name,
                    _ => false,
                }
        };
        other.blocks().find(same).map(|b| b.first + k - block.first)
    }

    /// Dynamics of all states under a constant `system` of the model's form, the sensors having `seen` the same all the
    /// time, 1/s.
    pub fn dynamics(&self, system: &System, seen: &Truth) -> SMatrix<f64, N, N> {
        let inputs = self.inputs(seen, 1.0);
        let mut f = SMatrix::zeros();
        for (i, &full_i) in self.full().iter().enumerate() {
            for (j, &full_j) in self.full().iter().enumerate() {
                f[(i, j)] = system.f[(full_i, full_j)];
            }
        }
        for block in self.blocks() {
            let column = Vector3::from(block.column(&inputs));
            let enters = match block.instrument() {
                Some(Instrument::Gyro) => system.b_gyro * column,
                Some(Instrument::Accel) => system.b_accel * column,
                None => SMatrix::zeros(),
            };
            for (k, s) in block.states().enumerate() {
                for (i, &full_i) in self.full().iter().enumerate() {
                    f[(i, s)] = enters[full_i] * block.c[k];
                }
                for (l, t) in block.states().enumerate() {
                    f[(s, t)] = block.a[k][l];
                }
            }
        }
        f
    }

    pub(crate) fn inputs(&self, seen: &Truth, dt: f64) -> Inputs {
        Inputs::new(seen, dt, self.calibration)
    }

    /// Spectral density of the white noise of a sensor along body axes, under `inputs`.
    pub(crate) fn white(&self, instrument: Instrument, inputs: &Inputs) -> Matrix3<f64> {
        let mut white = self.white[instrument as usize];
        for block in self.blocks().filter(|b| b.white > 0.0 && b.instrument() == Some(instrument)) {
            let column = Vector3::from(block.column(inputs));
            white += column * column.transpose() * block.white;
        }
        white
    }

    /// The density of white noise of a sensor where it is the same along all axes, whatever the input.
    pub(crate) fn isotropic(&self, instrument: Instrument) -> Option<f64> {
        let white = self.white[instrument as usize];
        let depends = self.blocks().any(|b| b.white > 0.0 && b.instrument() == Some(instrument));
        (!depends && white == Matrix3::from_diagonal_element(white[(0, 0)])).then_some(white[(0, 0)])
    }

    /// Spectral density of the white noise of the nine navigation errors, under `inputs`.
    pub(crate) fn nav_density(&self, system: &System, inputs: &Inputs) -> SMatrix<f64, 9, 9> {
        let mut q = system.b_gyro * self.white(Instrument::Gyro, inputs) * system.b_gyro.transpose()
            + system.b_accel * self.white(Instrument::Accel, inputs) * system.b_accel.transpose();
        for (k, density) in self.nav_noise.iter().enumerate() {
            q[(k, k)] += density;
        }
        q
    }

    /// Error of `instrument` along body axes that the source states `x` make under what it has `seen` over `dt` (s).
    pub fn sensor_error(
        &self,
        instrument: Instrument,
        x: &SVector<f64, N>,
        seen: &Truth,
        dt: f64,
    ) -> [f64; 3] {
        let inputs = self.inputs(seen, dt);
        let mut sum = [0.0; 3];
        for block in self.blocks().filter(|b| b.instrument() == Some(instrument) && b.len > 0) {
            let coefficient: f64 = block.states().zip(block.c).map(|(state, c)| c * x[state]).sum();
            let column = block.column(&inputs);
            for axis in 0..3 {
                sum[axis] += column[axis] * coefficient;
            }
        }
        sum
    }
}

struct StateName<'a, const N: usize> {
    model: &'a Model<N>,
    k: usize,
}

impl<const N: usize> fmt::Display for StateName<'_, N> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (model, k) = (self.model, self.k);
        if let Some(&full) = model.full().get(k) {
            return out.write_str(NavState::ALL[full].name(model.form));
        }
        match model.blocks().find(|b| b.states().contains(&k)) {
            Some(block) => block.write_name(k - block.first, out),
            None => write!(out, "none[{k}]"),
        }
    }
}

/// Whether `shown` is written as `name`, or as `name` with the number of a state behind it.
fn is_written(name: &str, shown: &dyn fmt::Display) -> bool {
    struct Rest<'a>(Option<&'a str>);
    impl fmt::Write for Rest<'_> {
        fn write_str(&mut self, s: &str) -> fmt::Result {
            self.0 = match self.0 {
                Some("") if s.starts_with('[') => None,
                Some(rest) => Some(rest.strip_prefix(s).ok_or(fmt::Error)?),
                None => None,
            };
            Ok(())
        }
    }
    let mut rest = Rest(Some(name));
    fmt::write(&mut rest, format_args!("{shown}")).is_ok() && rest.0.is_none_or(str::is_empty)
}
