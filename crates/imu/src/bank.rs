//! Coefficients in time, kept by what their step needs, so that a step is a few straight loops.

use crate::error::Error;
use crate::process::{Shape, Step};
use crate::random::{Address, Key, Level, best_level, fill_normals};
use crate::readout::DRAWS;
use crate::{Component, Instrument, Spec};

/// Most coefficients that keep their value.
pub const MAX_CONSTANT: usize = 192;
/// Most coefficients of white noise.
pub const MAX_WHITE: usize = 96;
/// Most first-order states.
pub const MAX_FIRST: usize = 192;
/// Most second-order pairs of states.
pub const MAX_SECOND: usize = 64;
/// One draw for white noise, two for a first and three for a second order.
const MAX_DRAWS: usize = MAX_WHITE + 2 * MAX_FIRST + 3 * MAX_SECOND + 2 * DRAWS;
/// Steps that one block of random words serves.
const STEPS: usize = 4;

/// Where the parts of a component are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub shape: Shape,
    pub first: usize,
    pub count: usize,
}

/// Coefficients of all sources in time.
#[derive(Clone, Debug)]
pub(crate) struct Bank {
    level: Level,
    key: Key,
    constants: usize,
    whites: usize,
    firsts: usize,
    /// Pairs with noise stand before those without.
    seconds: usize,
    frees: usize,
    white: [f64; MAX_WHITE],
    first: First,
    second: [Step; MAX_SECOND],
    draws: usize,
    addresses: [u64; MAX_DRAWS],
    normals: [[f64; MAX_DRAWS]; STEPS],
    /// Block of random words that `normals` holds.
    block: Option<u64>,
    /// Interval means of the last step, constants included.
    pub means: Means,
}

/// Steps of first order, one array for each coefficient of the step.
#[derive(Clone, Debug)]
struct First {
    phi: [f64; MAX_FIRST],
    mean: [f64; MAX_FIRST],
    n11: [f64; MAX_FIRST],
    n31: [f64; MAX_FIRST],
    n33: [f64; MAX_FIRST],
}

/// Interval means of the coefficients.
#[derive(Clone, Debug)]
pub(crate) struct Means {
    pub constant: [f64; MAX_CONSTANT],
    pub white: [f64; MAX_WHITE],
    pub first: [f64; MAX_FIRST],
    pub second: [f64; MAX_SECOND],
}

/// What changes in a bank from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BankState {
    pub step: u64,
    pub first: [f64; MAX_FIRST],
    pub second: [[f64; 2]; MAX_SECOND],
}

impl Bank {
    /// An empty bank with room for the components of `spec`.
    ///
    /// # Errors
    /// There are more coefficients of a shape than the bank holds.
    pub fn new(spec: &Spec) -> Result<Bank, Error> {
        let mut bank = Bank {
            level: best_level(),
            key: Key([0; 2]),
            constants: 0,
            whites: 0,
            firsts: 0,
            seconds: 0,
            frees: 0,
            white: [0.0; MAX_WHITE],
            first: First {
                phi: [0.0; MAX_FIRST],
                mean: [0.0; MAX_FIRST],
                n11: [0.0; MAX_FIRST],
                n31: [0.0; MAX_FIRST],
                n33: [0.0; MAX_FIRST],
            },
            second: [Step::default(); MAX_SECOND],
            draws: 0,
            addresses: [0; MAX_DRAWS],
            normals: [[0.0; MAX_DRAWS]; STEPS],
            block: None,
            means: Means {
                constant: [0.0; MAX_CONSTANT],
                white: [0.0; MAX_WHITE],
                first: [0.0; MAX_FIRST],
                second: [0.0; MAX_SECOND],
            },
        };
        for component in spec.components() {
            let (shape, parts) = shape(&component);
            *bank.count(shape) += parts;
        }
        let room = [
            ("constant coefficients", bank.constants, MAX_CONSTANT),
            ("coefficients of white noise", bank.whites, MAX_WHITE),
            ("first-order states", bank.firsts, MAX_FIRST),
            ("second-order processes", bank.seconds + bank.frees, MAX_SECOND),
        ];
        for (what, need, capacity) in room {
            if need > capacity {
                return Err(Error::Capacity { what, need, capacity });
            }
        }
        let readout = if spec.readout.is_some() { 2 * DRAWS } else { 0 };
        bank.draws = (bank.readout_draws() + readout).next_multiple_of(8);
        Ok(bank)
    }

    /// Place of the first draw of the readout.
    fn readout_draws(&self) -> usize {
        self.whites + 2 * self.firsts + 3 * self.seconds
    }

    fn count(&mut self, shape: Shape) -> &mut usize {
        match shape {
            Shape::Constant => &mut self.constants,
            Shape::White => &mut self.whites,
            Shape::First => &mut self.firsts,
            Shape::Second => &mut self.seconds,
            Shape::Free => &mut self.frees,
        }
    }

