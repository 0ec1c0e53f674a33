//! Coefficients in time, kept by what their step needs, so that a step is a few straight loops.
//!
//! Random words come for some [`STEPS`] steps at a time, and [`STEPS`] are prepared at once. What is prepared is a
//! pure function of the state before it and the length of the step: it is no state itself. An interval
//! mean takes one normal: see [`Innovation`](crate::process::Innovation).

use core::ops::Range;

use fearless_simd::{Simd, dispatch};

use crate::error::Error;
use crate::moving::{First, Second, add};
use crate::process::{SETTLED, Shape};
use crate::random::{Address, Drawn, Key, Level, OCTETS, STEPS, best_level, fill_drawn};
use crate::readout::DRAWS;
use crate::sums::Sums;
use crate::{Component, Instrument, Spec};

/// Most coefficients that keep their value.
pub const MAX_CONSTANT: usize = 192;
/// Most coefficients of white noise.
pub const MAX_WHITE: usize = 96;
/// Most first-order states.
pub const MAX_FIRST: usize = 192;
/// Most second-order pairs of states.
pub const MAX_SECOND: usize = 64;
/// Most parts of coefficients that change.
pub const MAX_MOVING: usize = MAX_WHITE + MAX_FIRST + MAX_SECOND;
const MAX_DRAWS: usize = MAX_MOVING + 2 * DRAWS;
/// Draws are made for this many addresses at a time.
const TOGETHER: usize = 2;

/// Where the parts of a component are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub shape: Shape,
    pub first: usize,
    pub count: usize,
}

/// Coefficients of all sources in time.
///
/// Each array fills whole lines of the cache, and begins with one: lanes that lie across two of them are read twice.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Bank {
    normals: [Drawn; MAX_DRAWS],
    first: First,
    second: Second,
    pub level: Level,
    key: Key,
    constants: usize,
    whites: usize,
    /// Second-order parts with noise, which stand before those without.
    seconds: usize,
    constant: [f64; MAX_CONSTANT],
    white: [f64; MAX_WHITE],
    /// Whether the innovations are those of the settled covariances of the state.
    settled: bool,
    draws: usize,
    addresses: [u64; MAX_DRAWS],
    /// The first of the eights of steps that `normals` is for.
    octet: Option<u64>,
    /// Numbers of the steps that are prepared, each in the row of its place among eight.
    ahead: Range<u64>,
}

/// What changes in a bank from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BankState {
    pub step: u64,
    /// Length of the step before, and of how many before it, up to [`SETTLED`].
    pub dt: f64,
    pub alike: u32,
    /// Expectations of the states, given all interval means so far, and covariances.
    pub first: [f64; MAX_FIRST],
    pub second: [[f64; MAX_SECOND]; 2],
    pub first_covariance: [f64; MAX_FIRST],
    pub second_covariance: [[f64; 3]; MAX_SECOND],
}

impl BankState {
    /// Before the first step, every state zero.
    pub const START: BankState = BankState {
        step: 0,
        dt: 0.0,
        alike: 0,
        first: [0.0; MAX_FIRST],
        second: [[0.0; MAX_SECOND]; 2],
        first_covariance: [0.0; MAX_FIRST],
        second_covariance: [[0.0; 3]; MAX_SECOND],
    };

    /// Takes note of the length of the next step.
    pub fn set_step(&mut self, dt: f64) {
        if dt != self.dt {
            (self.dt, self.alike) = (dt, 0);
        }
    }

