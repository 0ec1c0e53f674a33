//! Source states: the smallest groups of states that act upon each other.

use core::fmt;

use schuler_imu::process::{LinearModel, MAX_STATES};
use schuler_imu::{Component, Input, Instrument, Truth};

use super::FilterError;

/// Largest group; all processes are sums of such of one state or two.
pub(crate) const MAX_BLOCK: usize = 2;

/// A small square matrix of a block.
pub(crate) type Small = [[f64; MAX_BLOCK]; MAX_BLOCK];

/// What a state belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Origin {
    /// The coefficient of an error source; none for a state that only measurements see.
    pub source: Option<Component>,
    /// Name of such a state.
    pub name: &'static str,
}

/// A group of states `x' = a x + w` whose coefficient `c x` enters a sensor's error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Block {
    pub origin: Origin,
    /// Its first state in the filter.
    pub first: usize,
    pub len: usize,
    /// Number of the first state within its process, and how many that has.
    pub part: usize,
    pub parts: usize,
    pub a: Small,
    pub q: Small,
    pub c: [f64; MAX_BLOCK],
    pub x0: [f64; MAX_BLOCK],
    pub p0: Small,
    /// Spectral density of white noise of the coefficient.
    pub white: f64,
    /// The column through which the coefficient enters, where it does not depend on the input.
    pub column: Option<[f64; 3]>,
}

/// What gyros and accelerometers see over an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inputs {
    gyro: Input,
    accel: Input,
}

impl Inputs {
    pub fn new(seen: &Truth, dt: f64, calibration: f64) -> Self {
        Inputs {
            gyro: Input::new(Instrument::Gyro, seen, dt, calibration),
            accel: Input::new(Instrument::Accel, seen, dt, calibration),
        }
    }

    fn of(&self, instrument: Instrument) -> &Input {
        match instrument {
            Instrument::Gyro => &self.gyro,
            Instrument::Accel => &self.accel,
        }
    }
}

impl Block {
    pub fn instrument(&self) -> Option<Instrument> {
        self.origin.source.map(|component| component.instrument())
    }

    /// Whether noise drives its states.
    pub fn is_driven(&self) -> bool {
        self.len > 0 && self.q != [[0.0; 2]; 2]
    }

    /// Error of the instrument along body axes per unit of the coefficient.
    pub fn column(&self, inputs: &Inputs) -> [f64; 3] {
        match (self.column, &self.origin.source) {
            (Some(column), _) => column,
            (None, Some(component)) => column(component, inputs.of(component.instrument())),
            (None, None) => [0.0; 3],
        }
    }

    /// The states in the filter.
    pub fn states(&self) -> core::ops::Range<usize> {
        self.first..self.first + self.len
    }

    /// Name of the state `k` of this block.
    pub fn write_name(&self, k: usize, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.origin.source {
            Some(component) => write!(out, "{component}")?,
            None => out.write_str(self.origin.name)?,
        }
        if self.parts > 1 { write!(out, "[{}]", self.part + k) } else { Ok(()) }
    }
}

/// Column of a component's term under `input`.
fn column(component: &Component, input: &Input) -> [f64; 3] {
    let mut unit = [0.0; schuler_imu::term::MAX_COEFFICIENTS];
    unit[component.coefficient()] = 1.0;
    component.term().output(input, &unit)
}

/// The column where it is the same for whatever input: compared at two inputs without anything in common.
pub(crate) fn constant_column(component: &Component) -> Option<[f64; 3]> {
    let seen = |x: f64, y: f64| {
        let truth = Truth::rates([x, 2.0 * y, -3.0 * x], [y, -5.0 * x, 7.0 * y])
            .with_temperature(300.0 + x, y)
            .with_omega_dot([2.0 * y, x, -y])
            .with_vibration([x * x, y * y, x * x + y * y]);
        column(component, &Input::new(component.instrument(), &truth, 1.0, Truth::TEMPERATURE))
    };
    let (one, other) = (seen(1.3, 0.7), seen(-0.4, 2.1));
    (one == other).then_some(one)
}

/// The groups of a process, each a list of its states.
pub(crate) struct Groups {
    lists: [[usize; MAX_BLOCK]; MAX_STATES],
    lens: [usize; MAX_STATES],
    count: usize,
}

impl Groups {
    /// Only what acts upon each other or is correlated stays together.
    pub fn of(model: &LinearModel) -> Result<Self, FilterError> {
        let mut groups = Groups { lists: [[0; MAX_BLOCK]; MAX_STATES], lens: [0; MAX_STATES], count: 0 };
        let joined = |i: usize, j: usize| {
            [&model.a, &model.q, &model.p0].iter().any(|m| m[i][j] != 0.0 || m[j][i] != 0.0)
        };
        let mut taken = [false; MAX_STATES];
        for i in 0..model.n {
            if taken[i] {
                continue;
            }
            let mut group = [i; MAX_STATES];
            let (mut len, mut next) = (1, 0);
            taken[i] = true;
            while next < len {
                for j in 0..model.n {
                    if !taken[j] && joined(group[next], j) {
                        taken[j] = true;
                        group[len] = j;
                        len += 1;
                    }
                }
                next += 1;
            }
            if len > MAX_BLOCK {
                return Err(FilterError::Coupled { states: len });
            }
            groups.lists[groups.count].copy_from_slice(&group[..MAX_BLOCK]);
            groups.lens[groups.count] = len;
            groups.count += 1;
        }
        Ok(groups)
    }

    pub fn iter(&self) -> impl Iterator<Item = &[usize]> {
        self.lists.iter().zip(self.lens).take(self.count).map(|(list, len)| &list[..len])
    }
}