    /// The place of each component in turn.
    pub fn places<'a>(&self, spec: &'a Spec) -> impl Iterator<Item = (Component, Place)> + use<'a> {
        let mut next = [0, 0, 0, 0, self.seconds];
        spec.components().map(move |component| {
            let (shape, count) = shape(&component);
            let first = next[shape as usize];
            next[shape as usize] += count;
            (component, Place { shape, first, count })
        })
    }

    /// Addresses of the draws, and the state at t = 0 in the run of `key`.
    pub fn start(&mut self, spec: &Spec, key: Key) -> BankState {
        let mut state = BankState { step: 0, first: [0.0; MAX_FIRST], second: [[0.0; 2]; MAX_SECOND] };
        (self.key, self.block) = (key, None);
        for (component, place) in self.places(spec) {
            let e = component.evolution();
            for part in 0..place.count {
                let address = |draw| Address::new(&component, part, draw);
                let x = e.kind.initial(&e.arguments, part, key.start(self.level, address(3)));
                let i = place.first + part;
                let (firsts, seconds) = (self.whites, self.whites + 2 * self.firsts);
                match place.shape {
                    Shape::Constant => self.means.constant[i] = e.gain * x[0],
                    Shape::White => self.addresses[i] = address(2).0,
                    Shape::First => {
                        self.addresses[firsts + i] = address(0).0;
                        self.addresses[firsts + self.firsts + i] = address(2).0;
                        state.first[i] = x[0];
                    }
                    Shape::Second | Shape::Free => state.second[i] = x,
                }
                if place.shape == Shape::Second {
                    (0..3).for_each(|d| self.addresses[seconds + d * self.seconds + i] = address(d).0);
                }
            }
        }
        if spec.readout.is_some() {
            let draws = self.readout_draws();
            for instrument in Instrument::ALL {
                for d in 0..DRAWS {
                    let name = format_args!("{instrument}.readout");
                    self.addresses[draws + instrument as usize * DRAWS + d] = Address::new(&name, 0, d).0;
                }
            }
        }
        state
    }

    /// Prepares for steps of `dt` seconds.
    pub fn discretise(&mut self, spec: &Spec, dt: f64) {
        for (component, place) in self.places(spec) {
            if place.shape == Shape::Constant {
                continue;
            }
            let e = component.evolution();
            for part in 0..place.count {
                let i = place.first + part;
                let mut step = e.kind.step(&e.arguments, part, dt);
                step.mean = step.mean.map(|m| m * e.gain);
                step.noise[2] = step.noise[2].map(|n| n * e.gain);
                match place.shape {
                    Shape::Constant => {}
                    Shape::White => self.white[i] = step.noise[2][2],
                    Shape::First => {
                        let f = &mut self.first;
                        (f.phi[i], f.mean[i]) = (step.phi[0][0], step.mean[0]);
                        (f.n11[i], f.n31[i], f.n33[i]) =
                            (step.noise[0][0], step.noise[2][0], step.noise[2][2]);
                    }
                    Shape::Second | Shape::Free => self.second[i] = step,
                }
            }
        }
    }

    /// The readout's normals of the step that was last advanced to.
    pub fn readout_normals(&self, state: &BankState, instrument: Instrument) -> [f64; DRAWS] {
        let row = &self.normals[(state.step.wrapping_sub(1) % STEPS as u64) as usize];
        let first = self.readout_draws() + instrument as usize * DRAWS;
        [row[first], row[first + 1]]
    }

    /// One step of the length last prepared for.
    pub fn advance(&mut self, state: &mut BankState) {
        let block = state.step / STEPS as u64;
        if self.block != Some(block) {
            let n = self.draws;
            let out = self.normals.each_mut().map(|row| &mut row[..n]);
            fill_normals(self.level, self.key.0, block, &self.addresses[..n], out);
            self.block = Some(block);
        }
        let normals = &self.normals[(state.step % STEPS as u64) as usize];
        state.step += 1;

        let (white, normals) = normals.split_at(self.whites);
        for ((mean, scale), w) in self.means.white.iter_mut().zip(&self.white).zip(white) {
            *mean = scale * w;
        }

        let n = self.firsts;
        let (w1, normals) = normals.split_at(n);
        let (w3, normals) = normals.split_at(n);
        let f = &self.first;
        let (phi, mean, n11, n31, n33) = (&f.phi[..n], &f.mean[..n], &f.n11[..n], &f.n31[..n], &f.n33[..n]);
        let (x, y) = (&mut state.first[..n], &mut self.means.first[..n]);
        for i in 0..n {
            y[i] = mean[i] * x[i] + n31[i] * w1[i] + n33[i] * w3[i];
            x[i] = phi[i] * x[i] + n11[i] * w1[i];
        }

        let n = self.seconds;
        for i in 0..n {
            let (s, w) = (&self.second[i], [normals[i], normals[n + i], normals[2 * n + i]]);
            let noise = |r: usize| s.noise[r][0] * w[0] + s.noise[r][1] * w[1] + s.noise[r][2] * w[2];
            let mean = s.coast(&mut state.second[i]);
            self.means.second[i] = mean + noise(2);
            state.second[i][0] += noise(0);
            state.second[i][1] += noise(1);
        }
        for i in n..n + self.frees {
            self.means.second[i] = self.second[i].coast(&mut state.second[i]);
        }
    }
}

fn shape(component: &Component) -> (Shape, usize) {
    let e = component.evolution();
    (e.kind.shape(&e.arguments), e.kind.parts(&e.arguments))
}

impl Means {
    /// Interval means of the parts at `place`.
    pub fn at(&self, place: Place) -> &[f64] {
        let range = place.first..place.first + place.count;
        match place.shape {
            Shape::Constant => &self.constant[range],
            Shape::White => &self.white[range],
            Shape::First => &self.first[range],
            Shape::Second | Shape::Free => &self.second[range],
        }
    }
}