    /// Whether steps of the same length no longer change the covariances.
    pub fn is_settled(&self) -> bool {
        self.alike >= SETTLED
    }
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
            seconds: 0,
            constant: [0.0; MAX_CONSTANT],
            white: [0.0; MAX_WHITE],
            first: First::NONE,
            second: Second::NONE,
            settled: false,
            draws: 0,
            addresses: [0; MAX_DRAWS],
            normals: [[[0.0; STEPS]; OCTETS]; MAX_DRAWS],
            octet: None,
            ahead: 0..0,
        };
        for component in spec.components() {
            let (shape, parts) = shape(&component);
            match shape {
                Shape::Constant => bank.constants += parts,
                Shape::White => bank.whites += parts,
                Shape::First => bank.first.count += parts,
                Shape::Second => {
                    (bank.seconds, bank.second.count) = (bank.seconds + parts, bank.second.count + parts)
                }
                Shape::Free => bank.second.count += parts,
            }
        }
        let room = [
            ("constant coefficients", bank.constants, MAX_CONSTANT),
            ("coefficients of white noise", bank.whites, MAX_WHITE),
            ("first-order states", bank.first.count, MAX_FIRST),
            ("second-order processes", bank.second.count, MAX_SECOND),
        ];
        for (what, need, capacity) in room {
            if need > capacity {
                return Err(Error::Capacity { what, need, capacity });
            }
        }
        let readout = if spec.readout.is_some() { 2 * DRAWS } else { 0 };
        bank.draws = (bank.readout_draws() + readout).next_multiple_of(TOGETHER);
        Ok(bank)
    }

    /// Place of the first draw of white noise, after those of first and second order.
    fn white_draws(&self) -> usize {
        self.first.count + self.seconds
    }

    /// Place of the first draw of the readout.
    fn readout_draws(&self) -> usize {
        self.white_draws() + self.whites
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
        let mut state = BankState::START;
        (self.key, self.octet) = (key, None);
        self.forget();
        for (component, place) in self.places(spec) {
            let e = component.evolution();
            for part in 0..place.count {
                let address = |draw| Address::new(&component, part, draw);
                let x = e.kind.initial(&e.arguments, part, key.start(self.level, address(3)));
                let i = place.first + part;
                match place.shape {
                    Shape::Constant => self.constant[i] = e.gain * x[0],
                    Shape::White => {}
                    Shape::First => state.first[i] = x[0],
                    Shape::Second | Shape::Free => (0..2).for_each(|r| state.second[r][i] = x[r]),
                }
                match place.shape {
                    Shape::Constant | Shape::Free => {}
                    Shape::White => self.addresses[self.white_draws() + i] = address(2).0,
                    Shape::First => self.addresses[i] = address(0).0,
                    Shape::Second => self.addresses[self.first.count + i] = address(0).0,
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
        self.settled = false;
        for (component, place) in self.places(spec) {
            if place.shape == Shape::Constant {
                continue;
            }
            let e = component.evolution();
            for part in 0..place.count {
                let (i, gain) = (place.first + part, e.gain);
                let step = e.kind.step(&e.arguments, part, dt);
                match place.shape {
                    Shape::Constant => {}
                    Shape::White => self.white[i] = gain * step.noise[2][2],
                    Shape::First => self.first.set(i, &step, gain),
                    Shape::Second | Shape::Free => self.second.set(i, &step, gain),
                }
            }
        }
    }

    /// The readout's normals of step `step`, which has been prepared.
    pub fn readout_normals(&self, step: u64, instrument: Instrument) -> [f64; DRAWS] {
        let first = self.readout_draws() + instrument as usize * DRAWS;
        [self.normals[first], self.normals[first + 1]].map(|drawn| drawn[octet_of(step)][row_of(step)])
    }

    /// Values of the parts at `place`, which are constant.
    pub fn constants(&self, place: Place) -> &[f64] {
        &self.constant[place.first..place.first + place.count]
    }

    /// Interval mean of the component at `place` over step `step`, the last that has been prepared or one
    /// prepared together with it.
    pub fn mean(&self, place: Place, step: u64) -> f64 {
        let row = row_of(step);
        let normal = |draw: usize| self.normals[draw][octet_of(step)][row];
        let part = |i: usize| match place.shape {
            Shape::Constant => self.constant[i],
            Shape::White => self.white[i] * normal(self.white_draws() + i),
            Shape::First => self.first.mean(i, row, normal(i)),
            Shape::Second => self.second.mean(i, row, normal(self.first.count + i)),
            Shape::Free => self.second.mean(i, row, 0.0),
        };
        (place.first..place.first + place.count).map(part).sum()
    }

    /// Whether `step` has been prepared.
    pub fn has(&self, step: u64) -> bool {
        self.ahead.contains(&step)
    }

    /// Takes `state` back from the end of what is prepared to where it stands.
    pub fn settle(&self, state: &mut BankState) {
        if self.has(state.step) {
            let row = row_of(state.step);
            for i in 0..self.first.count {
                state.first[i] = self.first.before(i, row);
            }
            for i in 0..self.second.count {
                [state.second[0][i], state.second[1][i]] = self.second.before(i, row);
            }
        }
    }

    /// Forgets what is prepared; `state` is settled first where it goes on.
    pub fn forget(&mut self) {
        (self.ahead, self.settled) = (0..0, false);
    }

    /// Prepares steps from that of `state` on, to the end of its eight if the covariances are settled, of the
    /// length last prepared for. The states in `state` are afterwards those at the end of what is
    /// prepared; its number stays. The coefficients are added up in `sums`.
    pub fn prepare(&mut self, state: &mut BankState, sums: &mut Sums) {
        let (octet, from) = (octet_of(state.step), row_of(state.step));
        let first = state.step / STEPS as u64 - octet as u64;
        if self.octet != Some(first) {
            let n = self.draws;
            fill_drawn(self.level, self.key.0, first, &self.addresses[..n], &mut self.normals[..n]);
            self.octet = Some(first);
        }
        let to = if state.is_settled() { STEPS } else { from + 1 };
        if !self.settled {
            // Covariances move on until they are settled.
            let moves = !state.is_settled();
            self.first.innovate(&mut state.first_covariance, moves);
            self.second.innovate(self.seconds, &mut state.second_covariance, moves);
            state.alike += u32::from(moves);
            self.settled = !moves;
        }
        self.ahead = state.step..state.step + (to - from) as u64;
        dispatch!(self.level, simd => self.forward(simd, state, sums, octet, from..to));
    }

    /// Takes all parts through the steps of `rows` and adds up their means. Sums are made in all rows, also in
    /// those that are of no interest.
    #[inline(always)]
    fn forward<S: Simd>(
        &mut self,
        simd: S,
        state: &mut BankState,
        sums: &mut Sums,
        octet: usize,
        rows: Range<usize>,
    ) {
        let (first, rest) = self.normals.split_at(self.first.count);
        self.first.forward(simd, &self.normals, octet, &mut state.first, rows.clone());
        self.second.forward(simd, rest, octet, &mut state.second, rows);
        sums.begin();
        for (i, (scale, w)) in self.white[..self.whites].iter().zip(&rest[self.seconds..]).enumerate() {
            add(simd, sums.of(Shape::White, i), [(*scale, &w[octet])]);
        }
        let mut i = 0;
        while i < first.len() {
            let parts = sums.firsts(i, first.len());
            self.first.add(simd, parts.clone(), first, octet, sums.of(Shape::First, i));
            i = parts.end;
        }
        for (i, w) in rest[..self.second.count].iter().enumerate() {
            self.second.add(simd, i, &w[octet], sums.of(Shape::Second, i));
        }
    }
}

/// Place of a step's eight among those whose normals are made together.
fn octet_of(step: u64) -> usize {
    (step / STEPS as u64 % OCTETS as u64) as usize
}

/// Row of a step: its place among eight.
pub(crate) fn row_of(step: u64) -> usize {
    (step % STEPS as u64) as usize
}

fn shape(component: &Component) -> (Shape, usize) {
    let e = component.evolution();
    (e.kind.shape(&e.arguments), e.kind.parts(&e.arguments))
}
