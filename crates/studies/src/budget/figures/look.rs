//! Who has which colour, in all pictures of a budget.

use super::super::report::total;
use super::super::source::Nine;
use super::super::subject::share;
use super::super::{Contribution, TOTAL, Way};
use super::{NAMED, size};
use crate::figure::Colour;
use crate::scenario::Required;

/// What a filter believes.
pub const BELIEF: Colour = Colour(0xbe, 0x00, 0x32);

/// What runs have found.
pub const RUNS: Colour = Colour(0x60, 0x60, 0x60);

/// A source and its covariances, row by row.
pub type Rows<'a> = (&'a str, &'a [Nine]);

/// Colours of the sources by their names.
pub struct Look(Vec<String>);

impl Look {
    /// Colours in the order in which the sources come in the pictures, so that those of the first differ most.
    pub fn new(subjects: &[Required], contributions: &[Contribution]) -> Look {
        let mut names: Vec<String> = Vec::new();
        for &of in subjects {
            for (name, _) in at_end(of, contributions).into_iter().chain(ever(of, contributions)) {
                if !names.iter().any(|known| known == name) {
                    names.push(name.into());
                }
            }
        }
        Look(names)
    }

    /// The colour of a source; grey if no picture names it.
    pub fn colour(&self, name: &str) -> Colour {
        self.0.iter().position(|known| known == name).map_or(Colour::GREY, Colour::many)
    }
}

/// The sources that are largest at the end, those first.
pub fn at_end(of: Required, contributions: &[Contribution]) -> Vec<Rows<'_>> {
    largest(contributions, |p| p.last().map_or(0.0, |p| size(of, p)))
}

/// The sources whose share is largest at any time: who is large for a while has a band of its own, also where it is small at
/// the end.
pub fn ever(of: Required, contributions: &[Contribution]) -> Vec<Rows<'_>> {
    let whole = total(contributions);
    largest(contributions, |p| p.iter().zip(whole).map(|(p, whole)| share(of, p, whole)).fold(0.0, f64::max))
}

/// All sources, the largest first.
pub fn sorted<'a>(contributions: &'a [Contribution], size: impl Fn(&[Nine]) -> f64) -> Vec<Rows<'a>> {
    let sources = contributions.iter().filter(|c| c.name != TOTAL);
    let mut order: Vec<Rows> =
        sources.filter_map(|c| Some((c.name.as_str(), c.of(Way::Covariance)?))).collect();
    order.sort_by(|a, b| size(b.1).total_cmp(&size(a.1)));
    order
}

fn largest<'a>(contributions: &'a [Contribution], size: impl Fn(&[Nine]) -> f64) -> Vec<Rows<'a>> {
    let mut order = sorted(contributions, &size);
    order.retain(|(_, p)| size(p) > 0.0);
    order.truncate(NAMED);
    order
}
