//! The coefficients of each term on each instrument, summed over their sources.

use core::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{Simd, dispatch};

use crate::bank::{Bank, MAX_FIRST, MAX_MOVING, MAX_SECOND, MAX_WHITE};
use crate::imu::Both;
use crate::process::Shape;
use crate::random::{Level, STEPS};
use crate::term::{Coefficients, MAX_COEFFICIENTS, Term};
use crate::truth::Inputs;
use crate::{Instrument, Source, Spec, TERMS};

/// A term may stand on each instrument.
const MAX_GROUPS: usize = 2 * TERMS.len();

/// Interval means of the coefficients of each term, for each of eight steps.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(crate) struct Sums {
    sums: [[[f64; STEPS]; MAX_COEFFICIENTS]; MAX_GROUPS],
    pub level: Level,
    /// Those of the gyroscopes, then those of the accelerometers.
    groups: [Option<Group>; MAX_GROUPS],
    ranges: [Range<usize>; 2],
    /// The first whose coefficients change.
    first_moving: [usize; 2],
    /// Coefficients that change, and the sum of their constant sources.
    moving: [(u16, f64); MAX_MOVING],
    len: usize,
    /// The coefficient of each part.
    white: [u16; MAX_WHITE],
    first: [u16; MAX_FIRST],
    second: [u16; MAX_SECOND],
}

/// A term on an instrument.
#[derive(Clone, Copy, Debug)]
struct Group {
    instrument: Instrument,
    term: &'static dyn Term,
}

impl Sums {
    /// For the coefficients of `spec` that `bank` keeps, started.
    pub fn new(spec: &Spec, bank: &Bank) -> Sums {
        let mut sums = Sums {
            level: bank.level,
            groups: [None; MAX_GROUPS],
            ranges: [0..0, 0..0],
            first_moving: [0; 2],
            sums: [[[0.0; STEPS]; MAX_COEFFICIENTS]; MAX_GROUPS],
            moving: [(0, 0.0); MAX_MOVING],
            len: 0,
            white: [0; MAX_WHITE],
            first: [0; MAX_FIRST],
            second: [0; MAX_SECOND],
        };
        sums.group(spec);
        sums.plan(spec, bank);
        sums
    }

    /// Lists the terms of each instrument: those whose coefficients are all constant come first.
    fn group(&mut self, spec: &Spec) {
        let constant = |s: &Source| s.components().all(|c| c.evolution().is_constant());
        let mut len = 0;
        for instrument in Instrument::ALL {
            let of = || spec.sources().filter(|s| s.instrument() == instrument);
            let moves = |s: &Source| of().any(|o| o.term() == s.term() && !constant(o));
            let first = len;
            for moving in [false, true] {
                self.first_moving[instrument as usize] = len;
                for source in of().filter(|s| moves(s) == moving) {
                    if self.find(instrument, source.term()).is_none() {
                        self.groups[len] = Some(Group { instrument, term: source.term() });
                        len += 1;
                    }
                }
            }
            self.ranges[instrument as usize] = first..len;
        }
    }

    fn find(&self, instrument: Instrument, term: &'static dyn Term) -> Option<usize> {
        self.groups.iter().flatten().position(|g| g.instrument == instrument && g.term == term)
    }

    /// Adds up what is constant and lists what changes.
    fn plan(&mut self, spec: &Spec, bank: &Bank) {
        for (c, place) in bank.places(spec) {
            let Some(group) = self.find(c.instrument(), c.term()) else { continue };
            let slot = (group * MAX_COEFFICIENTS + c.coefficient()) as u16;
            let parts = place.first..place.first + place.count;
            match place.shape {
                Shape::Constant => {
                    let sum: f64 = bank.constants(place).iter().sum();
                    self.sums[group][c.coefficient()].iter_mut().for_each(|row| *row += sum);
                    continue;
                }
                Shape::White => self.white[parts].fill(slot),
                Shape::First => self.first[parts].fill(slot),
                Shape::Second | Shape::Free => self.second[parts].fill(slot),
            }
            if self.moving[..self.len].iter().all(|(known, _)| *known != slot) {
                self.moving[self.len].0 = slot;
                self.len += 1;
            }
        }
        for (slot, base) in &mut self.moving[..self.len] {
            *base = self.sums.as_flattened()[usize::from(*slot)][0];
        }
    }

    /// Goes back to the constant sources.
    #[inline(always)]
    pub fn begin(&mut self) {
        let sums = self.sums.as_flattened_mut();
        for (slot, base) in &self.moving[..self.len] {
            sums[usize::from(*slot)] = [*base; STEPS];
        }
    }

    /// The coefficient to which part `i` of a shape belongs, in each row.
    #[inline(always)]
    pub fn of(&mut self, shape: Shape, i: usize) -> &mut [f64; STEPS] {
        let slot = match shape {
            Shape::White => self.white[i],
            Shape::First => self.first[i],
            Shape::Constant | Shape::Second | Shape::Free => self.second[i],
        };
        &mut self.sums.as_flattened_mut()[usize::from(slot)]
    }

    /// The first-order parts from `i` on, before `end`, that belong to the same coefficient.
    #[inline(always)]
    pub fn firsts(&self, i: usize, end: usize) -> Range<usize> {
        let other = self.first[i..end].iter().position(|slot| *slot != self.first[i]);
        i..other.map_or(end, |n| i + n)
    }

    /// Output errors of `instrument` in row `row`.
    #[inline]
    pub fn error(&self, instrument: Instrument, row: usize, inputs: &Inputs) -> [f64; 3] {
        let input = inputs.seen_by(instrument).at(row);
        let range = self.ranges[instrument as usize].clone();
        let mut error = [0.0; 3];
        for (sums, group) in self.sums[range.clone()].iter().zip(self.groups[range].iter().flatten()) {
            let mut c = Coefficients::default();
            for (c, sum) in c.iter_mut().zip(sums) {
                *c = sum[row];
            }
            group.term.add_output(&input, &c, &mut error);
        }
        error
    }

    /// The output errors of all rows by terms that keep their value while the inputs do.
    #[inline]
    pub fn set_constant(&self, inputs: &Inputs, errors: &mut Both) {
        // In lanes: the first term would have to wait for single numbers.
        dispatch!(self.level, simd => clear(simd, errors));
        for (instrument, errors) in Instrument::ALL.into_iter().zip(errors) {
            let Range { start, .. } = self.ranges[instrument as usize];
            self.add(instrument, start..self.first_moving[instrument as usize], inputs, errors);
        }
    }

    /// Adds the output errors of all rows by the other terms.
    #[inline]
    pub fn add_moving(&self, inputs: &Inputs, errors: &mut Both) {
        for (instrument, errors) in Instrument::ALL.into_iter().zip(errors) {
            let Range { end, .. } = self.ranges[instrument as usize];
            self.add(instrument, self.first_moving[instrument as usize]..end, inputs, errors);
        }
    }

    #[inline(always)]
    fn add(
        &self,
        instrument: Instrument,
        range: Range<usize>,
        inputs: &Inputs,
        errors: &mut [[f64; STEPS]; 3],
    ) {
        for (sums, group) in self.sums[range.clone()].iter().zip(self.groups[range].iter().flatten()) {
            group.term.add_outputs(self.level, &inputs.seen_by(instrument), sums, errors);
        }
    }
}

#[inline(always)]
fn clear<S: Simd>(simd: S, errors: &mut Both) {
    let zeros = S::f64s::splat(simd, 0.0);
    for lanes in errors.as_flattened_mut().as_flattened_mut().chunks_exact_mut(S::f64s::LEN) {
        zeros.store_slice(lanes);
    }
}
