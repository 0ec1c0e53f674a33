//! Coefficients in time, kept by what their step needs, so that a step is a few straight loops.
//!
//! A block of random words serves four steps, so as many are prepared at once. What is prepared is a
//! pure function of the state before it and the length of the step: it is no state itself.

use core::ops::Range;

use fearless_simd::{Simd, dispatch};

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
/// Steps that one block of random words serves, which are prepared together.
pub(crate) const STEPS: usize = 4;
/// Interval means that change: those of white noise, of first order, of second order.
pub(crate) const MAX_MOVING: usize = SECOND + MAX_SECOND;
/// Place of a mean that is always zero.
pub(crate) const ZERO: usize = MAX_MOVING;
/// Places of the first mean of first and of second order.
const FIRST: usize = MAX_WHITE;
const SECOND: usize = FIRST + MAX_FIRST;

/// First-order states that move together; draws of eight are stored at a time, so that loads of four that
/// begin at a multiple of four find theirs in one piece.
const LANES: usize = 4;

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
    /// The constant coefficients.
    pub constant: [f64; MAX_CONSTANT],
    /// Numbers of the steps that `rows` holds, each in the row of its place in the block.
    ahead: Range<u64>,
    rows: [Row; STEPS],
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

/// One step: interval means over it and states after it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub means: [f64; MAX_MOVING + 1],
    first: [f64; MAX_FIRST],
    second: [[f64; 2]; MAX_SECOND],
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
            constant: [0.0; MAX_CONSTANT],
            ahead: 0..0,
            rows: [Row {
                means: [0.0; MAX_MOVING + 1],
                first: [0.0; MAX_FIRST],
                second: [[0.0; 2]; MAX_SECOND],
            }; STEPS],
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

    /// Place of the first draw of white noise, after those of first and second order.
    fn white_draws(&self) -> usize {
        2 * self.firsts + 3 * self.seconds
    }

    /// Place of the first draw of the readout.
    fn readout_draws(&self) -> usize {
        self.white_draws() + self.whites
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
        (self.key, self.block, self.ahead) = (key, None, 0..0);
        for (component, place) in self.places(spec) {
            let e = component.evolution();
            for part in 0..place.count {
                let address = |draw| Address::new(&component, part, draw);
                let x = e.kind.initial(&e.arguments, part, key.start(self.level, address(3)));
                let i = place.first + part;
                let (whites, seconds) = (self.white_draws(), 2 * self.firsts);
                match place.shape {
                    Shape::Constant => self.constant[i] = e.gain * x[0],
                    Shape::White => self.addresses[whites + i] = address(2).0,
                    Shape::First => {
                        self.addresses[i] = address(0).0;
                        self.addresses[self.firsts + i] = address(2).0;
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

    /// Prepares for steps of `dt` seconds. Nothing may be prepared ahead: see [`Bank::forget`].
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

    /// The readout's normals of step `step`, which has been prepared.
    pub fn readout_normals(&self, step: u64, instrument: Instrument) -> [f64; DRAWS] {
        let row = &self.normals[row_of(step)];
        let first = self.readout_draws() + instrument as usize * DRAWS;
        [row[first], row[first + 1]]
    }

    /// Interval means of the parts at `place` over step `step`, which has been prepared.
    pub fn means(&self, place: Place, step: u64) -> &[f64] {
        let parts = place.parts();
        if place.shape == Shape::Constant {
            &self.constant[parts]
        } else {
            &self.rows[row_of(step)].means[parts]
        }
    }

    /// The rows of the block, for the steps that have been prepared.
    pub fn rows(&self) -> &[Row; STEPS] {
        &self.rows
    }

    /// Whether `step` has been prepared.
    pub fn has(&self, step: u64) -> bool {
        self.ahead.contains(&step)
    }

    /// Takes `state` back from the end of what is prepared to where it stands.
    pub fn settle(&self, state: &mut BankState) {
        if state.step < self.ahead.end {
            let row = &self.rows[row_of(state.step.wrapping_sub(1))];
            (state.first, state.second) = (row.first, row.second);
        }
    }

    /// Forgets what is prepared; `state` is settled first where it goes on.
    pub fn forget(&mut self) {
        self.ahead = 0..0;
    }

    /// Prepares the steps from that of `state` to the end of its block, of the length last prepared for.
    /// The states in `state` are afterwards those at the end of the block; its number stays.
    pub fn prepare(&mut self, state: &mut BankState) -> Range<usize> {
        let (block, from) = (state.step / STEPS as u64, row_of(state.step));
        if self.block != Some(block) {
            let n = self.draws;
            let out = self.normals.each_mut().map(|row| &mut row[..n]);
            fill_normals(self.level, self.key.0, block, &self.addresses[..n], out);
            self.block = Some(block);
        }
        dispatch!(self.level, simd => self.forward(simd, state, from));
        self.ahead = state.step..state.step + (STEPS - from) as u64;
        from..STEPS
    }

    /// Fills the rows from `from` on. In the widest lanes by the compiler's own means: no two elements
    /// meet, so the width does not change a bit.
    #[inline(always)]
    fn forward<S: Simd>(&mut self, _: S, state: &mut BankState, from: usize) {
        let n = self.firsts.next_multiple_of(LANES);
        for i in (0..n).step_by(LANES) {
            self.first.forward(i, self.firsts, &mut self.rows[from..], &self.normals[from..], state);
        }
        let whites = self.white_draws();
        for (row, normals) in self.rows[from..].iter_mut().zip(&self.normals[from..]) {
            for ((mean, scale), w) in
                row.means.iter_mut().zip(&self.white[..self.whites]).zip(&normals[whites..])
            {
                *mean = scale * w;
            }
            let (n, normals) = (self.seconds, &normals[2 * self.firsts..whites]);
            let means = &mut row.means[SECOND..];
            for i in 0..n {
                let (s, w) = (&self.second[i], [normals[i], normals[n + i], normals[2 * n + i]]);
                means[i] = s.coast(&mut state.second[i]) + s.noise_of(2, w);
                state.second[i][0] += s.noise_of(0, w);
                state.second[i][1] += s.noise_of(1, w);
                row.second[i] = state.second[i];
            }
            for i in n..n + self.frees {
                means[i] = self.second[i].coast(&mut state.second[i]);
                row.second[i] = state.second[i];
            }
        }
    }
}

impl First {
    /// Takes [`LANES`] states from `at` on through all `rows`; where fewer are in use the rest stays zero.
    #[inline(always)]
    fn forward(
        &self,
        at: usize,
        firsts: usize,
        rows: &mut [Row],
        normals: &[[f64; MAX_DRAWS]],
        state: &mut BankState,
    ) {
        let (phi, mean) = (lanes(&self.phi, at), lanes(&self.mean, at));
        let (n11, n31, n33) = (lanes(&self.n11, at), lanes(&self.n31, at), lanes(&self.n33, at));
        let mut x = lanes(&state.first, at);
        for (row, normals) in rows.iter_mut().zip(normals) {
            let (w1, w3) = (lanes(normals, at), lanes(normals, firsts + at));
            let mut y = [0.0; LANES];
            for i in 0..LANES {
                y[i] = mean[i] * x[i] + n31[i] * w1[i] + n33[i] * w3[i];
                x[i] = phi[i] * x[i] + n11[i] * w1[i];
            }
            row.means[FIRST + at..FIRST + at + LANES].copy_from_slice(&y);
            row.first[at..at + LANES].copy_from_slice(&x);
        }
        state.first[at..at + LANES].copy_from_slice(&x);
    }
}

#[inline(always)]
fn lanes(all: &[f64], at: usize) -> [f64; LANES] {
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&all[at..at + LANES]);
    lanes
}

/// Row of a step: its place in its block.
pub(crate) fn row_of(step: u64) -> usize {
    (step % STEPS as u64) as usize
}

fn shape(component: &Component) -> (Shape, usize) {
    let e = component.evolution();
    (e.kind.shape(&e.arguments), e.kind.parts(&e.arguments))
}

impl Place {
    /// Places of its parts among the means that change, or among the constants.
    pub fn parts(self) -> Range<usize> {
        let first = self.first
            + match self.shape {
                Shape::Constant | Shape::White => 0,
                Shape::First => FIRST,
                Shape::Second | Shape::Free => SECOND,
            };
        first..first + self.count
    }
}
