//! The coefficients of each term on each instrument, summed over their sources.

use core::ops::Range;

use crate::bank::{Bank, MAX_MOVING, STEPS, ZERO};
use crate::process::Shape;
use crate::term::{Coefficients, TOGETHER, Term};
use crate::{Input, Instrument, Source, Spec, TERMS};

/// A term may stand on each instrument.
const MAX_GROUPS: usize = 2 * TERMS.len();

/// Interval means of the coefficients of each term, for each step of a block.
#[derive(Clone, Debug)]
pub(crate) struct Sums {
    /// Those of the gyroscopes, then those of the accelerometers.
    groups: [Option<Group>; MAX_GROUPS],
    ranges: [Range<usize>; 2],
    sums: [[Coefficients; STEPS]; MAX_GROUPS],
    /// The triples of coefficients of which one changes.
    targets: [Target; MAX_MOVING],
    moving: usize,
    /// Places of the means that each of them adds up, one target after the other.
    parts: [[u16; 3]; MAX_MOVING],
}

/// A term on an instrument.
#[derive(Clone, Copy, Debug)]
struct Group {
    instrument: Instrument,
    term: &'static dyn Term,
}

/// Three coefficients in a row, which most often are those of the axes.
#[derive(Clone, Copy, Debug)]
struct Target {
    group: usize,
    triple: usize,
    /// Sum of their constant sources.
    base: [f64; 3],
    /// Most means that one of them adds up; the others add zeros.
    count: usize,
}

impl Target {
    const NONE: Target = Target { group: 0, triple: 0, base: [0.0; 3], count: 0 };
}

impl Sums {
    /// For the coefficients of `spec` that `bank` keeps, started.
    pub fn new(spec: &Spec, bank: &Bank) -> Sums {
        let mut sums = Sums {
            groups: [None; MAX_GROUPS],
            ranges: [0..0, 0..0],
            sums: [[Coefficients::default(); STEPS]; MAX_GROUPS],
            targets: [Target::NONE; MAX_MOVING],
            moving: 0,
            parts: [[ZERO as u16; 3]; MAX_MOVING],
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
        // Group, coefficient and place of each mean.
        let (mut list, mut len) = ([(0, 0, 0); MAX_MOVING], 0);
        for (c, place) in bank.places(spec) {
            let Some(group) = self.find(c.instrument(), c.term()) else { continue };
            for part in place.parts() {
                if place.shape == Shape::Constant {
                    self.sums[group].iter_mut().for_each(|row| row[c.coefficient()] += bank.constant[part]);
                } else {
                    list[len] = (group, c.coefficient(), part as u16);
                    len += 1;
                }
            }
        }
        let list = &mut list[..len];
        list.sort_unstable();
        let mut first = 0;
        for same in list.chunk_by(|a, b| (a.0, a.1 / 3) == (b.0, b.1 / 3)) {
            let (group, triple) = (same[0].0, same[0].1 / 3);
            let mut counts = [0; 3];
            for (_, coefficient, part) in same {
                let i = coefficient % 3;
                self.parts[first + counts[i]][i] = *part;
                counts[i] += 1;
            }
            let count = counts.into_iter().fold(0, usize::max);
            let base = self.sums[group][0].as_chunks().0[triple];
            self.targets[self.moving] = Target { group, triple, base, count };
            self.moving += 1;
            first += count;
        }
    }

    /// Sums the means of the rows of `bank` in `range`.
    pub fn add_up(&mut self, bank: &Bank, range: Range<usize>) {
        let mut parts = &self.parts[..];
        for t in &self.targets[..self.moving] {
            let (own, rest) = parts.split_at(t.count);
            let sums = &mut self.sums[t.group][range.clone()];
            for (sum, row) in sums.iter_mut().zip(&bank.rows()[range.clone()]) {
                let mut c = t.base;
                for part in own {
                    (0..3).for_each(|i| c[i] += row.means[usize::from(part[i])]);
                }
                sum.as_chunks_mut().0[t.triple] = c;
            }
            parts = rest;
        }
    }

    /// Output errors of `instrument` under `input`, which belongs to row `row`.
    #[inline]
    pub fn error(&self, instrument: Instrument, row: usize, input: &Input) -> [f64; 3] {
        let range = self.ranges[instrument as usize].clone();
        let mut error = [0.0; 3];
        for (sums, group) in self.sums[range.clone()].iter().zip(self.groups[range].iter().flatten()) {
            group.term.add_output(input, &sums[row], &mut error);
        }
        error
    }

    /// The same of the steps that begin at a row which is a multiple of [`TOGETHER`].
    #[inline]
    pub fn errors(
        &self,
        instrument: Instrument,
        row: usize,
        inputs: &[Input; TOGETHER],
    ) -> [[f64; 3]; TOGETHER] {
        let range = self.ranges[instrument as usize].clone();
        let mut errors = [[0.0; 3]; TOGETHER];
        for (sums, group) in self.sums[range.clone()].iter().zip(self.groups[range].iter().flatten()) {
            group.term.add_outputs(inputs, &sums.as_chunks().0[row / TOGETHER], &mut errors);
        }
        errors
    }
}
